#include "io/tga_extension.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>

namespace probewarp {

namespace {

constexpr std::string_view signature("TRUEVISION-XFILE.\0", 18);
constexpr std::size_t footer_bytes = 26, extension_bytes = 495;
// Places in the extension area. A ratio is two 16-bit numbers, of which 0 below the line says nothing.
constexpr std::size_t aspect_at = 474, gamma_at = 478, alpha_at = 494;

struct Ratio {
    std::uint32_t above = 0, below = 0;
};

Ratio ratio_at(Bytes area, std::size_t at) { return {le16(area, at), le16(area, at + 2)}; }

TgaAlpha alpha_of(std::uint32_t kind) {
    return kind == 3 ? TgaAlpha::straight : kind == 4 ? TgaAlpha::premultiplied : TgaAlpha::none;
}

/// The exponent to linear light, where it can be meant: the specification has it between 0 and 10.
std::optional<std::uint32_t> gamma_of(Ratio ratio) {
    if (ratio.below == 0) return {};
    const double exponent = double(ratio.above) / ratio.below;
    if (exponent < 0.1 || exponent > 10) return {};
    return std::uint32_t(std::lround(100000 / exponent));
}

/// ratio: a pixel's width over its height. Square pixels need no word.
std::optional<Resolution> aspect_of(Ratio ratio) {
    if (ratio.above == 0 || ratio.below == 0 || ratio.above == ratio.below) return {};
    return Resolution{ratio.below, ratio.above};
}

// ---- writing ----

/// Only where nothing else describes the colours: TGA cannot say that they are sRGB, and a picture that says
/// nothing is taken for that.
std::optional<Ratio> gamma_ratio(const Description& description) {
    if (!description.gamma || description.srgb_intent || !description.icc.empty() || description.cicp)
        return {};
    const double exponent = 100000.0 / *description.gamma;
    if (!(exponent >= 0.1 && exponent <= 10)) return {};
    constexpr std::uint32_t below = 5000;  // the product stays within 16 bits up to an exponent of 10
    return Ratio{std::uint32_t(std::lround(exponent * below)), below};
}

std::optional<Ratio> aspect_ratio(const Description& description) {
    const std::optional<Resolution>& r = description.resolution ? description.resolution : description.aspect;
    if (!r || r->x == 0 || r->y == 0 || r->x == r->y) return {};
    Ratio ratio{r->y / std::gcd(r->x, r->y), r->x / std::gcd(r->x, r->y)};
    if (const std::uint32_t larger = std::max(ratio.above, ratio.below); larger > 65535) {
        const double scale = 65535.0 / larger;
        ratio = {std::uint32_t(std::lround(ratio.above * scale)),
                 std::uint32_t(std::lround(ratio.below * scale))};
    }
    if (ratio.above == 0 || ratio.below == 0) return {};
    return ratio;
}

void put(std::vector<std::byte>& bytes, std::size_t at, std::size_t count, std::uint32_t value) {
    for (std::size_t i = 0; i < count; ++i, value >>= 8) bytes[at + i] = std::byte(value & 255);
}

void put(std::vector<std::byte>& bytes, std::size_t at, const std::optional<Ratio>& ratio) {
    if (!ratio) return;
    put(bytes, at, 2, ratio->above);
    put(bytes, at + 2, 2, ratio->below);
}

}  // namespace

bool has_tga_footer(Bytes file) {
    if (file.size() < footer_bytes) return false;
    const Bytes end = file.last(signature.size());
    return std::equal(signature.begin(), signature.end(), end.begin(),
                      [](char a, std::byte b) { return std::byte(a) == b; });
}

TgaExtension read_tga_extension(Bytes file) {
    if (!has_tga_footer(file)) return {};
    const std::size_t start = le32(file, file.size() - footer_bytes);
    const std::size_t before_footer = file.size() - footer_bytes;
    if (start == 0 || start > before_footer || before_footer - start < extension_bytes) return {};
    const Bytes area = file.subspan(start, extension_bytes);
    if (le16(area, 0) < extension_bytes) return {};
    TgaExtension extension{alpha_of(u8(area, alpha_at)), {}};
    extension.description.gamma = gamma_of(ratio_at(area, gamma_at));
    extension.description.aspect = aspect_of(ratio_at(area, aspect_at));
    return extension;
}

void append_tga_extension(std::vector<std::byte>& file, const Description& description, bool alpha) {
    const std::optional<Ratio> gamma = gamma_ratio(description), aspect = aspect_ratio(description);
    if (!gamma && !aspect) return;
    const std::size_t start = file.size(), footer = start + extension_bytes;
    file.resize(footer + footer_bytes);
    put(file, start, 2, extension_bytes);
    put(file, start + aspect_at, aspect);
    put(file, start + gamma_at, gamma);
    put(file, start + alpha_at, 1, alpha ? 3 : 0);
    put(file, footer, 4, std::uint32_t(start));
    std::transform(signature.begin(), signature.end(), file.end() - std::ptrdiff_t(signature.size()),
                   [](char c) { return std::byte(c); });
}

}  // namespace probewarp
