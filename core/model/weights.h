// How much each vertex follows each probe, worked out from where they are. One function a scheme, and one row
// in the table.
#pragma once

#include <atomic>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/mesh.h"
#include "model/probe.h"

namespace probewarp {

/// Vertices times probes that a weight table may have: 256 MiB of floats.
inline constexpr std::size_t max_weights = std::size_t{1} << 26;

inline constexpr double default_exponent = 2, min_exponent = 0.5, max_exponent = 8;
inline constexpr double max_falloff = 1000;
inline constexpr int max_most = 10000;

/// What a document says about its weights.
struct WeightSettings {
    std::string scheme{"inverse-distance"};
    double exponent = default_exponent;  ///< of the schemes by distance, in [min_exponent, max_exponent]
    double falloff = 0;  ///< reaches beyond which a probe has no weight, in (0, max_falloff]; 0: none
    int most = 0;        ///< probes a vertex may follow, the heaviest; 0: all
    friend bool operator==(const WeightSettings&, const WeightSettings&) = default;
};

/// What a scheme keeps from one time to the next: factors, distances. Private to the schemes.
struct WeightCache;

/// What a scheme works from.
struct WeightInput {
    const Mesh& mesh;        ///< with the probes' anchors
    const Islands& islands;  ///< of the mesh
    std::span<const Probe> probes;
    double exponent = default_exponent;
    std::shared_ptr<WeightCache>& cache;  ///< may be null; a scheme leaves there what it can use again
    const std::atomic<bool>* given_up = nullptr;  ///< becomes true where nobody wants the result any more
};

struct WeightScheme {
    std::string_view name;   ///< what the command line and the project file call it
    std::string_view label;  ///< what the window calls it
    std::string_view when;   ///< one sentence: when to use it
    bool has_exponent;       ///< whether the exponent means anything
    bool in_shape;  ///< measured within the picture's shape: an island without a probe follows the nearest
    /// The table: #vertices x #probes, row-major, finite, >= 0, the largest of each row 1. Requires at least
    /// one probe. Throws GivenUp where it was, Error where it is more than fits.
    std::vector<float> (*table)(const WeightInput& input);
};

struct GivenUp {};

/// Throws GivenUp where nobody wants the result any more.
void check_given_up(const WeightInput& input);

/// The schemes, the default first.
std::span<const WeightScheme> weight_schemes();

/// The scheme of that name, or null.
const WeightScheme* find_weight_scheme(std::string_view name);

/// (radius_i / |vertex - rest_i|)^exponent, scaled so that the largest is 1; where probes sit on the vertex,
/// 1 for them and 0 for the others (as in the original system, whose exponent is 2). weights: #probes
void inverse_distance_weights(std::span<const Probe> probes, double exponent, glm::dvec2 vertex,
                              std::span<float> weights);

/// 1 / (exp(d^2 / radius^2) - 1), scaled so that the largest is 1: a Gaussian of the radius from afar, and
/// without bound at the probe itself, which is what makes it interpolate. weights: #probes
void gaussian_weights(std::span<const Probe> probes, glm::dvec2 vertex, std::span<float> weights);

// Within the shape; in geodesic.cpp, harmonic.cpp and biharmonic.cpp, as WeightScheme::table says.
std::vector<float> geodesic_table(const WeightInput& input);
std::vector<float> harmonic_table(const WeightInput& input);
std::vector<float> biharmonic_table(const WeightInput& input);

/// The probe that each island without one follows: #islands; no_vertex where the island has a probe of its
/// own. The nearest by the distance from its rest to the island's nearest vertex; the first of equals.
std::vector<std::uint32_t> followed_probes(const WeightInput& input);

/// Lets each probe's weights fade smoothly to nothing at `falloff` times its radius from its rest: times
/// (1 - (d / (falloff radius))^2)^2. Each row's largest is 1 again; a row beyond every probe stays as it is.
/// weights: #vertices x #probes, row-major, in and out
void fade_weights(double falloff, std::span<const Probe> probes, std::span<const glm::vec2> vertices,
                  std::span<float> weights);

/// Keeps the `most` heaviest weights of each row, the first of equals, and makes the others 0.
/// weights: #vertices x #probes, row-major, in and out
void keep_heaviest(std::size_t most, std::size_t probes, std::span<float> weights);

}  // namespace probewarp
