// Blending of rigid transformations: one function a method, spans in.
// DLB is MKO section 5 (arXiv 1601.01754), after Kavan et al., "Dual Quaternions for Rigid Transformation
// Blending".
#pragma once

#include <cassert>
#include <cstddef>
#include <span>

#include "math/dual_complex.h"

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

template <class T>
struct Blend {
    DualComplex<T> p;        ///< a unit DCN
    bool cancelled = false;  ///< the weights cancelled: p is the heaviest probe's
};

/// DLB: (sum w_i p_i) / |sum w_i p_i|. Weights need not sum to 1.
/// weights, p: #probes each, at least one, weights not all zero.
template <class T>
Blend<T> dlb(std::span<const T> weights, std::span<const DualComplex<T>> p) {
    assert(!p.empty() && weights.size() == p.size());
    DualComplex<T> s{T(0), T(0)};
    T total{0};
    for (std::size_t i = 0; i < p.size(); ++i) {
        s = s + weights[i] * p[i];
        total += std::abs(weights[i]);
    }
    if (!(norm(s) >= cancelled_share<T> * total)) return {p[heaviest(weights)], true};
    return {normalised(s), false};
}

}  // namespace probewarp
