#include "model/weights.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "model/over_blocks.h"

namespace probewarp {

namespace {

/// What the schemes by distance want of the probes, each number side by side, and room for one vertex.
struct Reaches {
    std::vector<double> x, y, per_radius;  ///< #probes: where they rest, and 1 / radius
    std::vector<double> own;               ///< #probes: of the vertex in hand, to be written

    explicit Reaches(std::span<const Probe> probes) : own(probes.size()) {
        for (const Probe& probe : probes) {
            x.push_back(probe.rest.x), y.push_back(probe.rest.y);
            per_radius.push_back(1 / probe.radius);
        }
    }
};

/// own = the squared distance to each probe, in radii
void measure(Reaches& reaches, glm::dvec2 vertex) {
    const double *x = reaches.x.data(), *y = reaches.y.data(), *per_radius = reaches.per_radius.data();
    double* own = reaches.own.data();
    for (std::size_t i = 0; i < reaches.own.size(); ++i) {
        // In radii before squaring, or tiny ones would give 0 / 0.
        const double dx = (vertex.x - x[i]) * per_radius[i], dy = (vertex.y - y[i]) * per_radius[i];
        own[i] = dx * dx + dy * dy;
    }
}

void weigh_by_inverse_distance(Reaches& reaches, double exponent, glm::dvec2 vertex,
                               std::span<float> weights) {
    assert(weights.size() == reaches.own.size());
    measure(reaches, vertex);
    // The probe that weighs most has the smallest distance^2 / radius^2; dividing by it keeps every weight in
    // [0, 1] however near the probe is.
    const double nearest = *std::min_element(reaches.own.begin(), reaches.own.end());
    const double* own = reaches.own.data();
    if (exponent == 2)
        for (std::size_t i = 0; i < weights.size(); ++i)
            weights[i] = own[i] == nearest ? 1.0f : float(nearest / own[i]);
    else
        for (std::size_t i = 0; i < weights.size(); ++i)
            weights[i] = own[i] == nearest ? 1.0f : float(std::pow(nearest / own[i], exponent / 2));
}

void weigh_by_gaussian(Reaches& reaches, glm::dvec2 vertex, std::span<float> weights) {
    assert(weights.size() == reaches.own.size());
    measure(reaches, vertex);
    // In logarithms, where far probes do not vanish all at once: log(1 / (e^x - 1)) = -x - log(1 - e^-x).
    for (double& x : reaches.own)
        x = x > 0 ? -x - std::log(-std::expm1(-x)) : std::numeric_limits<double>::infinity();
    const double most = *std::max_element(reaches.own.begin(), reaches.own.end());
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = reaches.own[i] == most ? 1.0f : float(std::exp(reaches.own[i] - most));
}

}  // namespace

void inverse_distance_weights(std::span<const Probe> probes, double exponent, glm::dvec2 vertex,
                              std::span<float> weights) {
    Reaches reaches(probes);
    weigh_by_inverse_distance(reaches, exponent, vertex, weights);
}

void gaussian_weights(std::span<const Probe> probes, glm::dvec2 vertex, std::span<float> weights) {
    Reaches reaches(probes);
    weigh_by_gaussian(reaches, vertex, weights);
}

void check_given_up(const WeightInput& input) {
    if (input.given_up && input.given_up->load(std::memory_order_relaxed)) throw GivenUp();
}

namespace {

/// Calls work(reaches, vertex) for each, shared between threads.
template <class Work>
void for_each_row(std::span<const Probe> probes, std::size_t vertices, Work work) {
    constexpr std::size_t as_many_as = 8;  // a weight is about as much work as that many of a deformation
    over_blocks({0, vertices}, vertices, probes.size() * as_many_as, [&](VertexRun part) {
        Reaches reaches(probes);
        for (std::size_t v = part.first; v < part.first + part.count; ++v) work(reaches, v);
        return std::size_t{0};
    });
}

/// A scheme that looks at one vertex at a time: at(reaches, vertex, row).
template <class At>
std::vector<float> table_by_vertex(const WeightInput& input, At at) {
    const std::size_t probes = input.probes.size(), vertices = input.mesh.rest.size();
    std::vector<float> table(vertices * probes);
    for_each_row(input.probes, vertices, [&](Reaches& reaches, std::size_t v) {
        if (v % 4096 == 0) check_given_up(input);
        at(reaches, input.mesh.rest[v], std::span(table).subspan(v * probes, probes));
    });
    // A probe's own vertex is its rest rounded to floats.
    for (std::size_t i = 0; i < probes; ++i) {
        if (input.mesh.anchors[i] == no_vertex) continue;
        float* row = table.data() + std::size_t(input.mesh.anchors[i]) * probes;
        for (std::size_t k = 0; k < probes; ++k)
            row[k] = input.mesh.anchors[k] == input.mesh.anchors[i] ? 1.0f : 0.0f;
    }
    return table;
}

std::vector<float> inverse_distance_table(const WeightInput& input) {
    return table_by_vertex(input, [&input](Reaches& reaches, glm::dvec2 vertex, std::span<float> row) {
        weigh_by_inverse_distance(reaches, input.exponent, vertex, row);
    });
}

std::vector<float> gaussian_table(const WeightInput& input) {
    return table_by_vertex(input, [](Reaches& reaches, glm::dvec2 vertex, std::span<float> row) {
        weigh_by_gaussian(reaches, vertex, row);
    });
}

}  // namespace

std::span<const WeightScheme> weight_schemes() {
    static constexpr std::array<WeightScheme, 5> schemes{
        {{"inverse-distance", "Inverse distance",
          "Soft everywhere: for faces, cloth and pictures without an outline.", true, false,
          &inverse_distance_table},
         {"gaussian", "Gaussian of the reach",
          "A probe rules within its reach and fades quickly beyond: for local retouching.", false, false,
          &gaussian_table},
         {"geodesic", "Geodesic, in the shape",
          "Like inverse distance, but measured along the shape: limbs stay apart.", true, true,
          &geodesic_table},
         {"harmonic", "Harmonic, in the shape",
          "Spreads evenly between the probes and stops at the outline: for figures with limbs.", false, true,
          &harmonic_table},
         {"biharmonic", "Biharmonic, in the shape",
          "The smoothest: bends without a kink at the probes; takes longer to work out.", false, true,
          &biharmonic_table}}};
    return schemes;
}

const WeightScheme* find_weight_scheme(std::string_view name) {
    const auto schemes = weight_schemes();
    const auto found =
        std::find_if(schemes.begin(), schemes.end(), [&](const auto& s) { return s.name == name; });
    return found == schemes.end() ? nullptr : &*found;
}

namespace {

/// One row of fade_weights.
void fade(double falloff, Reaches& reaches, glm::dvec2 vertex, std::span<float> row) {
    measure(reaches, vertex);
    float most = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const double x = std::max(0.0, 1 - reaches.own[i] / (falloff * falloff));
        reaches.own[i] = double(row[i]) * x * x;
        most = std::max(most, float(reaches.own[i]));
    }
    if (most == 0) return;  // beyond every probe: as without a limit
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = float(reaches.own[i]) / most;
}

}  // namespace

void fade_weights(double falloff, std::span<const Probe> probes, std::span<const glm::vec2> vertices,
                  std::span<float> weights) {
    assert(weights.size() == vertices.size() * probes.size());
    for_each_row(probes, vertices.size(), [&](Reaches& reaches, std::size_t v) {
        fade(falloff, reaches, vertices[v], weights.subspan(v * probes.size(), probes.size()));
    });
}

void keep_heaviest(std::size_t most, std::size_t probes, std::span<float> weights) {
    assert(most >= 1 && probes >= 1 && weights.size() % probes == 0);
    if (most >= probes) return;
    std::vector<float> sorted(probes);
    for (std::size_t start = 0; start < weights.size(); start += probes) {
        const auto row = weights.subspan(start, probes);
        sorted.assign(row.begin(), row.end());
        const auto last = sorted.begin() + std::ptrdiff_t(most) - 1;
        std::nth_element(sorted.begin(), last, sorted.end(), std::greater<>());
        const float least = *last;
        // Of equals the first stay.
        auto equals =
            std::ptrdiff_t(most) - std::count_if(row.begin(), row.end(), [&](float w) { return w > least; });
        for (float& w : row)
            if (w < least || (w == least && --equals < 0)) w = 0;
    }
}

}  // namespace probewarp
