// Vertices with any weights, and what moves them.
#pragma once

#include <random>

#include "generators.h"
#include "model/deform_tiles.h"

namespace probewarp::testing {

/// Some vertices, their weights, and what moves them; values as the meshes and schemes give them.
struct WeighedScene {
    std::vector<glm::vec2> rest;
    std::vector<float> weights;
    std::vector<Motion<double>> motions;
    std::vector<DualComplex<float>> transformations;
    glm::vec2 centre{4096, 2500};

    std::size_t probes() const { return motions.size(); }
    Pose pose() const { return {motions, transformations, centre}; }
    void add(const Motion<double>& motion) {
        motions.push_back(motion);
        transformations.push_back(cast<float>(motion.p));
    }
};

/// Vertices and their weights at random, and what moves them: probe i turns by angle_of(i).
template <class AngleOf>
WeighedScene weighed_scene(unsigned seed, int vertices, int probes, const AngleOf& angle_of) {
    WeighedScene scene;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0, 8192), way(-1000, 1000), share(0, 1);
    for (int v = 0; v < vertices; ++v) scene.rest.push_back({place(random), place(random)});
    for (int v = 0; v < vertices * probes; ++v)
        scene.weights.push_back(share(random) < 0.2 ? 0.0f : float(std::pow(share(random), 4)));
    for (int v = 0; v < vertices; ++v)  // one of each row is 1
        scene.weights[std::size_t(v * probes + int(random() % unsigned(probes)))] = 1;
    for (int i = 0; i < probes; ++i) {
        const std::complex<double> rest(place(random) - 4096, place(random) - 2500);
        scene.add(motion(angle_of(i), rest, rest + std::complex<double>(way(random), way(random))));
    }
    return scene;
}

inline WeighedScene any_weighed_scene(int vertices, int probes, double turns) {
    const auto seed = unsigned(*whole(0, 1 << 30));
    return weighed_scene(seed, vertices, probes, [&](int) { return *angle(turns); });
}

/// The same scene for the same seed, outside of properties too. The probes' angles differ, up to `turns`.
inline WeighedScene weighed_scene_of(unsigned seed, int vertices, int probes, double turns) {
    return weighed_scene(seed, vertices, probes,
                         [&](int i) { return (2.0 * i / probes - 1) * turns * 2 * std::numbers::pi; });
}

struct MovedVertices {
    std::vector<glm::vec2> now;
    std::size_t cancelled = 0;
    friend bool operator==(const MovedVertices&, const MovedVertices&) = default;
};

inline double apart(glm::dvec2 a, glm::dvec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace probewarp::testing
