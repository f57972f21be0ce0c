// Blending of rigid transformations in the plane and in space: one function a method, spans in.
// Kavan et al., "Dual Quaternions for Rigid Transformation Blending" (TCD-CS-2006-46), here "Kavan", and MKO
// section 5 (arXiv 1601.01754). What only the plane can do is in planar_blend.h.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <cstddef>
#include <span>
#include <tuple>

#include "math/dual_complex.h"
#include "math/dual_quaternion.h"
#include "math/transformation.h"

namespace probewarp {

/// Where |s0| is below this share of sum |w_i|, the weights cancel and the blend has no direction.
template <class T>
inline constexpr T cancelled_share = T(1e-6);

/// The place of the largest |w_i|, the first of equals. Requires at least one weight.
template <class T>
std::size_t heaviest(std::span<const T> weights) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < weights.size(); ++i)
        if (std::abs(weights[i]) > std::abs(weights[best])) best = i;
    return best;
}

template <class P>
struct Blend {
    P p;                     ///< a unit
    bool cancelled = false;  ///< the weights cancelled: p is the heaviest transformation
};

/// (sum w_i e_i) / |sum w_i e_i| with e_i = element(i), which is p_i or -p_i.
template <RigidTransformation P, class Element>
Blend<P> normalised_sum(std::span<const typename P::Scalar> weights, std::span<const P> p, Element element) {
    using T = typename P::Scalar;
    assert(!p.empty() && weights.size() == p.size());
    T total{};
    for (const T w : weights) total += std::abs(w);
    // Divided first: the square of a sum of small weights would be lost.
    P s = (weights[0] / total) * element(0);
    for (std::size_t i = 1; i < p.size(); ++i) s = s + (weights[i] / total) * element(i);
    if (!(rotation_dot(s, s) >= cancelled_share<T> * cancelled_share<T>)) return {p[heaviest(weights)], true};
    return {normalised(s), false};
}

/// DLB, as turned: (sum w_i p_i) / |sum w_i p_i| with the signs that the p_i have (Kavan section 4, MKO
/// section 5). Weights need not sum to 1.
/// weights, p: #transformations each, at least one, weights not all zero.
template <RigidTransformation P>
Blend<P> dlb(std::span<const typename P::Scalar> weights, std::span<const P> p) {
    return normalised_sum(weights, p, [&](std::size_t i) { return p[i]; });
}

/// The coordinates of p0, the real one first.
template <class T>
std::array<T, 2> turning_part(const DualComplex<T>& p) {
    return {p.p0.real(), p.p0.imag()};
}

template <class T>
std::array<T, 4> turning_part(const DualQuaternion<T>& q) {
    return {q.q0.w, q.q0.x, q.q0.y, q.q0.z};
}

/// The place of the heaviest of the p_i = p(i), #weights of them; of equals the one that turns least, then
/// the one that turns clockwise (in space: most about +x, then +y, then +z). Not the first, so that it
/// depends neither on their order nor on their signs.
template <class W, class Element>
std::size_t pivot_of_equals(std::span<const W> weights, Element p) {
    const auto rank = [&](std::size_t i) {
        // The greater of p and -p is the one whose first coordinate other than 0 is positive.
        return std::tuple(weights[i], std::max(turning_part(p(i)), turning_part(-p(i))));
    };
    std::size_t best = 0;
    for (std::size_t i = 1; i < weights.size(); ++i)
        if (rank(i) > rank(best)) best = i;
    return best;
}

/// A rotation in the middle of the p_i's, which depends neither on their signs nor on their order: the u that
/// maximises sum w_i <p0_i, u>^2, here sqrt(sum w_i p0_i^2). Where it is not determined, the heaviest's.
/// Shapes as dlb's; weights >= 0.
template <class T>
DualComplex<T> pivot(std::span<const T> weights, std::span<const DualComplex<T>> p) {
    std::complex<T> mean{};
    T total{};
    for (std::size_t i = 0; i < p.size(); ++i) {
        mean += weights[i] * (p[i].p0 * p[i].p0);
        total += weights[i];
    }
    if (!(std::abs(mean) >= cancelled_share<T> * total))
        return p[pivot_of_equals(weights, [&](std::size_t i) { return p[i]; })];
    return {std::sqrt(mean / std::abs(mean)), std::complex<T>(0)};
}

/// As in the plane: the first eigenvector of sum w_i q0_i q0_i^T, determined where its eigenvalue stands
/// alone. In double whatever T is, so that the order of the sum does not tell.
template <class T>
DualQuaternion<T> pivot(std::span<const T> weights, std::span<const DualQuaternion<T>> p) {
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Eigen::Vector4d v(p[i].q0.w, p[i].q0.x, p[i].q0.y, p[i].q0.z);
        sum += double(weights[i]) * v * v.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(sum);
    const Eigen::Vector4d& values = solver.eigenvalues();  // least first
    if (!(values[3] - values[2] >= cancelled_share<double> * sum.trace()))
        return p[pivot_of_equals(weights, [&](std::size_t i) { return p[i]; })];
    const Eigen::Vector4d first = solver.eigenvectors().col(3);
    return {{T(first[0]), T(first[1]), T(first[2]), T(first[3])}, {T(0), T(0), T(0), T(0)}};
}

/// -1 where -p is nearer to the pivot than p, else 1. Where both are as near, half a turn from it, the first
/// other coordinate of the turn from the pivot to p decides: in the plane that turn is clockwise.
template <RigidTransformation P>
typename P::Scalar sign_towards(const P& centre, const P& p) {
    using T = typename P::Scalar;
    for (const T c : turning_part(p * inverse(centre)))  // the first is rotation_dot(p, centre)
        if (std::abs(c) >= cancelled_share<T>) return c < T(0) ? T(-1) : T(1);
    return T(1);
}

/// DLB, shortest way: each p_i with the sign that is nearer to the pivot (Kavan section 4, who takes one of
/// the p_i for it). Up to its own sign the result depends neither on the signs of the p_i nor on their order.
/// Shapes as dlb's; weights >= 0.
template <RigidTransformation P>
Blend<P> dlb_shortest(std::span<const typename P::Scalar> weights, std::span<const P> p) {
    const P centre = pivot(weights, p);
    return normalised_sum(weights, p, [&](std::size_t i) { return sign_towards(centre, p[i]) * p[i]; });
}

template <RigidTransformation P>
struct Iteration {
    P p;                             ///< a unit: the blend, or as near as it came
    int steps = 0;                   ///< that were made
    bool converged = false;          ///< the last step was within the precision
    typename P::Scalar last_step{};  ///< its length, as the logarithm's coordinates measure it
};

/// The length of an element of the algebra: the root of the sum of its coordinates' squares.
template <class Log>
auto length(const Log& x) {
    using std::sqrt;
    typename decltype(coordinates(x))::value_type sum{};
    for (const auto c : coordinates(x)) sum += c * c;
    return sqrt(sum);
}

/// DIB by iteration (Kavan section 5, algorithm DIB): the x with sum w_i log(p_i x^-1) = 0, from DLB's x on
/// by x <- exp(sum w_i log(p_i x^-1)) x, until a step is within `precision` (radians of the half angle, and
/// half the units of length). Each p_i is taken with the sign that it has. Shapes as dlb's; weights are
/// divided by their sum, which must not be 0.
template <RigidTransformation P>
Iteration<P> dib(std::span<const typename P::Scalar> weights, std::span<const P> p,
                 typename P::Scalar precision, int most_steps = 50) {
    using T = typename P::Scalar;
    T total{};
    for (const T w : weights) total += w;
    Iteration<P> at{dlb(weights, p).p};
    while (at.steps < most_steps && !at.converged) {
        const P back = inverse(at.p);
        auto step = (weights[0] / total) * log(p[0] * back);
        for (std::size_t i = 1; i < p.size(); ++i) step = step + (weights[i] / total) * log(p[i] * back);
        at.p = normalised(exp(step) * at.p);
        at.last_step = length(step);
        at.converged = at.last_step <= precision;
        ++at.steps;
    }
    return at;
}

/// Blending in the logarithm at the identity: exp(sum w_i log p_i) (regression paper, equation 7). The
/// weights are taken as they are: what they lack of 1 is the identity's. Shapes as dlb's.
template <RigidTransformation P>
P log_linear(std::span<const typename P::Scalar> weights, std::span<const P> p) {
    assert(!p.empty() && weights.size() == p.size());
    auto sum = weights[0] * log(p[0]);
    for (std::size_t i = 1; i < p.size(); ++i) sum = sum + weights[i] * log(p[i]);
    return exp(sum);
}

}  // namespace probewarp
