#include "io/png_filter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

namespace probewarp {

namespace {

using std::uint8_t;

// Sixteen bits are enough for every sum of the predictors, and let twice as many lanes into a vector as 32.
using Wide = std::int16_t;

Wide magnitude(Wide v) { return v < 0 ? Wide(-v) : v; }

/// Section 9.4: whichever of left, above and upper left is nearest to a + b - c, in this order.
Wide paeth(Wide a, Wide b, Wide c) {
    const Wide from_a = magnitude(Wide(b - c)), from_b = magnitude(Wide(a - c)),
               from_c = magnitude(Wide(a + b - 2 * c));
    const Wide b_or_c = from_b <= from_c ? b : c;
    return from_a <= std::min(from_b, from_c) ? a : b_or_c;
}

/// What is left of the row without what `predict` says of each byte from the ones to the left, above, and
/// to the left of that. Without branches and without aliases, so that the compiler makes vectors of it.
template <class Predict>
void filter(const uint8_t* __restrict row, const uint8_t* __restrict above, std::size_t bytes,
            std::size_t step, uint8_t* __restrict out, Predict predict) {
    for (std::size_t i = 0; i < step; ++i)
        out[i] = uint8_t(row[i] - predict(Wide(0), Wide(above[i]), Wide(0)));
    for (std::size_t i = step; i < bytes; ++i)
        out[i] = uint8_t(row[i] - predict(Wide(row[i - step]), Wide(above[i]), Wide(above[i - step])));
}

void filter(unsigned type, const uint8_t* row, const uint8_t* above, std::size_t bytes, std::size_t step,
            uint8_t* out) {
    const auto by = [&](auto predict) { filter(row, above, bytes, step, out, predict); };
    switch (type) {
        case 0:
            return by([](Wide, Wide, Wide) { return Wide(0); });
        case 1:
            return by([](Wide a, Wide, Wide) { return a; });
        case 2:
            return by([](Wide, Wide b, Wide) { return b; });
        case 3:
            return by([](Wide a, Wide b, Wide) { return Wide((a + b) >> 1); });
        default:
            return by([](Wide a, Wide b, Wide c) { return paeth(a, b, c); });
    }
}

/// The sum of the magnitudes of the bytes taken as signed.
std::uint32_t sum_of_magnitudes(const uint8_t* bytes, std::size_t count) {
    constexpr std::size_t run = 256;  // 256 times 128, the largest magnitude, still fits into 16 bits
    std::uint32_t sum = 0;
    for (std::size_t first = 0; first < count; first += run) {
        std::uint16_t part = 0;
        for (std::size_t i = first; i < std::min(first + run, count); ++i)
            part = std::uint16_t(part + std::min(bytes[i], uint8_t(-bytes[i])));
        sum += part;
    }
    return sum;
}

}  // namespace

void filter_row(std::span<const uint8_t> row, std::span<const uint8_t> above, std::size_t step,
                FilterSet filters, std::span<uint8_t> out, std::vector<uint8_t>& scratch) {
    assert(filters != 0 && row.size() >= step && above.size() == row.size() && out.size() == row.size() + 1);
    const bool choice = !std::has_single_bit(filters);
    scratch.resize(row.size());
    std::uint32_t least = 0xFFFFFFFF;
    for (unsigned type = 0; type < 5; ++type) {
        if ((filters >> type & 1u) == 0) continue;
        uint8_t* to = choice ? scratch.data() : out.data() + 1;
        filter(type, row.data(), above.data(), row.size(), step, to);
        const std::uint32_t sum = choice ? sum_of_magnitudes(to, row.size()) : 0;
        if (sum >= least) continue;
        least = sum;
        out[0] = uint8_t(type);
        if (choice) std::copy(scratch.begin(), scratch.end(), out.begin() + 1);
    }
}

}  // namespace probewarp
