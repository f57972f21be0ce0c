// Blending of rigid transformations in the plane and in space: one function a method, spans in.
// Kavan et al., "Dual Quaternions for Rigid Transformation Blending" (TCD-CS-2006-46), here "Kavan", and MKO
// section 5 (arXiv 1601.01754). What only the plane can do is in planar_blend.h.
#pragma once

#include <Eigen/Eigenvalues>
#include <cassert>
#include <cmath>
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
    P s = weights[0] * element(0);
    T total = std::abs(weights[0]);
    for (std::size_t i = 1; i < p.size(); ++i) {
        s = s + weights[i] * element(i);
        total += std::abs(weights[i]);
    }
    const T least = cancelled_share<T> * total;
    if (!(rotation_dot(s, s) >= least * least)) return {p[heaviest(weights)], true};
    return {normalised(s), false};
}

/// DLB, as turned: (sum w_i p_i) / |sum w_i p_i| with the signs that the p_i have (Kavan section 4, MKO
/// section 5). Weights need not sum to 1.
/// weights, p: #transformations each, at least one, weights not all zero.
template <RigidTransformation P>
Blend<P> dlb(std::span<const typename P::Scalar> weights, std::span<const P> p) {
    return normalised_sum(weights, p, [&](std::size_t i) { return p[i]; });
}

/// The heaviest of the p_i; of equals the one that turns least, then the one that turns clockwise: not the
/// first, so that it does not depend on their order.
template <class T>
DualComplex<T> pivot_of_equals(std::span<const T> weights, std::span<const DualComplex<T>> p) {
    const auto rank = [&](std::size_t i) {
        const std::complex<T> turn = p[i].p0 * p[i].p0;
        return std::tuple(std::abs(weights[i]), turn.real(), turn.imag());
    };
    std::size_t best = 0;
    for (std::size_t i = 1; i < p.size(); ++i)
        if (rank(i) > rank(best)) best = i;
    return p[best];
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
    if (!(std::abs(mean) >= cancelled_share<T> * total)) return pivot_of_equals(weights, p);
    return {std::sqrt(mean / std::abs(mean)), std::complex<T>(0)};
}

/// As in the plane: the first eigenvector of sum w_i p0_i p0_i^T.
template <class T>
DualQuaternion<T> pivot(std::span<const T> weights, std::span<const DualQuaternion<T>> p) {
    using Vector = Eigen::Matrix<T, 4, 1>;
    Eigen::Matrix<T, 4, 4> sum = Eigen::Matrix<T, 4, 4>::Zero();
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vector v(p[i].q0.w, p[i].q0.x, p[i].q0.y, p[i].q0.z);
        sum += weights[i] * v * v.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<T, 4, 4>> solver(sum);
    const Vector first = solver.eigenvectors().col(3);  // of the largest eigenvalue
    return {{first[0], first[1], first[2], first[3]}, {T(0), T(0), T(0), T(0)}};
}

/// DLB, shortest way: each p_i with the sign that is nearer to the pivot (Kavan section 4, who takes one of
/// the p_i for it). Shapes as dlb's; weights >= 0.
template <RigidTransformation P>
Blend<P> dlb_shortest(std::span<const typename P::Scalar> weights, std::span<const P> p) {
    const P centre = pivot(weights, p);
    return normalised_sum(weights, p, [&](std::size_t i) {
        return rotation_dot(p[i], centre) < typename P::Scalar(0) ? -p[i] : p[i];
    });
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
    auto sum = decltype(coordinates(x)[0] * coordinates(x)[0])(0);
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
