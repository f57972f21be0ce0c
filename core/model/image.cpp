#include "model/image.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <functional>
#include <limits>

namespace probewarp {

std::span<const std::byte> pixel_bytes(const Image& image) {
    return std::visit([](const auto& samples) { return std::as_bytes(std::span(samples)); }, image.rgba);
}

std::array<int, 4> pixel(const Image& image, int x, int y) {
    assert(x >= 0 && x < image.width && y >= 0 && y < image.height);
    const std::size_t at = (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 4;
    return std::visit(
        [at](const auto& s) {
            return std::array<int, 4>{s[at], s[at + 1], s[at + 2], s[at + 3]};
        },
        image.rgba);
}

namespace {

/// Pixel: an unsigned integer as long as four samples
template <class Pixel, class Sample>
bool all_opaque(std::span<const Sample> rgba) {
    static_assert(sizeof(Pixel) == 4 * sizeof(Sample));
    constexpr std::size_t at_once = 1024;  // pixels, without looking whether it is decided
    const std::size_t pixels = rgba.size() / 4;
    for (std::size_t first = 0; first < pixels; first += at_once) {
        Pixel all = std::numeric_limits<Pixel>::max();
        for (std::size_t i = first; i < std::min(first + at_once, pixels); ++i) {
            Pixel pixel;
            std::memcpy(&pixel, &rgba[4 * i], sizeof pixel);
            all &= pixel;
        }
        if (std::bit_cast<std::array<Sample, 4>>(all)[3] != std::numeric_limits<Sample>::max()) return false;
    }
    return true;
}

}  // namespace

bool is_opaque(std::span<const std::uint8_t> rgba) { return all_opaque<std::uint32_t>(rgba); }
bool is_opaque(std::span<const std::uint16_t> rgba) { return all_opaque<std::uint64_t>(rgba); }

bool has_alpha(const Image& image) {
    using Range = oneapi::tbb::blocked_range<std::size_t>;
    constexpr std::size_t at_once = std::size_t{1} << 20;  // samples
    const auto opaque = [](const auto& samples) {
        return oneapi::tbb::parallel_reduce(
            Range(0, samples.size() / 4, at_once / 4), true,
            [&](const Range& pixels, bool so_far) {
                return so_far && is_opaque(std::span(samples).subspan(4 * pixels.begin(), 4 * pixels.size()));
            },
            std::logical_and<>());
    };
    return !image.opaque && !std::visit(opaque, image.rgba);
}

}  // namespace probewarp
