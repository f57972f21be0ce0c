#include "model/weights.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

namespace probewarp {

void inverse_distance_weights(std::span<const Probe> probes, glm::dvec2 vertex, std::span<float> weights) {
    assert(weights.size() == probes.size());
    // distance^2 / radius^2; the radius divides before squaring, or tiny radii would give 0 / 0.
    const auto ratio = [vertex](const Probe& probe) {
        const glm::dvec2 d = (vertex - probe.rest) / probe.radius;
        return d.x * d.x + d.y * d.y;
    };
    // The probe that weighs most has the smallest ratio; dividing by it keeps every weight in [0, 1] however
    // near the probe is.
    double least = std::numeric_limits<double>::infinity();
    for (const Probe& probe : probes) least = std::min(least, ratio(probe));
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const double own = ratio(probes[i]);
        weights[i] = own == least ? 1.0f : float(least / own);
    }
}

std::span<const WeightScheme> weight_schemes() {
    static constexpr std::array<WeightScheme, 1> schemes{
        {{"inverse-distance", "Inverse distance", &inverse_distance_weights}}};
    return schemes;
}

const WeightScheme* find_weight_scheme(std::string_view name) {
    const auto schemes = weight_schemes();
    const auto found =
        std::find_if(schemes.begin(), schemes.end(), [&](const auto& s) { return s.name == name; });
    return found == schemes.end() ? nullptr : &*found;
}

std::vector<float> weight_table(const WeightScheme& scheme, std::span<const Probe> probes,
                                std::span<const glm::vec2> vertices) {
    std::vector<float> table(vertices.size() * probes.size());
    if (probes.empty()) return table;
    for (std::size_t v = 0; v < vertices.size(); ++v)
        scheme.at(probes, vertices[v], std::span(table).subspan(v * probes.size(), probes.size()));
    return table;
}

}  // namespace probewarp
