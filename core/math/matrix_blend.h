// The blends by matrices that the papers compare theirs with (Kavan section 2 and Table 1): linear, by
// decomposition, and in the matrices' logarithm.
#pragma once

#include <cassert>
#include <span>

#include "math/blend.h"
#include "math/matrix.h"

namespace probewarp {

/// sum w_i M_i: linear blending. Rigid only where all turn alike.
/// weights, p: #transformations each, at least one; weights sum to 1.
template <RigidTransformation P>
auto linear_matrix_blend(std::span<const typename P::Scalar> weights, std::span<const P> p) {
    assert(!p.empty() && weights.size() == p.size());
    auto sum = to_matrix(p[0]) * weights[0];
    for (std::size_t i = 1; i < p.size(); ++i) sum += to_matrix(p[i]) * weights[i];
    return sum;
}

/// exp(sum w_i log M_i) with the matrices' principal logarithms (Alexa 2002): of p and -p, the one whose
/// angle is within half a turn. Shapes as linear_matrix_blend's.
template <RigidTransformation P>
auto log_matrix_blend(std::span<const typename P::Scalar> weights, std::span<const P> p) {
    assert(!p.empty() && weights.size() == p.size());
    const auto principal = [](const P& q) {
        return rotation_dot(q, P{}) < typename P::Scalar(0) ? log(-q) : log(q);
    };
    auto sum = weights[0] * principal(p[0]);
    for (std::size_t i = 1; i < p.size(); ++i) sum = sum + weights[i] * principal(p[i]);
    return to_matrix(exp(sum));
}

/// The rotations by DLB's normalised sum, shortest way, and the shifts linearly, each for itself. Shapes as
/// linear_matrix_blend's.
template <RigidTransformation P>
auto decomposition_blend(std::span<const typename P::Scalar> weights, std::span<const P> p) {
    auto blend = to_matrix(dlb_shortest(weights, p).p);
    constexpr int last = decltype(blend)::length() - 1;
    blend[last] = to_matrix(p[0])[last] * weights[0];
    for (std::size_t i = 1; i < p.size(); ++i) blend[last] += to_matrix(p[i])[last] * weights[i];
    return blend;
}

}  // namespace probewarp
