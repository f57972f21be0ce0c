// How much of each probe a place on the picture follows. One function a scheme, and one row in the table.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "model/probe.h"

namespace probewarp {

/// Vertices times probes that a weight table may have: 256 MiB of floats.
inline constexpr std::size_t max_weights = std::size_t{1} << 26;

/// Writes the weights of one vertex: #probes, finite, >= 0, the largest is 1 (weights count up to a factor).
using WeightFunction = void (*)(std::span<const Probe> probes, glm::dvec2 vertex, std::span<float> weights);

struct WeightScheme {
    std::string_view name;   ///< what the command line and the project file call it
    std::string_view label;  ///< what the window calls it
    WeightFunction at;
};

/// The schemes, the default first.
std::span<const WeightScheme> weight_schemes();

/// The scheme of that name, or null.
const WeightScheme* find_weight_scheme(std::string_view name);

/// radius_i^2 / |vertex - rest_i|^2, scaled so that the largest is 1; where probes sit on the vertex, 1 for
/// them and 0 for the others (as in the original system).
void inverse_distance_weights(std::span<const Probe> probes, glm::dvec2 vertex, std::span<float> weights);

/// The weights of all vertices: #vertices x #probes, row-major.
std::vector<float> weight_table(const WeightScheme& scheme, std::span<const Probe> probes,
                                std::span<const glm::vec2> vertices);

}  // namespace probewarp
