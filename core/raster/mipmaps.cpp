#include "raster/mipmaps.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <type_traits>

namespace probewarp {

Extent half(Extent of) { return {std::max(1, of.width / 2), std::max(1, of.height / 2)}; }

namespace {

/// The alpha-weighted mean of four pixels.
template <class Sample>
std::array<Sample, 4> mean(const std::array<const Sample*, 4>& pixels) {
    std::uint64_t weighted[3]{}, plain[3]{}, alpha = 0;
    for (const Sample* p : pixels) {
        for (int k = 0; k < 3; ++k) weighted[k] += std::uint64_t(p[k]) * p[3], plain[k] += p[k];
        alpha += p[3];
    }
    std::array<Sample, 4> q;
    for (std::size_t k = 0; k < 3; ++k)
        q[k] = Sample(alpha > 0 ? (weighted[k] + alpha / 2) / alpha : (plain[k] + 2) / 4);
    q[3] = Sample((alpha + 2) / 4);
    return q;
}

/// Likewise, of opaque ones: the same, without the long divisions.
template <class Sample>
std::array<Sample, 4> opaque_mean(const std::array<const Sample*, 4>& pixels) {
    std::array<Sample, 4> q;
    for (std::size_t k = 0; k < 4; ++k)
        q[k] = Sample((std::uint32_t(pixels[0][k]) + pixels[1][k] + pixels[2][k] + pixels[3][k] + 2) / 4);
    return q;
}

/// A row of half(size). from: `size`; to: the row
template <class Sample>
void halve_row(const Sample* from, Extent size, int y, Sample* to) {
    const std::size_t row = std::size_t(size.width) * 4;
    const Sample* above = from + std::size_t(2 * y) * row;
    const Sample* below = from + std::size_t(std::min(2 * y + 1, size.height - 1)) * row;
    for (int x = 0; x < half(size).width; ++x, to += 4) {
        const std::size_t left = std::size_t(2 * x) * 4,
                          right = std::size_t(std::min(2 * x + 1, size.width - 1)) * 4;
        const std::array<const Sample*, 4> four{above + left, above + right, below + left, below + right};
        const auto alpha = four[0][3] & four[1][3] & four[2][3] & four[3][3];
        const auto q = alpha == std::numeric_limits<Sample>::max() ? opaque_mean(four) : mean(four);
        std::copy(q.begin(), q.end(), to);
    }
}

Image half_size(const Image& image) {
    const Extent size{image.width, image.height};
    Image next;
    next.width = half(size).width;
    next.height = half(size).height;
    const std::size_t row = std::size_t(next.width) * 4;
    std::visit(
        [&](const auto& from) {
            auto to = std::remove_cvref_t<decltype(from)>(row * std::size_t(next.height));
            using Range = oneapi::tbb::blocked_range<int>;
            oneapi::tbb::parallel_for(Range(0, next.height), [&](const Range& rows) {
                for (int y = rows.begin(); y < rows.end(); ++y)
                    halve_row(from.data(), size, y, to.data() + std::size_t(y) * row);
            });
            next.rgba = std::move(to);
        },
        image.rgba);
    return next;
}

}  // namespace

std::vector<Image> smaller_levels(const Image& image, int most) {
    std::vector<Image> levels;
    const int all = int(std::bit_width(unsigned(std::max(image.width, image.height)))) - 1;
    for (int i = 0; i < std::min(most, all); ++i)
        levels.push_back(half_size(levels.empty() ? image : levels.back()));
    return levels;
}

}  // namespace probewarp
