// ICC profiles made for the tests by Little CMS, and what a profile says of a colour.
#pragma once

#include <lcms2.h>

#include <array>
#include <cmath>
#include <functional>

#include "image_files.h"

namespace probewarp::testing {

using Xyz = std::array<double, 3>;

inline File saved_profile(cmsHPROFILE profile) {
    cmsUInt32Number size = 0;
    cmsSaveProfileToMem(profile, nullptr, &size);
    File file(size);
    cmsSaveProfileToMem(profile, file.data(), &size);
    cmsCloseProfile(profile);
    return file;
}

inline File grey_profile(double gamma, bool lab = false) {
    cmsToneCurve* curve = cmsBuildGamma(nullptr, gamma);
    cmsHPROFILE profile = cmsCreateGrayProfile(cmsD50_xyY(), curve);
    cmsFreeToneCurve(curve);
    if (lab) cmsSetPCS(profile, cmsSigLabData);
    return saved_profile(profile);
}

/// Colours of printing inks, 0 to 1 each, whose Lab is affine in them.
inline std::array<double, 3> lab_of_inks(const std::array<double, 4>& ink) {
    const auto [c, m, y, k] = ink;
    return {100 - 20 * c - 25 * m - 5 * y - 40 * k, -20 * c + 35 * m, 40 * y - 15 * c};
}

/// A CMYK profile that says the same, by a table of its corners.
inline File inks_profile() {
    cmsHPROFILE profile = cmsCreateProfilePlaceholder(nullptr);
    cmsSetProfileVersion(profile, 4.3);
    cmsSetDeviceClass(profile, cmsSigOutputClass);
    cmsSetColorSpace(profile, cmsSigCmykData);
    cmsSetPCS(profile, cmsSigLabData);
    cmsPipeline* pipeline = cmsPipelineAlloc(nullptr, 4, 3);
    std::vector<cmsUInt16Number> table;
    for (int corner = 0; corner < 16; ++corner) {
        const auto lab = lab_of_inks(
            {double(corner >> 3 & 1), double(corner >> 2 & 1), double(corner >> 1 & 1), double(corner & 1)});
        const cmsCIELab of_corner{lab[0], lab[1], lab[2]};
        std::array<cmsUInt16Number, 3> encoded{};
        cmsFloat2LabEncoded(encoded.data(), &of_corner);
        table.insert(table.end(), encoded.begin(), encoded.end());
    }
    // A table stands between curves, which do nothing here.
    cmsPipelineInsertStage(pipeline, cmsAT_END, cmsStageAllocToneCurves(nullptr, 4, nullptr));
    cmsPipelineInsertStage(pipeline, cmsAT_END, cmsStageAllocCLut16bit(nullptr, 2, 4, 3, table.data()));
    cmsPipelineInsertStage(pipeline, cmsAT_END, cmsStageAllocToneCurves(nullptr, 3, nullptr));
    cmsWriteTag(profile, cmsSigAToB0Tag, pipeline);
    cmsPipelineFree(pipeline);
    cmsWriteTag(profile, cmsSigMediaWhitePointTag, cmsD50_XYZ());
    return saved_profile(profile);
}

/// The formulas of CIE Lab, with D50 as white.
inline Xyz xyz_of_lab(const std::array<double, 3>& lab) {
    const auto f = [](double t) { return t > 6.0 / 29 ? t * t * t : (t - 4.0 / 29) * 108 / 841; };
    const double y = (lab[0] + 16) / 116;
    return {0.9642 * f(y + lab[1] / 500), f(y), 0.8249 * f(y - lab[2] / 200)};
}

/// From XYZ with D50 as white to 8-bit sRGB: Bradford's matrix, then IEC 61966-2-1.
inline std::array<double, 3> srgb_of_xyz(const Xyz& v) {
    const std::array<Xyz, 3> matrix{{{3.1338561, -1.6168667, -0.4906146},
                                     {-0.9787684, 1.9161415, 0.0334540},
                                     {0.0719453, -0.2289914, 1.4052427}}};
    std::array<double, 3> rgb{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double linear = matrix[i][0] * v[0] + matrix[i][1] * v[1] + matrix[i][2] * v[2];
        rgb[i] = 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
    }
    return rgb;
}

/// What an RGB profile says: relative to its white, which is D50 here. Zeros where it cannot be read.
inline Xyz xyz_of_profile(const File& icc, const std::array<double, 3>& rgb) {
    Xyz result{};
    cmsHPROFILE profile = cmsOpenProfileFromMem(icc.data(), cmsUInt32Number(icc.size()));
    if (!profile) return result;
    cmsHPROFILE xyz = cmsCreateXYZProfile();
    cmsHTRANSFORM transform =
        cmsCreateTransform(profile, TYPE_RGB_DBL, xyz, TYPE_XYZ_DBL, INTENT_RELATIVE_COLORIMETRIC, 0);
    if (transform) {
        cmsDoTransform(transform, rgb.data(), result.data(), 1);
        cmsDeleteTransform(transform);
    }
    cmsCloseProfile(xyz);
    cmsCloseProfile(profile);
    return result;
}

}  // namespace probewarp::testing
