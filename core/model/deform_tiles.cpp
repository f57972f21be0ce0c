#include "model/deform_tiles.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "math/blend.h"
#include "model/over_blocks.h"

#ifndef PROBEWARP_DEFORM_TILES_ONCE
#define PROBEWARP_DEFORM_TILES_ONCE
namespace probewarp {
namespace {

template <class Sum>  // OthersSum, const or not
auto others_at(Sum& others, std::size_t vertex) {
    return others.values.data() + vertex / tile_width * 4 * tile_width + vertex % tile_width;
}

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

#include "model/move_run-inl.h"

HWY_BEFORE_NAMESPACE();
namespace probewarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, tile_width>;
using Vector = hn::Vec<Tag>;

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

/// What Move takes, for two vectors of vertices.
struct Sums {
    Vector a, b, c, d, a2, b2, c2, d2;
};

/// s0 = a + ib and s1 = c + id of two vectors of vertices, the first of them `v`.
HWY_INLINE Sums SumTwo(const WeightTiles& tiles, std::span<const DualComplex<float>> p, std::size_t v) {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag);
    const float *first = column(tiles, v), *second = column(tiles, v + lanes);
    Vector a = hn::Zero(tag), b = a, c = a, d = a, a2 = a, b2 = a, c2 = a, d2 = a;
    for (const auto& [p0, p1] : p) {
        hwy::Prefetch(first + floats_ahead);
        if (lanes == tile_width) hwy::Prefetch(second + floats_ahead);
        const Vector w = hn::Load(tag, first), w2 = hn::Load(tag, second);
        const Vector re0 = hn::Set(tag, p0.real()), im0 = hn::Set(tag, p0.imag());
        const Vector re1 = hn::Set(tag, p1.real()), im1 = hn::Set(tag, p1.imag());
        a = hn::MulAdd(w, re0, a), a2 = hn::MulAdd(w2, re0, a2);
        b = hn::MulAdd(w, im0, b), b2 = hn::MulAdd(w2, im0, b2);
        c = hn::MulAdd(w, re1, c), c2 = hn::MulAdd(w2, re1, c2);
        d = hn::MulAdd(w, im1, d), d2 = hn::MulAdd(w2, im1, d2);
        first += tile_width, second += tile_width;
    }
    return {a, b, c, d, a2, b2, c2, d2};
}

constexpr float smallest = std::numeric_limits<float>::min();
/// Where the others' sum and the dragged probe's part may cancel to less than this share of all weights,
/// the plain function decides. Four times cancelled_share, so that rounding has room.
constexpr float unsure_share = 4 * cancelled_share<float>;
/// A dragged probe with no weight, or less than this share, counts as having this much: 8192 pixels by it
/// are 1e-8.
constexpr float least_share = 1e-12f;

/// What the sums of all probes are taken from.
struct AllProbes {
    const WeightTiles& tiles;
    std::span<const DualComplex<float>> p;

    HWY_INLINE Sums operator()(std::size_t v) const { return SumTwo(tiles, p, v); }
};

/// What they are taken from while one probe is dragged: what the others add up to over the one's weight, so
/// that the one adds itself.
struct OneProbe {
    const OthersSum& others;
    const DualComplex<float>& p;

    HWY_INLINE Vector Row(std::size_t v, std::size_t row, float own) const {
        const Tag tag;
        return hn::Add(hn::Load(tag, others_at(others, v) + row * tile_width), hn::Set(tag, own));
    }
    HWY_INLINE Sums operator()(std::size_t v) const {
        const std::size_t v2 = v + hn::Lanes(Tag());
        const float a = p.p0.real(), b = p.p0.imag(), c = p.p1.real(), d = p.p1.imag();
        return {Row(v, 0, a),  Row(v, 1, b),  Row(v, 2, c),  Row(v, 3, d),
                Row(v2, 0, a), Row(v2, 1, b), Row(v2, 2, c), Row(v2, 3, d)};
    }
};

/// Moves two vectors of vertices. least: where |s0|^2 is not above it, or not a number, the plain function
/// decides
template <class SumsAt>
struct MoveTwo {
    const WeightTiles& tiles;
    const Pose& pose;
    const SumsAt& sums_at;
    float least;

    HWY_INLINE std::size_t operator()(std::size_t v, const glm::vec2* rest, glm::vec2* now) const {
        const std::size_t lanes = hn::Lanes(Tag());
        const Sums s = sums_at(v);
        const bool one = Move(s.a, s.b, s.c, s.d, pose.centre, least, &rest->x, &now->x);
        const bool other = Move(s.a2, s.b2, s.c2, s.d2, pose.centre, least, &rest[lanes].x, &now[lanes].x);
        if (HWY_LIKELY(one && other)) return 0;
        return settle_cancelled(tiles, pose, {v, 2 * lanes}, rest, now);
    }
};

std::size_t DeformRun(const WeightTiles& tiles, const Pose& pose, VertexRun run, const glm::vec2* rest,
                      glm::vec2* now) {
    const float share = cancelled_share<float> * tiles.largest_sum;
    const AllProbes sums{tiles, pose.transformations};
    const MoveTwo<AllProbes> move{tiles, pose, sums, std::max(share * share, smallest)};
    return MoveRun(run, 2 * hn::Lanes(Tag()), rest, now, move);
}

std::size_t DragRun(const WeightTiles& tiles, const Pose& pose, const OthersSum& others, VertexRun run,
                    const glm::vec2* rest, glm::vec2* now) {
    const OneProbe sums{others, pose.transformations[others.probe]};
    const MoveTwo<OneProbe> move{tiles, pose, sums, smallest};
    return MoveRun(run, 2 * hn::Lanes(Tag()), rest, now, move);
}

/// One vector of OthersSum. w: the dragged probe's weights; total: the sum of all weights
HWY_INLINE void StoreOver(Vector a, Vector b, Vector c, Vector d, Vector w, Vector total, float* to) {
    const Tag tag;
    // Its sum with one of length w may be as short as this.
    const Vector shortest = hn::Abs(hn::Sub(hn::Sqrt(hn::MulAdd(a, a, hn::Mul(b, b))), w));
    const auto unsure = hn::Not(hn::Ge(shortest, hn::Mul(total, hn::Set(tag, unsure_share))));
    const Vector over = hn::Max(w, hn::Mul(total, hn::Set(tag, least_share)));
    hn::Store(hn::IfThenElse(unsure, hn::NaN(tag), hn::Div(a, over)), tag, to);
    hn::Store(hn::Div(b, over), tag, to + tile_width);
    hn::Store(hn::Div(c, over), tag, to + 2 * tile_width);
    hn::Store(hn::Div(d, over), tag, to + 3 * tile_width);
}

/// p, all: the transformations with 0 in the dragged probe's place, and as many ones
void SumOthersRun(const WeightTiles& tiles, std::span<const DualComplex<float>> p,
                  std::span<const DualComplex<float>> all, VertexRun run, OthersSum& others) {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag), own = others.probe * tile_width;
    // To the end of the last block, whatever the vectors' width: no part of `others` is left as it was found.
    const std::size_t end = (run.first + run.count + tile_block - 1) / tile_block * tile_block;
    for (std::size_t v = run.first; v < end; v += 2 * lanes) {
        const Sums s = SumTwo(tiles, p, v), total = SumTwo(tiles, all, v);
        const Vector w = hn::Load(tag, column(tiles, v) + own);
        const Vector w2 = hn::Load(tag, column(tiles, v + lanes) + own);
        StoreOver(s.a, s.b, s.c, s.d, w, total.a, others_at(others, v));
        StoreOver(s.a2, s.b2, s.c2, s.d2, w2, total.a2, others_at(others, v + lanes));
    }
}

const char* Name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace probewarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace probewarp {

HWY_EXPORT(DeformRun);
HWY_EXPORT(DragRun);
HWY_EXPORT(SumOthersRun);
HWY_EXPORT(Name);

std::size_t deform_dlb(const WeightTiles& tiles, std::span<const glm::vec2> rest, const Pose& pose,
                       VertexRun run, std::span<glm::vec2> now) {
    assert(rest.size() == tiles.vertices && now.size() == tiles.vertices && now.data() != rest.data());
    assert(pose.transformations.size() == tiles.probes);
    return over_blocks(run, tiles.vertices, tiles.probes, [&](VertexRun part) {
        return HWY_DYNAMIC_DISPATCH(DeformRun)(tiles, pose, part, rest.data(), now.data());
    });
}

OthersSum sum_others(const WeightTiles& tiles, const Pose& pose, std::size_t probe) {
    assert(probe < tiles.probes && pose.transformations.size() == tiles.probes);
    std::vector<DualComplex<float>> p(pose.transformations.begin(), pose.transformations.end());
    p[probe] = {0, 0};
    const std::vector<DualComplex<float>> ones(p.size(), {1, 0});
    OthersSum others{probe, AlignedFloats(tiles.weights.size() / tiles.probes * 4)};
    over_blocks({0, tiles.vertices}, tiles.vertices, tiles.probes, [&](VertexRun part) {
        HWY_DYNAMIC_DISPATCH(SumOthersRun)(tiles, p, ones, part, others);
        return std::size_t{0};
    });
    return others;
}

std::size_t deform_dlb_dragged(const WeightTiles& tiles, const OthersSum& others,
                               std::span<const glm::vec2> rest, const Pose& pose, std::span<glm::vec2> now) {
    assert(rest.size() == tiles.vertices && now.size() == tiles.vertices && now.data() != rest.data());
    assert(pose.transformations.size() == tiles.probes &&
           others.values.size() * tiles.probes == tiles.weights.size() * 4);
    constexpr std::size_t as_many_as = 8;  // probes: the sums, rest and now are 8 floats a vertex
    return over_blocks({0, tiles.vertices}, tiles.vertices, as_many_as, [&](VertexRun part) {
        return HWY_DYNAMIC_DISPATCH(DragRun)(tiles, pose, others, part, rest.data(), now.data());
    });
}

const char* deform_target() { return HWY_DYNAMIC_DISPATCH(Name)(); }

}  // namespace probewarp
#endif
