#include "io/foreign_colours.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>

#include "io/colour_engine.h"

namespace probewarp {

struct ToSrgb::Transform {
    ColourEngine engine;  // first in, last out
    ColourTransform transform;
};

namespace {

// ---- the plain conversion of inks, without a profile ----

template <class Sample>
void from_inks(std::span<Sample> samples) {
    constexpr std::uint32_t all = full<Sample>;
    for (std::size_t i = 0; i < samples.size(); i += 4) {
        const std::uint32_t k = samples[i + 3];
        for (std::size_t c = 0; c < 3; ++c) samples[i + c] = Sample((samples[i + c] * k + all / 2) / all);
    }
}

// ---- profiles ----

/// The file's own where it is for those colours.
Profile own_profile(const ColourEngine& engine, Bytes icc, cmsColorSpaceSignature colours) {
    Profile profile = icc.empty() ? nullptr : open_profile(engine, icc);
    if (profile && cmsGetColorSpace(profile.get()) != colours) profile.reset();
    return profile;
}

/// Amounts of light of the same primaries as the given profile's, or as sRGB's.
Profile linear_profile(const ColourEngine& engine, Profile given) {
    const Profile like = given && cmsIsMatrixShaper(given.get())
                             ? std::move(given)
                             : Profile(cmsCreate_sRGBProfileTHR(engine.context));
    const ToneCurve straight(cmsBuildGamma(engine.context, 1));
    Profile linear(cmsCreateProfilePlaceholder(engine.context));
    if (!like || !straight || !linear) throw std::bad_alloc();
    cmsSetDeviceClass(linear.get(), cmsSigDisplayClass);
    cmsSetColorSpace(linear.get(), cmsSigRgbData);
    cmsSetPCS(linear.get(), cmsSigXYZData);
    for (const auto tag : {cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag})
        cmsWriteTag(linear.get(), tag, cmsReadTag(like.get(), tag));
    for (const auto tag : {cmsSigRedTRCTag, cmsSigGreenTRCTag, cmsSigBlueTRCTag})
        cmsWriteTag(linear.get(), tag, straight.get());
    return linear;
}

/// Null where there is none, which is for inks only.
Profile profile_of(const ColourEngine& engine, ForeignColours colours, Bytes icc) {
    switch (colours) {
        case ForeignColours::lab: {
            Profile own = own_profile(engine, icc, cmsSigLabData);
            return own ? std::move(own) : Profile(cmsCreateLab4ProfileTHR(engine.context, nullptr));
        }
        case ForeignColours::linear_rgb:
            return linear_profile(engine, own_profile(engine, icc, cmsSigRgbData));
        default:
            return own_profile(engine, icc, cmsSigCmykData);
    }
}

// ---- how the samples lie ----

cmsUInt32Number bytes_of(int bits) {
    return BYTES_SH(cmsUInt32Number(bits) / 8) | FLOAT_SH(cmsUInt32Number(bits == 32));
}

cmsUInt32Number layout_of(ForeignColours colours, int bits) {
    switch (colours) {
        case ForeignColours::cmyk:
            return COLORSPACE_SH(PT_CMYK) | CHANNELS_SH(4) | FLAVOR_SH(1) | bytes_of(bits);
        case ForeignColours::lab:
            return COLORSPACE_SH(PT_Lab) | CHANNELS_SH(3) | EXTRA_SH(1) | bytes_of(bits);
        case ForeignColours::linear_rgb:
            break;
    }
    return COLORSPACE_SH(PT_RGB) | CHANNELS_SH(3) | EXTRA_SH(1) | bytes_of(bits);
}

/// Lab is converted step by step: the table that Little CMS would make of it is wrong by up to 30 of 255.
cmsUInt32Number flags_of(ForeignColours colours) {
    return colours == ForeignColours::cmyk ? cmsFLAGS_BLACKPOINTCOMPENSATION : cmsFLAGS_NOOPTIMIZE;
}

}  // namespace

std::unique_ptr<const ToSrgb::Transform> ToSrgb::transform_of(ForeignColours colours, Bytes icc, int bits) {
    auto made = std::make_unique<Transform>();
    const cmsContext context = made->engine.context;
    const Profile from = profile_of(made->engine, colours, icc);
    if (!from) return nullptr;
    const Profile srgb(cmsCreate_sRGBProfileTHR(context));
    made->transform.reset(
        cmsCreateTransformTHR(context, from.get(), layout_of(colours, bits), srgb.get(),
                              COLORSPACE_SH(PT_RGB) | CHANNELS_SH(3) | EXTRA_SH(1) | bytes_of(bits),
                              INTENT_RELATIVE_COLORIMETRIC, flags_of(colours)));
    return made->transform ? std::move(made) : nullptr;
}

ToSrgb::ToSrgb(ForeignColours colours, Bytes icc, int bits) : transform_(transform_of(colours, icc, bits)) {
    if (!transform_) transform_ = transform_of(colours, {}, bits);  // where the profile is of no use
    if (!transform_ && colours != ForeignColours::cmyk) throw std::bad_alloc();
}

ToSrgb::~ToSrgb() = default;

template <class Sample>
void ToSrgb::convert_all(std::span<Sample> samples) const {
    constexpr std::size_t pixels_at_once = 1024;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples.size() / 4, pixels_at_once),
                      [&](const auto& part) {
                          const auto some = samples.subspan(part.begin() * 4, part.size() * 4);
                          if (transform_)
                              cmsDoTransform(transform_->transform.get(), some.data(), some.data(),
                                             cmsUInt32Number(part.size()));
                          else if constexpr (!std::is_floating_point_v<Sample>)
                              from_inks(some);
                      });
    for (std::size_t i = 3; i < samples.size(); i += 4) samples[i] = full<Sample>;
}

void ToSrgb::convert(std::span<std::uint8_t> samples) const { convert_all(samples); }
void ToSrgb::convert(std::span<std::uint16_t> samples) const { convert_all(samples); }
void ToSrgb::convert(std::span<float> samples) const { convert_all(samples); }

}  // namespace probewarp
