#include "io/foreign_colours.h"

#include "io/colour_engine.h"

namespace probewarp {

struct ToSrgb::Transform {
    ColourEngine engine;  // first in, last out
    ColourTransform transform;
};

namespace {

/// The plain conversion, without a profile.
void from_inks(std::span<std::uint8_t> samples, bool inverted) {
    for (std::size_t i = 0; i < samples.size(); i += 4) {
        const auto light = [&](std::size_t k) { return inverted ? samples[i + k] : 255u - samples[i + k]; };
        const unsigned k = light(3);
        for (std::size_t c = 0; c < 3; ++c) samples[i + c] = std::uint8_t((light(c) * k + 127) / 255);
    }
}

}  // namespace

ToSrgb::ToSrgb(ForeignColours colours, Bytes icc) : colours_(colours) {
    if (icc.empty()) return;
    auto made = std::make_unique<Transform>();
    const cmsContext context = made->engine.context;
    const Profile from = open_profile(made->engine, icc);
    if (!from || cmsGetColorSpace(from.get()) != cmsSigCmykData) return;
    const Profile srgb(cmsCreate_sRGBProfileTHR(context));
    const cmsUInt32Number layout = colours == ForeignColours::cmyk ? TYPE_CMYK_8 : TYPE_CMYK_8_REV;
    made->transform.reset(cmsCreateTransformTHR(context, from.get(), layout, srgb.get(), TYPE_RGBA_8,
                                                INTENT_RELATIVE_COLORIMETRIC,
                                                cmsFLAGS_BLACKPOINTCOMPENSATION));
    if (made->transform) transform_ = std::move(made);
}

ToSrgb::~ToSrgb() = default;

void ToSrgb::convert(std::span<std::uint8_t> samples) const {
    if (transform_)
        cmsDoTransform(transform_->transform.get(), samples.data(), samples.data(),
                       cmsUInt32Number(samples.size() / 4));
    else
        from_inks(samples, colours_ == ForeignColours::cmyk_inverted);
    for (std::size_t i = 3; i < samples.size(); i += 4) samples[i] = 255;
}

}  // namespace probewarp
