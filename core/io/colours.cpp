#include "io/colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "io/cicp.h"
#include "io/colour_engine.h"

namespace probewarp {

namespace {

/// CIE x and y of white, red, green and blue: sRGB's, times 100,000.
constexpr Chromaticities srgb_chromaticities{31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};

bool is_for(Bytes profile, std::string_view colour_space) {
    if (profile.size() < 20) return false;
    for (std::size_t i = 0; i < 4; ++i)
        if (u8(profile, 16 + i) != static_cast<unsigned char>(colour_space[i])) return false;
    return true;
}

std::vector<std::byte> saved(const Profile& profile) {
    cmsUInt32Number size = 0;
    if (!profile || !cmsSaveProfileToMem(profile.get(), nullptr, &size)) return {};
    std::vector<std::byte> bytes(size);
    if (!cmsSaveProfileToMem(profile.get(), bytes.data(), &size)) return {};
    // The day on which it was made says nothing, and the same picture is to give the same file.
    for (std::size_t i = 24; i < 36; ++i) bytes[i] = std::byte{0};
    return bytes;
}

/// Null where the chromaticities span no colours.
Profile rgb_profile_from(const ColourEngine& engine, const Chromaticities& c, cmsToneCurve* curve) {
    const auto xyy = [&](std::size_t i) { return cmsCIExyY{c[i] / 100000.0, c[i + 1] / 100000.0, 1}; };
    const cmsCIExyY white = xyy(0);
    const cmsCIExyYTRIPLE primaries{xyy(2), xyy(4), xyy(6)};
    const std::array<cmsToneCurve*, 3> curves{curve, curve, curve};
    return Profile(cmsCreateRGBProfileTHR(engine.context, &white, &primaries, curves.data()));
}

/// The curve of a grey profile whose colours are Lab: it leads to lightness, and this one to light.
ToneCurve light_of_lightness(const ColourEngine& engine, const cmsToneCurve* lightness) {
    std::vector<cmsUInt16Number> table(4096);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const float l = cmsEvalToneCurveFloat(lightness, float(i) / float(table.size() - 1));
        const cmsCIELab lab{std::clamp(double(l), 0.0, 1.0) * 100, 0, 0};
        cmsCIEXYZ xyz;
        cmsLab2XYZ(nullptr, &xyz, &lab);
        table[i] = cmsUInt16Number(std::lround(std::clamp(xyz.Y, 0.0, 1.0) * 65535));
    }
    ToneCurve curve(
        cmsBuildTabulatedToneCurve16(engine.context, cmsUInt32Number(table.size()), table.data()));
    if (!curve) throw std::bad_alloc();
    return curve;
}

std::vector<std::byte> from_grey(Bytes icc) {
    const ColourEngine engine;
    const Profile grey = open_profile(engine, icc);
    if (!grey) return {};
    auto* const curve = static_cast<cmsToneCurve*>(cmsReadTag(grey.get(), cmsSigGrayTRCTag));
    if (!curve) return {};
    if (cmsGetPCS(grey.get()) != cmsSigLabData)
        return saved(rgb_profile_from(engine, srgb_chromaticities, curve));
    const ToneCurve light = light_of_lightness(engine, curve);
    return saved(rgb_profile_from(engine, srgb_chromaticities, light.get()));
}

std::vector<std::byte> from_gamma(std::uint32_t gamma, const Chromaticities& chromaticities) {
    if (gamma == 0) return {};
    const ColourEngine engine;
    const ToneCurve curve(cmsBuildGamma(engine.context, 100000.0 / gamma));
    if (!curve) throw std::bad_alloc();
    return saved(rgb_profile_from(engine, chromaticities, curve.get()));
}

/// Empty for code points that no profile of ours says.
std::vector<std::byte> from_cicp(const std::array<std::uint8_t, 4>& cicp) {
    const auto [primaries, transfer, matrix, full_range] = cicp;
    const std::optional<Chromaticities> chromaticities = chromaticities_of_primaries(primaries);
    if (!chromaticities || matrix != 0 || full_range != 1) return {};
    const ColourEngine engine;
    const ToneCurve curve = curve_of_transfer(engine, transfer);
    return curve ? saved(rgb_profile_from(engine, *chromaticities, curve.get())) : std::vector<std::byte>();
}

constexpr std::array<std::uint8_t, 4> srgb_cicp{1, 13, 0, 1};

}  // namespace

std::vector<std::byte> rgb_profile(Bytes profile) {
    if (profile.size() > max_icc_bytes || is_for(profile, "CMYK") || is_for(profile, "Lab ")) return {};
    if (is_for(profile, "GRAY")) return from_grey(profile);
    return {profile.begin(), profile.end()};
}

std::vector<std::byte> profile_of(const Description& description) {
    if (description.cicp) {
        if (*description.cicp == srgb_cicp) return {};
        // Where nobody here can say what it means, what stands beside it for such readers holds.
        std::vector<std::byte> made = from_cicp(*description.cicp);
        if (!made.empty()) return made;
    }
    if (!description.icc.empty()) return description.icc;
    if (description.srgb_intent) return {};
    if (description.gamma)
        return from_gamma(*description.gamma, description.chromaticities.value_or(srgb_chromaticities));
    return {};
}

}  // namespace probewarp
