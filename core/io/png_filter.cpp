#include "io/png_filter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdlib>

#ifndef PROBEWARP_PNG_FILTER_ONCE
#define PROBEWARP_PNG_FILTER_ONCE
namespace probewarp {
namespace {

/// What a filter looks at. row, above: #bytes
struct Row {
    const std::uint8_t *row, *above;
    std::size_t bytes;
    std::size_t step;  ///< bytes of a pixel
};

using Sums = std::array<std::uint64_t, 5>;  // of magnitudes, by filter

/// Section 9.2, byte i: what is left of it without what the filter foresees from a, to the left, b, above,
/// and c, to the left of that.
std::uint8_t residual(unsigned type, const Row& r, std::size_t i) {
    const int a = i < r.step ? 0 : r.row[i - r.step], b = r.above[i],
              c = i < r.step ? 0 : r.above[i - r.step];
    const int from_a = std::abs(b - c), from_b = std::abs(a - c), from_c = std::abs(a + b - 2 * c);
    const int paeth = from_a <= from_b && from_a <= from_c ? a : from_b <= from_c ? b : c;
    const std::array<int, 5> foreseen{0, a, b, (a + b) / 2, paeth};
    return std::uint8_t(r.row[i] - foreseen[type]);
}

void add_magnitudes(const Row& r, std::size_t i, Sums& sums) {
    for (unsigned type = 0; type < 5; ++type) {
        const std::uint8_t left = residual(type, r, i);
        sums[type] += std::min(left, std::uint8_t(-left));
    }
}

}  // namespace
}  // namespace probewarp
#endif

// This file is compiled once for each instruction set, all of them into one program.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "io/png_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace probewarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<std::uint8_t>;
using Vector = hn::Vec<Tag>;
using SumTag = hn::Repartition<std::uint64_t, Tag>;

/// A byte, and what is to the left of it, above, and to the left of that.
struct Seen {
    Vector x, a, b, c;
};

/// i >= step
HWY_INLINE Seen SeenAt(const Row& r, std::size_t i) {
    const Tag tag;
    return {hn::LoadU(tag, r.row + i), hn::LoadU(tag, r.row + i - r.step), hn::LoadU(tag, r.above + i),
            hn::LoadU(tag, r.above + i - r.step)};
}

HWY_INLINE Vector Distance(Vector a, Vector b) {
    return hn::Or(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a));
}

/// (a + b) / 2, which the instruction rounds up.
HWY_INLINE Vector Mean(Vector a, Vector b) {
    const Vector odd = hn::And(hn::Xor(a, b), hn::Set(Tag(), 1));
    return hn::Sub(hn::AverageRound(a, b), odd);
}

/// Section 9.4. Where a and b lie on one side of c, a + b - c is at least as far from c as from either, and
/// c is never taken; else its distance is the difference of theirs.
HWY_INLINE Vector Paeth(Vector a, Vector b, Vector c) {
    const Vector from_a = Distance(b, c), from_b = Distance(a, c), from_c = Distance(from_a, from_b);
    const auto beyond_a = hn::Eq(hn::Max(a, c), a), beyond_b = hn::Eq(hn::Max(b, c), b);
    const auto one_side = hn::Not(hn::Xor(beyond_a, beyond_b));
    const auto not_c =
        hn::Or(one_side, hn::Eq(hn::Min(hn::Min(from_a, from_b), from_c), hn::Min(from_a, from_b)));
    const auto a_first = hn::Eq(hn::Min(from_a, from_b), from_a);
    return hn::IfThenElse(not_c, hn::IfThenElse(a_first, a, b), c);
}

HWY_INLINE Vector Residual(unsigned type, const Seen& s) {
    switch (type) {
        case 0:
            return s.x;
        case 1:
            return hn::Sub(s.x, s.a);
        case 2:
            return hn::Sub(s.x, s.b);
        case 3:
            return hn::Sub(s.x, Mean(s.a, s.b));
        default:
            return hn::Sub(s.x, Paeth(s.a, s.b, s.c));
    }
}

HWY_INLINE hn::Vec<SumTag> Magnitudes(Vector left) {
    return hn::SumsOf8(hn::Min(left, hn::Sub(hn::Zero(Tag()), left)));
}

Sums SumsOfMagnitudes(const Row& r) {
    const SumTag tag;
    const std::size_t lanes = hn::Lanes(Tag());
    hn::Vec<SumTag> none = hn::Zero(tag), sub = none, up = none, average = none, paeth = none;
    std::size_t i = r.step;
    for (; i + lanes <= r.bytes; i += lanes) {
        const Seen s = SeenAt(r, i);
        none = hn::Add(none, Magnitudes(Residual(0, s)));
        sub = hn::Add(sub, Magnitudes(Residual(1, s)));
        up = hn::Add(up, Magnitudes(Residual(2, s)));
        average = hn::Add(average, Magnitudes(Residual(3, s)));
        paeth = hn::Add(paeth, Magnitudes(Residual(4, s)));
    }
    const auto total = [&](hn::Vec<SumTag> v) HWY_ATTR { return hn::GetLane(hn::SumOfLanes(tag, v)); };
    Sums sums{total(none), total(sub), total(up), total(average), total(paeth)};
    for (std::size_t k = 0; k < r.step; ++k) add_magnitudes(r, k, sums);
    for (; i < r.bytes; ++i) add_magnitudes(r, i, sums);
    return sums;
}

template <unsigned type>
void FilterAs(const Row& r, std::uint8_t* out) {
    const std::size_t lanes = hn::Lanes(Tag());
    std::size_t i = r.step;
    for (; i + lanes <= r.bytes; i += lanes) hn::StoreU(Residual(type, SeenAt(r, i)), Tag(), out + i);
    for (std::size_t k = 0; k < r.step; ++k) out[k] = residual(type, r, k);
    for (; i < r.bytes; ++i) out[i] = residual(type, r, i);
}

void Filter(unsigned type, const Row& r, std::uint8_t* out) {
    constexpr std::array filters{FilterAs<0>, FilterAs<1>, FilterAs<2>, FilterAs<3>, FilterAs<4>};
    filters[type](r, out);
}

void DropAlpha(const std::uint8_t* rgba, std::size_t pixels, std::uint8_t* rgb) {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag);
    std::size_t i = 0;
    for (; i + lanes <= pixels; i += lanes) {
        Vector red, green, blue, alpha;
        hn::LoadInterleaved4(tag, rgba + 4 * i, red, green, blue, alpha);
        hn::StoreInterleaved3(red, green, blue, tag, rgb + 3 * i);
    }
    for (; i < pixels; ++i) std::copy_n(rgba + 4 * i, 3, rgb + 3 * i);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace probewarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace probewarp {

HWY_EXPORT(SumsOfMagnitudes);
HWY_EXPORT(Filter);
HWY_EXPORT(DropAlpha);

void filter_row(std::span<const std::uint8_t> row, std::span<const std::uint8_t> above, std::size_t step,
                FilterSet filters, std::span<std::uint8_t> out) {
    assert(filters != 0 && row.size() >= step && above.size() == row.size() && out.size() == row.size() + 1);
    const Row r{row.data(), above.data(), row.size(), step};
    unsigned best = unsigned(std::countr_zero(filters));
    if (!std::has_single_bit(filters)) {
        const Sums sums = HWY_DYNAMIC_DISPATCH(SumsOfMagnitudes)(r);
        for (unsigned type = best + 1; type < 5; ++type)
            if ((filters >> type & 1u) != 0 && sums[type] < sums[best]) best = type;
    }
    out[0] = std::uint8_t(best);
    HWY_DYNAMIC_DISPATCH(Filter)(best, r, out.data() + 1);
}

void drop_alpha(std::span<const std::uint8_t> rgba, std::span<std::uint8_t> rgb) {
    assert(rgba.size() / 4 == rgb.size() / 3);
    HWY_DYNAMIC_DISPATCH(DropAlpha)(rgba.data(), rgba.size() / 4, rgb.data());
}

}  // namespace probewarp
#endif
