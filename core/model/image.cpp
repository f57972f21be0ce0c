#include "model/image.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <cassert>
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

template <class Sample>
bool all_opaque(std::span<const Sample> rgba) {
    constexpr std::size_t at_once = 4096;  // without looking whether it is decided
    constexpr Sample full = std::numeric_limits<Sample>::max();
    for (; !rgba.empty(); rgba = rgba.subspan(std::min(at_once, rgba.size()))) {
        Sample all = full;
        for (std::size_t i = 3; i < std::min(at_once, rgba.size()); i += 4) all = Sample(all & rgba[i]);
        if (all != full) return false;
    }
    return true;
}

}  // namespace

bool is_opaque(std::span<const std::uint8_t> rgba) { return all_opaque(rgba); }
bool is_opaque(std::span<const std::uint16_t> rgba) { return all_opaque(rgba); }

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
    return !std::visit(opaque, image.rgba);
}

}  // namespace probewarp
