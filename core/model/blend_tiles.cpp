#include "model/blend_tiles.h"

#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include "math/planar_blend.h"
#include "model/over_blocks.h"

#ifndef PROBEWARP_BLEND_TILES_ONCE
#define PROBEWARP_BLEND_TILES_ONCE
namespace probewarp {
namespace {

/// What a vertex's weights are to sum up of each probe: #probes rows of K numbers.
template <std::size_t K>
using Rows = std::vector<std::array<double, K>>;

using PlainBlend = Similarity<double> (*)(std::span<const double> weights,
                                          std::span<const Motion<double>> motions);

/// What moves farther than this is not known: image pixels. Positions are floats.
constexpr double farthest = 1e30;
/// Where what is near to having no answer begins: four times where there is none, so that rounding has room.
constexpr double unsure_share = 4 * cancelled_share<double>;

/// Moves vertices by the plain blend, one by one; those that the mesh does not have are left out. Returns how
/// many are cancelled. rest, now: begin at the run; weights: #probes, to be written
std::size_t move_plainly(const WeightTiles& tiles, const Pose& pose, PlainBlend blend, VertexRun run,
                         const glm::vec2* rest, glm::vec2* now, std::span<double> weights) {
    std::size_t cancelled = 0;
    for (std::size_t k = 0; k < run.count && run.first + k < tiles.vertices; ++k) {
        const float* w = column(tiles, run.first + k);
        for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = double(w[i * tile_width]);
        const Similarity<double> map = blend(weights, pose.motions);
        const auto place = to_complex(glm::dvec2(rest[k] - pose.centre));
        now[k] = rest[k] + glm::vec2(to_vec(map.less_one * place + map.shift));
        cancelled += map.cancelled;
    }
    return cancelled;
}

}  // namespace
}  // namespace probewarp
#endif

// This file is compiled once for each instruction set, all of them into one program.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/blend_tiles.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "hwy/contrib/math/math-inl.h"
#include "model/move_run-inl.h"

HWY_BEFORE_NAMESPACE();
namespace probewarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, tile_width / 2>;
using Floats = hn::Rebind<float, Tag>;
using Vector = hn::Vec<Tag>;

/// A vector of complex numbers.
struct Complex {
    Vector re, im;
};

HWY_INLINE Vector Number(double x) { return hn::Set(Tag(), x); }
HWY_INLINE Complex operator-(Complex a, Complex b) { return {hn::Sub(a.re, b.re), hn::Sub(a.im, b.im)}; }
HWY_INLINE Complex operator*(Complex a, Complex b) {
    return {hn::NegMulAdd(a.im, b.im, hn::Mul(a.re, b.re)), hn::MulAdd(a.im, b.re, hn::Mul(a.re, b.im))};
}
HWY_INLINE Complex operator*(Vector a, Complex b) { return {hn::Mul(a, b.re), hn::Mul(a, b.im)}; }
HWY_INLINE Complex operator/(Complex a, Vector b) { return {hn::Div(a.re, b), hn::Div(a.im, b)}; }
HWY_INLINE Complex conj(Complex a) { return {a.re, hn::Neg(a.im)}; }
HWY_INLINE Vector norm(Complex a) { return hn::MulAdd(a.re, a.re, hn::Mul(a.im, a.im)); }
HWY_INLINE Vector abs(Complex a) { return hn::Sqrt(norm(a)); }

HWY_INLINE Complex Number(std::complex<double> x) { return {Number(x.real()), Number(x.imag())}; }
HWY_INLINE Complex operator+(Complex a, Complex b) { return {hn::Add(a.re, b.re), hn::Add(a.im, b.im)}; }

/// v -> v + less_one v + shift. Where the shift is not a number, the plain function decides.
struct Map {
    Complex less_one, shift;
};

/// A shift that is a number only where a >= b.
HWY_INLINE Complex Where(Vector a, Vector b, Complex shift) {
    return {hn::IfThenElse(hn::Ge(a, b), shift.re, hn::NaN(Tag())), shift.im};
}

HWY_INLINE Vector Weights(const float* at) { return hn::PromoteTo(Tag(), hn::Load(Floats(), at)); }

/// sum w_i row_i over sum w_i, of a vector of vertices.
template <std::size_t K>
struct Mean {
    Vector at[K];

    HWY_INLINE Mean(const WeightTiles& tiles, const Rows<K>& rows, std::size_t v) {
        Vector total = hn::Zero(Tag());
        for (Vector& sum : at) sum = hn::Zero(Tag());
        const float* w = column(tiles, v);
        for (const auto& row : rows) {
            hwy::Prefetch(w + floats_ahead);
            const Vector weight = Weights(w);
            total = hn::Add(total, weight);
            for (std::size_t k = 0; k < K; ++k) at[k] = hn::MulAdd(weight, Number(row[k]), at[k]);
            w += tile_width;
        }
        for (Vector& sum : at) sum = hn::Div(sum, total);
    }
    HWY_INLINE Complex ComplexAt(std::size_t k) const { return {at[k], at[k + 1]}; }
};

/// e^{i angle/2}; of angles beyond what the sine is good for, not a number.
HWY_INLINE Complex HalfTurn(Vector angle) {
    const Vector half = hn::Mul(angle, Number(0.5));
    const auto good = hn::Le(hn::Abs(half), Number(39000));
    const Vector sine = hn::Sin(Tag(), half), cosine = hn::Cos(Tag(), half), none = hn::NaN(Tag());
    return {hn::IfThenElse(good, cosine, none), hn::IfThenElse(good, sine, none)};
}

/// e^{i angle} - 1, from e^{i angle/2}.
HWY_INLINE Complex TurnLessOne(Complex half) {
    return Complex{hn::Zero(Tag()), hn::Add(half.im, half.im)} * half;
}

/// As left_jacobian in motion.h.
HWY_INLINE Complex LeftJacobian(Vector angle, Complex half) {
    const Vector x = hn::Mul(angle, Number(0.5));
    const Vector sinc = hn::IfThenElse(hn::Eq(x, hn::Zero(Tag())), Number(1), hn::Div(half.im, x));
    return sinc * half;
}

struct Linear {
    static constexpr PlainBlend plain = &planar_linear;
    Rows<4> rows;

    explicit Linear(const Pose& pose) {
        for (const auto& m : pose.motions)
            rows.push_back({m.less_one.real(), m.less_one.imag(), m.shift.real(), m.shift.imag()});
    }
    HWY_INLINE Map operator()(const WeightTiles& tiles, const Pose&, std::size_t v) const {
        const Mean mean(tiles, rows, v);
        return {mean.ComplexAt(0), mean.ComplexAt(2)};
    }
};

struct Spiral {
    static constexpr PlainBlend plain = &spiral;
    Rows<5> rows;

    explicit Spiral(const Pose& pose) {
        for (const auto& m : pose.motions) {
            const auto way = m.now - m.rest;
            rows.push_back({m.angle, m.rest.real(), m.rest.imag(), way.real(), way.imag()});
        }
    }
    HWY_INLINE Map operator()(const WeightTiles& tiles, const Pose&, std::size_t v) const {
        const Mean mean(tiles, rows, v);
        const Complex less_one = TurnLessOne(HalfTurn(mean.at[0]));
        return {less_one, mean.ComplexAt(3) - less_one * mean.ComplexAt(1)};
    }
};

struct LogLinear {
    static constexpr PlainBlend plain = &planar_log_linear;
    Rows<4> rows;

    explicit LogLinear(const Pose& pose) {
        for (const auto& m : pose.motions) {
            const bool none = has_no_log(m);
            const auto l = none ? 0.0 : log_shift(m);
            rows.push_back({m.angle, l.real(), l.imag(), none ? 1.0 : 0.0});
        }
    }
    HWY_INLINE Map operator()(const WeightTiles& tiles, const Pose&, std::size_t v) const {
        const Mean mean(tiles, rows, v);
        const Complex half = HalfTurn(mean.at[0]);
        const Complex shift = LeftJacobian(mean.at[0], half) * mean.ComplexAt(1);
        return {TurnLessOne(half), Where(hn::Zero(Tag()), mean.at[3], shift)};
    }
};

struct Dib {
    static constexpr PlainBlend plain = &planar_dib;
    Rows<1> rows;

    explicit Dib(const Pose& pose) {
        for (const auto& m : pose.motions) rows.push_back({m.angle});
    }
    HWY_INLINE Map operator()(const WeightTiles& tiles, const Pose& pose, std::size_t v) const {
        const Vector angle = Mean(tiles, rows, v).at[0], zero = hn::Zero(Tag());
        const Complex turned = HalfTurn(angle), back = conj(turned);
        Complex sum{zero, zero}, shift{zero, zero};
        Vector size = zero;
        const float* w = column(tiles, v);
        for (const auto& m : pose.motions) {
            const Vector weight = Weights(w), half = hn::Mul(hn::Sub(Number(m.angle), angle), Number(0.5));
            const Complex turn = Number(m.p.p0) * back;
            const auto small = hn::Lt(hn::Abs(half), Number(1e-2));
            const Vector square = hn::Mul(half, half);
            const Vector thirds = hn::MulAdd(square, Number(1.0 / 45), Number(1.0 / 3));
            const Vector series = hn::NegMulAdd(thirds, square, Number(1));
            const Vector quotient = hn::Div(hn::Mul(half, turn.re), turn.im);
            const auto pole = hn::Lt(hn::Abs(turn.im), Number(unsure_share));
            const Vector beyond = hn::IfThenElse(pole, hn::NaN(Tag()), quotient);
            const Vector cotangent = hn::IfThenElse(small, series, beyond);
            const auto weighs = hn::Gt(weight, zero);
            const Complex a = weight * Complex{hn::IfThenElseZero(weighs, cotangent), hn::Neg(half)};
            sum = sum + a;
            shift = shift + a * Number(m.shift);
            size = hn::Add(size, hn::Add(hn::Abs(a.re), hn::Abs(a.im)));
            w += tile_width;
        }
        const Complex mean = (shift * conj(sum)) / norm(sum);
        return {TurnLessOne(turned), Where(abs(sum), hn::Mul(Number(unsure_share), size), mean)};
    }
};

/// A root of a number of length 1.
HWY_INLINE Complex Root(Complex z) {
    const auto right = hn::Ge(z.re, hn::Zero(Tag()));
    const Vector longer = hn::Sqrt(hn::MulAdd(hn::Abs(z.re), Number(0.5), Number(0.5)));
    const Vector shorter = hn::Div(z.im, hn::Add(longer, longer));
    return {hn::IfThenElse(right, longer, shorter), hn::IfThenElse(right, shorter, longer)};
}

struct Shortest {
    static constexpr PlainBlend plain = &planar_dlb_shortest;
    Rows<2> rows;

    explicit Shortest(const Pose& pose) {
        for (const auto& m : pose.motions) {
            const auto turn = m.p.p0 * m.p.p0;
            rows.push_back({turn.real(), turn.imag()});
        }
    }
    HWY_INLINE Map operator()(const WeightTiles& tiles, const Pose& pose, std::size_t v) const {
        const Complex turn = Mean(tiles, rows, v).ComplexAt(0);
        const Vector known = abs(turn), zero = hn::Zero(Tag());
        const Complex back = conj(Root(turn / known));
        Complex s0{zero, zero}, s1{zero, zero};
        Vector total = zero;
        const float* w = column(tiles, v);
        for (const auto& m : pose.motions) {  // the sign as sign_towards has it
            const Complex from = Number(m.p.p0) * back;
            const auto across = hn::Lt(hn::Abs(from.re), Number(cancelled_share<double>));
            const Vector weight = hn::CopySign(Weights(w), hn::IfThenElse(across, from.im, from.re));
            s0 = s0 + weight * Number(m.p.p0);
            s1 = s1 + weight * Number(m.p.p1);
            total = hn::Add(total, hn::Abs(weight));
            w += tile_width;
        }
        const Vector least = hn::Mul(Number(unsure_share), total), size = norm(s0);
        const Vector scale = hn::Div(Number(2), size);
        const Complex less_one = scale * (s0 * Complex{zero, s0.im}), shift = scale * (s0 * s1);
        return {less_one, Where(known, Number(unsure_share), Where(hn::Sqrt(size), least, shift))};
    }
};

/// Moving least squares, about the weighted centres p* and q* = p* + way.
template <bool rigid>
struct LeastSquaresMap {
    static constexpr PlainBlend plain = rigid ? &mls_rigid<double, double> : &mls_similarity<double, double>;
    Rows<4> rows;

    explicit LeastSquaresMap(const Pose& pose) {
        for (const auto& m : pose.motions) {
            const auto way = m.now - m.rest;
            rows.push_back({m.rest.real(), m.rest.imag(), way.real(), way.imag()});
        }
    }
    HWY_INLINE Map operator()(const WeightTiles& tiles, const Pose&, std::size_t v) const {
        const Mean mean(tiles, rows, v);
        const Complex centre = mean.ComplexAt(0), way = mean.ComplexAt(2);
        const Vector zero = hn::Zero(Tag());
        Vector spread = zero, spread_now = zero, total = zero;
        Complex way_spread{zero, zero};
        const float* w = column(tiles, v);
        for (const auto& row : rows) {
            const Vector weight = Weights(w);
            const Complex from = Complex{Number(row[0]), Number(row[1])} - centre;
            const Complex more = Complex{Number(row[2]), Number(row[3])} - way;
            spread = hn::MulAdd(weight, norm(from), spread);
            if (rigid) spread_now = hn::MulAdd(weight, norm(from + more), spread_now);
            way_spread = way_spread + weight * (more * conj(from));
            total = hn::Add(total, weight);
            w += tile_width;
        }
        // Below, the centres' rounding would tell.
        const Vector here = hn::Mul(total, hn::Mul(Number(1e-16), hn::Add(norm(centre), norm(way))));
        if (!rigid) {
            const Complex less_one = way_spread / spread;
            return {less_one, Where(spread, here, way - less_one * centre)};
        }
        const Complex scaled = Complex{spread, zero} + way_spread;
        const Vector scale = abs(scaled);
        const Complex less_one = (scaled - Complex{scale, zero}) / scale;
        const Vector least = hn::Mul(Number(unsure_share), hn::Sqrt(hn::Mul(spread, spread_now)));
        const Complex shift = Where(scale, least, way - less_one * centre);
        return {less_one, Where(hn::Min(spread, spread_now), here, shift)};
    }
};

/// Moves a vector of vertices.
template <class Blend>
struct MoveOne {
    const WeightTiles& tiles;
    const Pose& pose;
    const Blend& blend;
    std::span<double> room;  ///< #probes

    HWY_INLINE std::size_t operator()(std::size_t v, const glm::vec2* rest, glm::vec2* now) const {
        const Floats floats;
        const Map map = blend(tiles, pose, v);
        auto x = hn::Undefined(floats), y = x;
        hn::LoadInterleaved2(floats, &rest->x, x, y);
        const auto from_x = hn::Sub(x, hn::Set(floats, pose.centre.x));
        const auto from_y = hn::Sub(y, hn::Set(floats, pose.centre.y));
        const Complex from{hn::PromoteTo(Tag(), from_x), hn::PromoteTo(Tag(), from_y)};
        const Complex way = map.less_one * from + map.shift;
        const auto known = hn::Lt(hn::Add(hn::Abs(way.re), hn::Abs(way.im)), Number(farthest));
        if (HWY_UNLIKELY(!hn::AllTrue(Tag(), known)))
            return move_plainly(tiles, pose, Blend::plain, {v, hn::Lanes(Tag())}, rest, now, room);
        hn::StoreInterleaved2(hn::Add(x, hn::DemoteTo(floats, way.re)),
                              hn::Add(y, hn::DemoteTo(floats, way.im)), floats, &now->x);
        return 0;
    }
};

template <class Blend>
std::size_t Run(const WeightTiles& tiles, const Pose& pose, VertexRun run, const glm::vec2* rest,
                glm::vec2* now) {
    const Blend blend(pose);
    std::vector<double> room(tiles.probes);
    return MoveRun(run, hn::Lanes(Tag()), rest, now, MoveOne<Blend>{tiles, pose, blend, room});
}

#define PROBEWARP_RUN(name, Blend)                                                                     \
    std::size_t name(const WeightTiles& tiles, const Pose& pose, VertexRun run, const glm::vec2* rest, \
                     glm::vec2* now) {                                                                 \
        return Run<Blend>(tiles, pose, run, rest, now);                                                \
    }
PROBEWARP_RUN(RunShortest, Shortest)
PROBEWARP_RUN(RunDib, Dib)
PROBEWARP_RUN(RunLogLinear, LogLinear)
PROBEWARP_RUN(RunSpiral, Spiral)
PROBEWARP_RUN(RunLinear, Linear)
PROBEWARP_RUN(RunRigid, LeastSquaresMap<true>)
PROBEWARP_RUN(RunSimilarity, LeastSquaresMap<false>)
#undef PROBEWARP_RUN

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace probewarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace probewarp {

#define PROBEWARP_DEFORM(name, Run, passes)                                                                 \
    HWY_EXPORT(Run);                                                                                        \
    std::size_t name(const WeightTiles& tiles, std::span<const glm::vec2> rest, const Pose& pose,           \
                     VertexRun run, std::span<glm::vec2> now) {                                             \
        assert(rest.size() == tiles.vertices && now.size() == tiles.vertices && now.data() != rest.data()); \
        assert(pose.motions.size() == tiles.probes);                                                        \
        return over_blocks(run, tiles.vertices, tiles.probes * (passes), [&](VertexRun part) {              \
            return HWY_DYNAMIC_DISPATCH(Run)(tiles, pose, part, rest.data(), now.data());                   \
        });                                                                                                 \
    }
PROBEWARP_DEFORM(deform_dlb_shortest, RunShortest, 8)
PROBEWARP_DEFORM(deform_dib, RunDib, 16)
PROBEWARP_DEFORM(deform_log_linear, RunLogLinear, 4)
PROBEWARP_DEFORM(deform_spiral, RunSpiral, 4)
PROBEWARP_DEFORM(deform_linear, RunLinear, 4)
PROBEWARP_DEFORM(deform_mls_rigid, RunRigid, 8)
PROBEWARP_DEFORM(deform_mls_similarity, RunSimilarity, 8)
#undef PROBEWARP_DEFORM

}  // namespace probewarp
#endif
