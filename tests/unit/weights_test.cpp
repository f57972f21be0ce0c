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

std::vector<float> weights_of(const std::vector<Probe>& probes, glm::dvec2 vertex, double exponent = 2) {
    std::vector<float> weights(probes.size(), -1);
    inverse_distance_weights(probes, exponent, vertex, weights);
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

TEST(Weights, FallWithTheExponent) {
    // 2 and 1/2 reaches away: the ratio is 1/4 to the exponent.
    EXPECT_EQ(weights_of({probe_at({0, 5}, 10), probe_at({0, 20}, 10)}, {0, 0}, 1), (Weights{1, 0.25f}));
    EXPECT_EQ(weights_of({probe_at({0, 5}, 10), probe_at({0, 20}, 10)}, {0, 0}, 3), (Weights{1, 1.0f / 64}));
    EXPECT_EQ(weights_of({probe_at({0, 0}, 10), probe_at({0, 20}, 10)}, {0, 0}, 0.5), (Weights{1, 0}));
}

TEST(Weights, OfTheGaussianFadeWithTheReach) {
    const auto at = [](double x) {
        Weights weights(2);
        gaussian_weights(std::vector{probe_at({0, 0}, 10), probe_at({40, 0}, 20)}, {x, 0}, weights);
        return weights;
    };
    EXPECT_EQ(at(0), (Weights{1, 0}));  // each interpolates
    EXPECT_EQ(at(40), (Weights{0, 1}));
    // At 10: 1 / (e - 1) = 0.5820 against 1 / (e^2.25 - 1) = 0.1178: float's rounding of the quotient.
    EXPECT_NEAR(at(10)[1], 0.1178 / 0.5820, 1e-4);
    EXPECT_EQ(at(10)[0], 1);
    // Far away the wider one rules, and nothing underflows to no weight at all.
    EXPECT_EQ(at(1e6), (Weights{0, 1}));
}

TEST(Weights, TableIsRowMajorAndExactAtTheProbes) {
    const Mesh grid = grid_mesh(4, 1, 4);
    Image image;
    image.width = 4;
    image.height = 1;
    const std::vector<std::uint8_t> kept(4, 1);
    const std::vector probes{probe_at({0, 0}, 10), probe_at({1.3, 0.4}, 10)};
    const std::vector<glm::dvec2> rests{probes[0].rest, probes[1].rest};
    const Mesh mesh = probe_mesh(image, 4, kept, rests);
    const Islands islands = islands_of(mesh);
    std::shared_ptr<WeightCache> cache;
    for (const char* name : {"inverse-distance", "gaussian"}) {
        const auto table = find_weight_scheme(name)->table({mesh, islands, probes, 2, cache});
        ASSERT_EQ(table.size(), mesh.rest.size() * 2);
        EXPECT_EQ((Weights{table[0], table[1]}), (Weights{1, 0})) << name;
        const std::size_t own = mesh.anchors[1];
        EXPECT_EQ(own, mesh.rest.size() - 1);
        EXPECT_EQ((Weights{table[2 * own], table[2 * own + 1]}), (Weights{0, 1})) << name;
        const float second = weights_of(probes, {1, 0})[0];  // its ratio to the second probe's 1
        if (name == std::string("inverse-distance")) {
            EXPECT_EQ((Weights{table[2], table[3]}), (Weights{second, 1}));
        }
    }
    EXPECT_EQ(grid.anchors.size(), 0u);
}

TEST(Weights, FadeToNothingAtTheFalloff) {
    const std::vector probes{probe_at({0, 0}, 10), probe_at({100, 0}, 10)};
    const std::vector<glm::vec2> vertices{{0, 0}, {10, 0}, {20, 0}, {50, 0}};
    Weights weights{1, 0.5f, 1, 0.5f, 1, 0.5f, 1, 0.5f};
    fade_weights(2, probes, vertices, weights);
    EXPECT_EQ(weights,
              (Weights{1, 0, 1, 0, 1, 0.5f, 1, 0.5f}));  // at 20 and at 50 no probe reaches: as before
    Weights both{1, 1};
    // 10 of 30 and 20 of 30: (1 - 1/9)^2 and (1 - 4/9)^2.
    fade_weights(3, std::vector{probe_at({0, 0}, 10), probe_at({30, 0}, 10)}, std::vector<glm::vec2>{{10, 0}},
                 both);
    EXPECT_EQ(both[0], 1);
    EXPECT_NEAR(both[1], 25.0 / 64, 1e-7);  // one float
}

TEST(Weights, OnlyTheHeaviestStay) {
    Weights weights{0.1f, 1, 0.3f, 0.2f, 0.5f, 0.5f, 1, 0.5f};
    keep_heaviest(2, 4, weights);
    EXPECT_EQ(weights, (Weights{0, 1, 0.3f, 0, 0.5f, 0, 1, 0}));  // of equals the first
    keep_heaviest(9, 4, weights);
    EXPECT_EQ(weights, (Weights{0, 1, 0.3f, 0, 0.5f, 0, 1, 0}));
    keep_heaviest(1, 4, weights);
    EXPECT_EQ(weights, (Weights{0, 1, 0, 0, 0, 0, 1, 0}));
}

TEST(Weights, SchemesAreFoundByName) {
    for (const WeightScheme& scheme : weight_schemes()) EXPECT_EQ(find_weight_scheme(scheme.name), &scheme);
    EXPECT_EQ(find_weight_scheme("no such scheme"), nullptr);
}

}  // namespace
}  // namespace probewarp
