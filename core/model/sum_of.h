// What a row of weights sums to: weights are defined up to a factor, and shares are weights over their sum.
#pragma once

#include <numeric>
#include <span>

namespace probewarp {

/// weights: of any length; added up in double
inline double sum_of(std::span<const float> weights) {
    return std::accumulate(weights.begin(), weights.end(), 0.0);
}

}  // namespace probewarp
