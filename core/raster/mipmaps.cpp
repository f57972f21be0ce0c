#include "raster/mipmaps.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

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

/// Likewise, of opaque ones, for a whole row: the same, without the long divisions. above, below: #count x 2
/// x 4; to: #count x 4
void halve_opaque(const std::uint16_t* above, const std::uint16_t* below, std::size_t count,
                  std::uint16_t* to) {
    for (std::size_t i = 0; i < 4 * count; ++i) {
        const std::size_t left = i / 4 * 8 + i % 4, right = left + 4;
        to[i] =
            std::uint16_t((std::uint32_t(above[left]) + above[right] + below[left] + below[right] + 2) / 4);
    }
}

void halve_opaque(const std::uint8_t* above, const std::uint8_t* below, std::size_t count, std::uint8_t* to) {
    // Two channels at a time, each with room for its sum: so the compiler sees what a vector can do.
    constexpr std::uint32_t every_other = 0x00FF00FF, halves = 0x00020002;
    const auto pixel = [](const std::uint8_t* row, std::size_t x) {
        std::uint32_t rgba;
        std::memcpy(&rgba, row + 4 * x, sizeof rgba);
        return rgba;
    };
    for (std::size_t x = 0; x < count; ++x) {
        const std::uint32_t a = pixel(above, 2 * x), b = pixel(above, 2 * x + 1);
        const std::uint32_t c = pixel(below, 2 * x), d = pixel(below, 2 * x + 1);
        const std::uint32_t even =
            (a & every_other) + (b & every_other) + (c & every_other) + (d & every_other) + halves;
        const std::uint32_t odd = (a >> 8 & every_other) + (b >> 8 & every_other) + (c >> 8 & every_other) +
                                  (d >> 8 & every_other) + halves;
        const std::uint32_t mean = (even >> 2 & every_other) | (odd >> 2 & every_other) << 8;
        std::memcpy(to + 4 * x, &mean, sizeof mean);
    }
}

/// A row of half(size). from: `size`; to: the row
template <class Sample>
void halve_row(const Sample* from, Extent size, int y, Sample* to) {
    const std::size_t row = std::size_t(size.width) * 4;
    const Sample* above = from + std::size_t(2 * y) * row;
    const Sample* below = from + std::size_t(std::min(2 * y + 1, size.height - 1)) * row;
    if (size.width > 1 && is_opaque(std::span(above, row)) && is_opaque(std::span(below, row)))
        return halve_opaque(above, below, std::size_t(half(size).width), to);
    for (int x = 0; x < half(size).width; ++x, to += 4) {
        const std::size_t left = std::size_t(2 * x) * 4,
                          right = std::size_t(std::min(2 * x + 1, size.width - 1)) * 4;
        const auto q = mean<Sample>({above + left, above + right, below + left, below + right});
        std::copy(q.begin(), q.end(), to);
    }
}

/// How many rows of half(size) follow from the first `rows` rows.
int rows_halved(int rows, Extent size) { return rows == size.height ? half(size).height : rows / 2; }

/// Rows of `to` from `first` to before `end`.
void halve_rows(const Image& from, Image& to, int first, int end) {
    const Extent size{from.width, from.height};
    const std::size_t row = std::size_t(to.width) * 4;
    std::visit(
        [&]<class Sample>(const std::vector<Sample>& above) {
            auto& below = std::get<std::vector<Sample>>(to.rgba);
            using Range = oneapi::tbb::blocked_range<int>;
            oneapi::tbb::parallel_for(Range(first, end), [&](const Range& rows) {
                for (int y = rows.begin(); y < rows.end(); ++y)
                    halve_row(above.data(), size, y, below.data() + std::size_t(y) * row);
            });
        },
        from.rgba);
}

}  // namespace

std::vector<Image> room_for_levels(const Image& image, int most) {
    std::vector<Image> levels;
    const int all = int(std::bit_width(unsigned(std::max(image.width, image.height)))) - 1;
    Extent size{image.width, image.height};
    for (int i = 0; i < std::min(most, all); ++i) {
        size = half(size);
        Image& level = levels.emplace_back();
        level.width = size.width;
        level.height = size.height;
        const std::size_t samples = std::size_t(size.width) * std::size_t(size.height) * 4;
        std::visit(
            [&]<class Sample>(const std::vector<Sample>&) { level.rgba = std::vector<Sample>(samples); },
            image.rgba);
    }
    return levels;
}

void fill_levels(const Image& image, std::span<Image> levels, int first, int end) {
    const Image* from = &image;
    for (Image& level : levels) {
        const Extent size{from->width, from->height};
        first = rows_halved(first, size);
        end = rows_halved(end, size);
        halve_rows(*from, level, first, end);
        from = &level;
    }
}

std::vector<Image> smaller_levels(const Image& image, int most) {
    std::vector<Image> levels = room_for_levels(image, most);
    fill_levels(image, levels, 0, image.height);
    return levels;
}

}  // namespace probewarp
