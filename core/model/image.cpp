#include "model/image.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <type_traits>

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

bool has_alpha(const Image& image) {
    return std::visit(
        [](const auto& samples) {
            using Sample = typename std::decay_t<decltype(samples)>::value_type;
            for (std::size_t i = 3; i < samples.size(); i += 4)
                if (samples[i] != std::numeric_limits<Sample>::max()) return true;
            return false;
        },
        image.rgba);
}

}  // namespace probewarp
