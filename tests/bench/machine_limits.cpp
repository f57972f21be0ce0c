#include "machine_limits.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "machine_limits.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace probewarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Tag>;

float ReadAll(const float* values, std::size_t count) {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag);
    Vector a = hn::Zero(tag), b = a, c = a, d = a;
    for (std::size_t i = 0; i < count; i += 4 * lanes) {
        for (std::size_t line = 0; line < 4 * lanes; line += 16) hwy::Prefetch(values + i + 512 + line);
        a = hn::Add(a, hn::Load(tag, values + i));
        b = hn::Add(b, hn::Load(tag, values + i + lanes));
        c = hn::Add(c, hn::Load(tag, values + i + 2 * lanes));
        d = hn::Add(d, hn::Load(tag, values + i + 3 * lanes));
    }
    return hn::GetLane(hn::SumOfLanes(tag, hn::Add(hn::Add(a, b), hn::Add(c, d))));
}

std::size_t MultiplyAdd(std::size_t rounds, float* sink) {
    const Tag tag;
    const Vector x = hn::Set(tag, *sink), y = hn::Set(tag, 0.5f);
    // Chains that begin alike would be one to the compiler.
    Vector a = hn::Iota(tag, 0), b = hn::Iota(tag, 1), c = hn::Iota(tag, 2), d = hn::Iota(tag, 3);
    Vector e = hn::Iota(tag, 4), f = hn::Iota(tag, 5), g = hn::Iota(tag, 6), h = hn::Iota(tag, 7);
    Vector i = hn::Iota(tag, 8), j = hn::Iota(tag, 9), k = hn::Iota(tag, 10), l = hn::Iota(tag, 11);
    for (std::size_t n = 0; n < rounds; ++n) {
        a = hn::MulAdd(a, y, x), b = hn::MulAdd(b, y, x), c = hn::MulAdd(c, y, x);
        d = hn::MulAdd(d, y, x), e = hn::MulAdd(e, y, x), f = hn::MulAdd(f, y, x);
        g = hn::MulAdd(g, y, x), h = hn::MulAdd(h, y, x), i = hn::MulAdd(i, y, x);
        j = hn::MulAdd(j, y, x), k = hn::MulAdd(k, y, x), l = hn::MulAdd(l, y, x);
    }
    a = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, d)), hn::Add(hn::Add(e, f), hn::Add(g, h)));
    *sink = hn::GetLane(hn::Add(a, hn::Add(hn::Add(i, j), hn::Add(k, l))));
    return rounds * 12 * hn::Lanes(tag);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace probewarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace probewarp {
HWY_EXPORT(ReadAll);
HWY_EXPORT(MultiplyAdd);
float read_all(std::span<const float> values) {
    return HWY_DYNAMIC_DISPATCH(ReadAll)(values.data(), values.size());
}
std::size_t multiply_add(std::size_t rounds, float& sink) {
    return HWY_DYNAMIC_DISPATCH(MultiplyAdd)(rounds, &sink);
}
}  // namespace probewarp
#endif
