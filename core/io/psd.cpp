// PSD's and PSB's merged picture, by hand: stb_image's 16-bit run lengths are wrong, its removal of a white
// matte overflows, and it knows two modes only.
#include <algorithm>
#include <limits>

#include "io/colours.h"
#include "io/exif.h"
#include "io/formats.h"
#include "io/psd_parts.h"

namespace probewarp {

namespace {

template <class Sample>
bool all_white(const std::vector<Sample>& rgba) {
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3 && rgba[i] != std::numeric_limits<Sample>::max()) return false;
    return true;
}

/// Without layers there is nothing but the merged picture, whatever the file says of it; if it is the plain
/// white that Photoshop puts in its place, there is no picture at all.
bool is_missing(const Psd& psd, const Image& image) {
    return !psd.merged && std::visit([](const auto& rgba) { return all_white(rgba); }, image.rgba);
}

Error no_merged_picture(const Psd& psd) {
    return Error("was saved without a merged picture; expected one: save the " + psd.label() +
                 " again in Photoshop with \"Maximize Compatibility\"");
}

/// What other than sRGB the pixels of that image are.
Bytes profile_of_pixels(const Psd& psd) {
    const bool converted = psd.mode == PsdMode::cmyk || psd.mode == PsdMode::multichannel ||
                           psd.mode == PsdMode::lab || psd.bits == 32;
    return converted ? Bytes{} : psd.icc;
}

}  // namespace

Image decode_psd(Bytes bytes, const DecodeOptions& options) {
    const Psd psd = read_psd_sections(bytes);
    if (!psd.merged && psd.layered) throw no_merged_picture(psd);
    Image image = read_psd_pixels(psd, options.salvage);
    if (is_missing(psd, image)) throw no_merged_picture(psd);
    image.description.icc = rgb_profile(profile_of_pixels(psd));
    image.description.resolution = psd.resolution;
    image.description.aspect = psd.aspect;
    image.description.exif = parse_exif(psd.exif).block;  // Photoshop has turned the pixels already
    return image;
}

}  // namespace probewarp
