#include "model/deform_tiles.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "math/blend.h"

#ifndef PROBEWARP_DEFORM_TILES_ONCE
#define PROBEWARP_DEFORM_TILES_ONCE
namespace probewarp {
namespace {

/// The few vertices that may be cancelled are looked at one by one, and decided as deform_dlb does. The
/// others keep what the vectors said, but where rounding left nothing to divide by. rest, now: run.count
std::size_t settle_cancelled(const WeightTiles& tiles, const Pose& pose, VertexRun run, const glm::vec2* rest,
                             glm::vec2* now) {
    std::size_t cancelled = 0;
    for (std::size_t k = 0; k < run.count; ++k) {
        const MovedVertex plain = dlb_vertex(column(tiles, run.first + k), tile_width, pose, rest[k]);
        if (plain.cancelled || !std::isfinite(now[k].x + now[k].y)) now[k] = plain.now;
        cancelled += plain.cancelled;
    }
    return cancelled;
}

}  // namespace
}  // namespace probewarp
#endif

// This file is compiled once for each instruction set, all of them into one program.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/deform_tiles.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace probewarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, tile_width>;
using Vector = hn::Vec<Tag>;

/// How far ahead of the sums the weights are fetched: 2 KB, the middle of the 1 to 4 KB that serve alike.
constexpr std::size_t floats_ahead = 512;

/// Moves a vector of vertices by 2 s0 (i Im(s0) v + s1) / |s0|^2 with s0 = a + ib and s1 = c + id. Whether
/// |s0|^2 > least at all of them; only there is the result of use. rest, now: x and y in turns
HWY_INLINE bool Move(Vector a, Vector b, Vector c, Vector d, glm::vec2 centre, float least, const float* rest,
                     float* now) {
    const Tag tag;
    Vector x, y;
    hn::LoadInterleaved2(tag, rest, x, y);
    const Vector from_x = hn::Sub(x, hn::Set(tag, centre.x)), from_y = hn::Sub(y, hn::Set(tag, centre.y));
    const Vector along = hn::NegMulAdd(b, from_y, c), across = hn::MulAdd(b, from_x, d);
    const Vector size = hn::MulAdd(a, a, hn::Mul(b, b));
    const Vector scale = hn::Div(hn::Set(tag, 2.0f), size);
    const Vector dx = hn::Sub(hn::Mul(a, along), hn::Mul(b, across));
    const Vector dy = hn::MulAdd(a, across, hn::Mul(b, along));
    hn::StoreInterleaved2(hn::MulAdd(scale, dx, x), hn::MulAdd(scale, dy, y), tag, now);
    return hn::AllTrue(tag, hn::Gt(size, hn::Set(tag, least)));
}

/// Moves two vectors of vertices, the first of them `v`; the arrays begin there. Whether both could be.
HWY_INLINE bool MoveTwo(const WeightTiles& tiles, const Pose& pose, float least, std::size_t v,
                        const glm::vec2* rest, glm::vec2* now) {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag);
    const float *first = column(tiles, v), *second = column(tiles, v + lanes);
    Vector a = hn::Zero(tag), b = a, c = a, d = a, a2 = a, b2 = a, c2 = a, d2 = a;
    for (const auto& p : pose.transformations) {
        hwy::Prefetch(first + floats_ahead);
        if (lanes == tile_width) hwy::Prefetch(second + floats_ahead);
        const Vector w = hn::Load(tag, first), w2 = hn::Load(tag, second);
        const Vector re = hn::Set(tag, p.p0.real()), im = hn::Set(tag, p.p0.imag());
        const Vector re1 = hn::Set(tag, p.p1.real()), im1 = hn::Set(tag, p.p1.imag());
        a = hn::MulAdd(w, re, a), a2 = hn::MulAdd(w2, re, a2);
        b = hn::MulAdd(w, im, b), b2 = hn::MulAdd(w2, im, b2);
        c = hn::MulAdd(w, re1, c), c2 = hn::MulAdd(w2, re1, c2);
        d = hn::MulAdd(w, im1, d), d2 = hn::MulAdd(w2, im1, d2);
        first += tile_width, second += tile_width;
    }
    const bool one = Move(a, b, c, d, pose.centre, least, &rest->x, &now->x);
    const bool other = Move(a2, b2, c2, d2, pose.centre, least, &rest[lanes].x, &now[lanes].x);
    return one && other;
}

/// Two vectors of vertices, the first of them `v`; returns how many are cancelled.
HWY_INLINE std::size_t SettleTwo(const WeightTiles& tiles, const Pose& pose, float least, std::size_t v,
                                 const glm::vec2* rest, glm::vec2* now) {
    if (HWY_LIKELY(MoveTwo(tiles, pose, least, v, rest, now))) return 0;
    return settle_cancelled(tiles, pose, {v, 2 * hn::Lanes(Tag())}, rest, now);
}

std::size_t DeformRun(const WeightTiles& tiles, const Pose& pose, VertexRun run, const glm::vec2* rest,
                      glm::vec2* now) {
    const std::size_t step = 2 * hn::Lanes(Tag()), end = run.first + run.count;
    const float share = cancelled_share<float> * tiles.largest_sum;
    const float least = std::max(share * share, std::numeric_limits<float>::min());
    std::size_t cancelled = 0, v = run.first;
    for (; v + step <= end; v += step) cancelled += SettleTwo(tiles, pose, least, v, rest + v, now + v);
    for (; v < end; v += step) {
        glm::vec2 last[tile_block] = {}, moved[tile_block];
        std::copy(rest + v, rest + end, last);
        cancelled += SettleTwo(tiles, pose, least, v, last, moved);
        std::copy(moved, moved + (end - v), now + v);
    }
    return cancelled;
}

const char* Name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace probewarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace probewarp {

HWY_EXPORT(DeformRun);
HWY_EXPORT(Name);

std::size_t deform_dlb(const WeightTiles& tiles, std::span<const glm::vec2> rest, const Pose& pose,
                       VertexRun run, std::span<glm::vec2> now) {
    assert(rest.size() == tiles.vertices && now.size() == tiles.vertices && now.data() != rest.data());
    assert(pose.transformations.size() == tiles.probes && run.first + run.count <= tiles.vertices);
    if (run.count == 0) return 0;
    const std::size_t first = run.first / tile_block * tile_block;
    const std::size_t blocks = (run.first + run.count - first + tile_block - 1) / tile_block;
    const std::size_t end = std::min(first + blocks * tile_block, tiles.vertices);
    return HWY_DYNAMIC_DISPATCH(DeformRun)(tiles, pose, {first, end - first}, rest.data(), now.data());
}

const char* deform_target() { return HWY_DYNAMIC_DISPATCH(Name)(); }

}  // namespace probewarp
#endif
