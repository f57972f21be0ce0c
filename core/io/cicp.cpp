#include "io/cicp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace probewarp {

namespace {

struct Primaries {
    unsigned code;
    Chromaticities xy;  ///< white, red, green, blue
};

/// H.273, table 2.
constexpr std::array<Primaries, 8> all_primaries{{
    {1, {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000}},   // BT.709, sRGB
    {4, {31000, 31600, 67000, 33000, 21000, 71000, 14000, 8000}},   // BT.470 M
    {5, {31270, 32900, 64000, 33000, 29000, 60000, 15000, 6000}},   // BT.470 B, G
    {6, {31270, 32900, 63000, 34000, 31000, 59500, 15500, 7000}},   // BT.601, 525 lines
    {9, {31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600}},   // BT.2020
    {11, {31400, 35100, 68000, 32000, 26500, 69000, 15000, 6000}},  // DCI-P3
    {12, {31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000}},  // Display P3
    {22, {31270, 32900, 63000, 34000, 29500, 60500, 15500, 7700}},  // EBU 3213-E
}};

/// Table 3, 16: SMPTE ST 2084.
double light_of_pq(double signal) {
    constexpr double c1 = 0.8359375, c2 = 18.8515625, c3 = 18.6875, m = 78.84375, n = 0.1593017578125;
    const double v = std::pow(signal, 1 / m);
    return std::pow(std::max(v - c1, 0.0) / (c2 - c3 * v), 1 / n);
}

/// Table 3, 18: ARIB STD-B67.
double light_of_hlg(double signal) {
    constexpr double a = 0.17883277, b = 0.28466892, c = 0.55991073;
    return signal <= 0.5 ? signal * signal / 3 : (std::exp((signal - c) / a) + b) / 12;
}

cmsToneCurve* table_of(cmsContext context, double (*light)(double signal)) {
    std::vector<cmsUInt16Number> table(4096);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double v = light(double(i) / double(table.size() - 1));
        table[i] = cmsUInt16Number(std::lround(std::clamp(v, 0.0, 1.0) * 65535));
    }
    return cmsBuildTabulatedToneCurve16(context, cmsUInt32Number(table.size()), table.data());
}

/// A power above a straight line: (a x + b)^gamma from d on, c x below.
cmsToneCurve* power_above_line(cmsContext context, double gamma, double a, double b, double c, double d) {
    constexpr cmsInt32Number kind = 4;  // Little CMS's number of it
    const std::array<double, 5> parameters{gamma, a, b, c, d};
    return cmsBuildParametricToneCurve(context, kind, parameters.data());
}

}  // namespace

std::optional<Chromaticities> chromaticities_of_primaries(unsigned code) {
    const auto found = std::ranges::find(all_primaries, code, &Primaries::code);
    if (found == all_primaries.end()) return {};
    return found->xy;
}

ToneCurve curve_of_transfer(const ColourEngine& engine, unsigned code) {
    const cmsContext context = engine.context;
    const auto made = [](cmsToneCurve* curve) {
        if (!curve) throw std::bad_alloc();
        return ToneCurve(curve);
    };
    switch (code) {
        case 1:
        case 6:
        case 14:
        case 15:  // BT.709, BT.601, BT.2020
            return made(power_above_line(context, 1 / 0.45, 1 / 1.099, 0.099 / 1.099, 1 / 4.5, 0.081));
        case 4:
            return made(cmsBuildGamma(context, 2.2));
        case 5:
            return made(cmsBuildGamma(context, 2.8));
        case 8:
            return made(cmsBuildGamma(context, 1));
        case 13:  // sRGB
            return made(power_above_line(context, 2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045));
        case 16:
            return made(table_of(context, light_of_pq));
        case 18:
            return made(table_of(context, light_of_hlg));
        default:
            return nullptr;
    }
}

}  // namespace probewarp
