// Inverse-distance weights: hand numbers, probes on a vertex, and finiteness at every distance.
#include "model/weights.h"

#include "generators.h"

namespace probewarp {
namespace {

using testing::expect_always;
using testing::magnitude;
using testing::real;
using testing::whole;

Probe probe_at(glm::dvec2 rest, double radius) {
    Probe probe;
    probe.rest = probe.now = rest;
    probe.radius = radius;
    return probe;
}

std::vector<float> weights_of(const std::vector<Probe>& probes, glm::dvec2 vertex) {
    std::vector<float> weights(probes.size(), -1);
    inverse_distance_weights(probes, vertex, weights);
    return weights;
}

using Weights = std::vector<float>;

TEST(Weights, AreRadiusSquaredOverDistanceSquared) {
    // 10^2 / 5^2 = 4 and 20^2 / 40^2 = 1/4: as 1 to 1/16.
    EXPECT_EQ(weights_of({probe_at({3, 4}, 10), probe_at({40, 0}, 20)}, {0, 0}), (Weights{1, 0.0625f}));
    // Twice the radius weighs four times as much at the same distance.
    EXPECT_EQ(weights_of({probe_at({0, 7}, 100), probe_at({7, 0}, 200)}, {0, 0}), (Weights{0.25f, 1}));
    EXPECT_EQ(weights_of({probe_at({0, 7}, 100)}, {0, 0}), Weights{1});
}

TEST(Weights, AProbeOnTheVertexIsAlone) {
    EXPECT_EQ(weights_of({probe_at({50, 50}, 1e6), probe_at({0, 0}, 1)}, {0, 0}), (Weights{0, 1}));
    // Several share it, whatever their radii.
    EXPECT_EQ(weights_of({probe_at({8, 9}, 1), probe_at({8, 8}, 1e6), probe_at({8, 9}, 50)}, {8, 9}),
              (Weights{1, 0, 1}));
}

TEST(Weights, DoNotDependOnProbesThatOnlyMoved) {
    Probe moved = probe_at({3, 4}, 10);
    moved.now = {1000, 1000};
    moved.angle = 9;
    EXPECT_EQ(weights_of({moved, probe_at({40, 0}, 20)}, {0, 0}), (Weights{1, 0.0625f}));
}

TEST(Weights, AreWithinNoughtAndOneAtEveryDistance) {
    expect_always("finite, >= 0, and the largest is 1", [] {
        std::vector<Probe> probes;
        const int count = *whole(1, 6);
        for (int i = 0; i < count; ++i)  // squares underflow below 1e-162 and overflow above 1e154
            probes.push_back(
                probe_at({*magnitude(-310, 300), *magnitude(-310, 300)}, std::abs(*magnitude(-310, 300))));
        if (*whole(0, 1)) probes[0].rest = {0, 0};
        const auto weights = weights_of(probes, {0, 0});
        for (const float w : weights) RC_ASSERT(w >= 0 && w <= 1);  // false for NaN
        RC_ASSERT(*std::max_element(weights.begin(), weights.end()) == 1);
    });
}

TEST(Weights, OfProbesFarOutsideThePictureStillFollowTheFormula) {
    expect_always("w_i / w_j = (r_i d_j / r_j d_i)^2", [] {
        const Probe a = probe_at({*magnitude(6, 7), *magnitude(6, 7)}, *real(1, 1e6));
        const Probe b = probe_at({*magnitude(6, 7), *magnitude(6, 7)}, *real(1, 1e6));
        const glm::dvec2 v{*real(0, 8192), *real(0, 8192)};
        const auto share = [v](const Probe& p) {
            return std::pow(p.radius / std::hypot(p.rest.x - v.x, p.rest.y - v.y), 2);
        };
        const auto weights = weights_of({a, b}, v);
        // Each weight is one float of 24 bits: 6e-8 of itself.
        RC_ASSERT(std::abs(double(weights[0]) * share(b) - double(weights[1]) * share(a)) <=
                  7e-8 * std::max(share(a), share(b)));
    });
}

TEST(Weights, TableIsRowMajor) {
    const std::vector probes{probe_at({0, 0}, 10), probe_at({4, 0}, 10)};
    const std::vector<glm::vec2> vertices{{0, 0}, {1, 0}, {2, 0}};
    EXPECT_EQ(weight_table(weight_schemes()[0], probes, vertices), (Weights{1, 0, 1, 1.0f / 9, 1, 1}));
    EXPECT_TRUE(weight_table(weight_schemes()[0], {}, vertices).empty());
}

TEST(Weights, SchemesAreFoundByName) {
    for (const WeightScheme& scheme : weight_schemes()) EXPECT_EQ(find_weight_scheme(scheme.name), &scheme);
    EXPECT_EQ(find_weight_scheme("no such scheme"), nullptr);
}

}  // namespace
}  // namespace probewarp
