// Blends of the plane's motions that know how far each was turned: one function a method. Each gives the map
// v -> a v + b of one vertex from its weights. Where no probe moved it is the identity, bit for bit; a probe
// with all the weight gives its own motion (moving least squares: only its shift).
//
// In every function: weights, motions: #probes each, at least one; weights >= 0, not all zero, need not sum
// to
// 1. Where a method has no answer, its result is the heaviest motion, marked as cancelled.
#pragma once

#include <cassert>
#include <cmath>
#include <complex>
#include <cstddef>
#include <span>

#include "math/blend.h"
#include "math/motion.h"

namespace probewarp {

/// What of the heaviest motion is taken where a blend has no answer.
template <class W, class T>
Similarity<T> follow_heaviest(std::span<const W> weights, std::span<const Motion<T>> motions) {
    Similarity<T> result = similarity(motions[heaviest(weights)]);
    result.cancelled = true;
    return result;
}

/// sum w_i f(motion_i) / sum w_i.
template <class W, class T, class F>
auto mean(std::span<const W> weights, std::span<const Motion<T>> motions, F f) {
    assert(!motions.empty() && weights.size() == motions.size());
    auto sum = T(weights[0]) * f(motions[0]);
    T total = T(weights[0]);
    for (std::size_t i = 1; i < motions.size(); ++i) {
        sum += T(weights[i]) * f(motions[i]);
        total += T(weights[i]);
    }
    return sum / total;
}

/// s0^2 v + 2 s0 s1 over |s0|^2: DLB of the sum s, without a square root (MKO section 5).
template <class T>
Similarity<T> normalised_action(const DualComplex<T>& s) {
    const T scale = T(2) / std::norm(s.p0);
    return {scale * (s.p0 * std::complex<T>(T(0), s.p0.imag())), scale * (s.p0 * s.p1), false, s.p0};
}

/// DLB, as turned.
template <class W, class T>
Similarity<T> planar_dlb(std::span<const W> weights, std::span<const Motion<T>> motions) {
    const auto s0 = mean(weights, motions, [](const auto& m) { return m.p.p0; });
    if (!(std::abs(s0) >= cancelled_share<T>)) return follow_heaviest(weights, motions);
    return normalised_action<T>({s0, mean(weights, motions, [](const auto& m) { return m.p.p1; })});
}

/// DLB, shortest way: dlb_shortest of blend.h.
template <class W, class T>
Similarity<T> planar_dlb_shortest(std::span<const W> weights, std::span<const Motion<T>> motions) {
    const auto turn = mean(weights, motions, [](const auto& m) { return m.p.p0 * m.p.p0; });
    const T known = std::abs(turn);
    const DualComplex<T> centre =
        known >= cancelled_share<T>
            ? DualComplex<T>{std::sqrt(turn / known), std::complex<T>(0)}
            : motions[pivot_of_equals(weights, [&](std::size_t i) { return motions[i].p; })].p;
    const auto sign = [&](const auto& m) { return sign_towards(centre, m.p); };
    const auto s0 = mean(weights, motions, [&](const auto& m) { return sign(m) * m.p.p0; });
    if (!(std::abs(s0) >= cancelled_share<T>)) return follow_heaviest(weights, motions);
    return normalised_action<T>(
        {s0, mean(weights, motions, [&](const auto& m) { return sign(m) * m.p.p1; })});
}

/// DIB in closed form: the x with sum w_i log(p_i x^-1) = 0 (Kavan section 5) turns by m = sum w_i t_i, since
/// the plane's angles are scalars, and then shifts by d = sum a_i d_i / sum a_i with a_i = w_i / V(t_i - m).
/// 1 / V(x) = (x/2) cot(x/2) - i x/2 has poles at whole turns: no answer where a probe with weight is that
/// far from the mean, nor where the a_i cancel.
template <class W, class T>
Similarity<T> planar_dib(std::span<const W> weights, std::span<const Motion<T>> motions) {
    const T m = mean(weights, motions, [](const auto& x) { return x.angle; });
    const std::complex<T> back = std::polar(T(1), -m / T(2));
    std::complex<T> sum{}, shift{};
    T size{};
    for (std::size_t i = 0; i < motions.size(); ++i) {
        if (weights[i] == W(0)) continue;
        const T half = (motions[i].angle - m) / T(2);
        const std::complex<T> turn = motions[i].p.p0 * back;  // e^{i half}, without working it out
        // Below, the series' next term is 2 half^6 / 945; above, turn's rounding counts as epsilon / half.
        const bool small = std::abs(half) < T(1e-2);
        if (!small && std::abs(turn.imag()) < cancelled_share<T>) return follow_heaviest(weights, motions);
        const T square = half * half;
        const T cotangent =
            small ? T(1) - square / T(3) - square * square / T(45) : half * turn.real() / turn.imag();
        const std::complex<T> a = T(weights[i]) * std::complex<T>(cotangent, -half);
        sum += a;
        shift += a * motions[i].shift;
        size += std::abs(a);
    }
    if (!(std::abs(sum) >= cancelled_share<T> * size)) return follow_heaviest(weights, motions);
    return {turn_less_one(m), shift / sum, false, std::conj(back)};
}

/// The shift in the logarithm of a motion: l with V(angle) l its shift, and so V^-1 of its way less i angle
/// times its rest. No pole at whole turns in place.
template <class T>
std::complex<T> log_shift(const Motion<T>& m) {
    const std::complex<T> way = m.now - m.rest;
    const std::complex<T> turned = std::complex<T>(T(0), -m.angle) * m.rest;
    return way == std::complex<T>(0) ? turned : way / left_jacobian(m.angle) + turned;
}

/// Whether the motion made whole turns and went elsewhere: then it has no logarithm.
template <class T>
bool has_no_log(const Motion<T>& m) {
    return m.now != m.rest && !(std::abs(left_jacobian(m.angle)) >= cancelled_share<T>);
}

/// Blending in the logarithm at the origin: exp(sum w_i log p_i) (regression paper, equation 7), with the
/// unwrapped angles in the logarithms. No answer where a probe with weight has no logarithm.
template <class W, class T>
Similarity<T> planar_log_linear(std::span<const W> weights, std::span<const Motion<T>> motions) {
    for (std::size_t i = 0; i < motions.size(); ++i)
        if (weights[i] != W(0) && has_no_log(motions[i])) return follow_heaviest(weights, motions);
    const T m = mean(weights, motions, [](const auto& x) { return x.angle; });
    // A motion without a logarithm has no weight here: whatever is added for it must be finite.
    const auto l =
        mean(weights, motions, [](const auto& x) { return has_no_log(x) ? x.shift : log_shift(x); });
    return {turn_less_one(m), left_jacobian(m) * l, false, std::polar(T(1), m / T(2))};
}

/// Spiral: with m = sum w_i t_i, v' = sum w_i (R(m)(v - rest_i) + now_i). Any number of turns, and no pole.
template <class W, class T>
Similarity<T> spiral(std::span<const W> weights, std::span<const Motion<T>> motions) {
    const T m = mean(weights, motions, [](const auto& x) { return x.angle; });
    const auto less_one = turn_less_one(m);
    const auto rest = mean(weights, motions, [](const auto& x) { return x.rest; });
    const auto way = mean(weights, motions, [](const auto& x) { return x.now - x.rest; });
    return {less_one, way - less_one * rest, false, std::polar(T(1), m / T(2))};
}

/// Linear blending: sum w_i (R(t_i)(v - rest_i) + now_i), the baseline of both papers (MKO section 1). It
/// shrinks what turns apart.
template <class W, class T>
Similarity<T> planar_linear(std::span<const W> weights, std::span<const Motion<T>> motions) {
    return {mean(weights, motions, [](const auto& x) { return x.less_one; }),
            mean(weights, motions, [](const auto& x) { return x.shift; })};
}

/// What moving least squares sums up (Schaefer, McPhail, Warren 2006, section 2), about the weighted centres
/// p* of the rests and q* of where they are now.
template <class T>
struct LeastSquares {
    std::complex<T> rest;        ///< p*
    std::complex<T> way;         ///< q* - p*
    T spread{};                  ///< mean |rest_i - p*|^2
    T spread_now{};              ///< mean |now_i - q*|^2
    std::complex<T> way_spread;  ///< mean (way_i - way) conj(rest_i - p*): 0 where nothing moves
};

template <class W, class T>
LeastSquares<T> least_squares(std::span<const W> weights, std::span<const Motion<T>> motions) {
    // Seen from the heaviest: where points coincide, or where it has all the weight, the spreads are exactly
    // 0 and not the rounding of a mean.
    const Motion<T>& m = motions[heaviest(weights)];
    const auto rest = [&](const auto& x) { return x.rest - m.rest; };
    const auto now = [&](const auto& x) { return x.now - m.now; };
    const auto way = [&](const auto& x) { return (x.now - x.rest) - (m.now - m.rest); };
    const std::complex<T> p = mean(weights, motions, rest), q = mean(weights, motions, now),
                          q_less_p = mean(weights, motions, way);
    LeastSquares<T> s;
    s.rest = m.rest + p;
    s.way = (m.now - m.rest) + q_less_p;
    s.spread = mean(weights, motions, [&](const auto& x) { return std::norm(rest(x) - p); });
    s.spread_now = mean(weights, motions, [&](const auto& x) { return std::norm(now(x) - q); });
    s.way_spread =
        mean(weights, motions, [&](const auto& x) { return (way(x) - q_less_p) * std::conj(rest(x) - p); });
    return s;
}

/// a (v - p*) + q*, with a - 1 given.
template <class T>
Similarity<T> about_centres(const LeastSquares<T>& s, std::complex<T> less_one) {
    return {less_one, s.way - less_one * s.rest};
}

/// Moving least squares with similarities (Schaefer et al., equation 6): the similarity that takes the rests
/// nearest to where they are now. A single point tells it no rotation: it translates; the probes' own turns
/// are not looked at.
template <class W, class T>
Similarity<T> mls_similarity(std::span<const W> weights, std::span<const Motion<T>> motions) {
    const LeastSquares<T> s = least_squares(weights, motions);
    if (!(s.spread > T(0))) return about_centres(s, std::complex<T>(0));
    return about_centres(s, s.way_spread / s.spread);
}

/// Moving least squares with rigid motions (Schaefer et al., equation 8): the same without its scale. Where
/// all points with weight coincide, at rest or now, it translates; no answer where they lie otherwise so that
/// no rotation is better than another.
template <class W, class T>
Similarity<T> mls_rigid(std::span<const W> weights, std::span<const Motion<T>> motions) {
    const LeastSquares<T> s = least_squares(weights, motions);
    if (!(s.spread > T(0) && s.spread_now > T(0))) return about_centres(s, std::complex<T>(0));
    const std::complex<T> scaled = s.spread + s.way_spread;
    const T scale = std::abs(scaled);
    if (!(scale >= cancelled_share<T> * std::sqrt(s.spread) * std::sqrt(s.spread_now)))
        return follow_heaviest(weights, motions);
    return about_centres(s, (scaled - scale) / scale);
}

}  // namespace probewarp
