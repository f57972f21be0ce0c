// Every blend by vector units against the blend itself, with every instruction set that this machine has.
#include "model/blend_tiles.h"

#include "pictures.h"
#include "support/every_instruction_set.h"
#include "weighed_scene.h"

namespace probewarp {
namespace {

using testing::angle;
using testing::any_weighed_scene;
using testing::apart;
using testing::degrees;
using testing::expect_always;
using testing::MovedVertices;
using testing::WeighedScene;
using testing::whole;
using testing::with_every_instruction_set;

MovedVertices by_blend(const WeighedScene& scene, const BlendMethod& method) {
    MovedVertices moved{std::vector<glm::vec2>(scene.rest.size()), 0};
    for (std::size_t v = 0; v < scene.rest.size(); ++v) {
        const auto row = std::span(scene.weights).subspan(v * scene.probes(), scene.probes());
        const auto map = method.blend(std::vector<double>(row.begin(), row.end()), scene.motions);
        const glm::dvec2 from(scene.rest[v] - scene.centre);
        moved.now[v] = scene.rest[v] + glm::vec2(to_vec(map.less_one * to_complex(from) + map.shift));
        moved.cancelled += map.cancelled;
    }
    return moved;
}

MovedVertices by_tiles(const WeighedScene& scene, const BlendMethod& method) {
    MovedVertices moved{std::vector<glm::vec2>(scene.rest.size()), 0};
    moved.cancelled = method.deform(make_tiles(scene.weights, scene.probes()), scene.rest, scene.pose(),
                                    {0, scene.rest.size()}, moved.now);
    return moved;
}

/// All but DLB, which is in float and has tests of its own.
std::span<const BlendMethod> blends_in_double() { return blend_methods().subspan(1); }

void check_every_blend(const WeighedScene& scene) {
    for (const BlendMethod& method : blends_in_double()) {
        const MovedVertices plain = by_blend(scene, method), quick = by_tiles(scene, method);
        RC_LOG() << method.name;
        RC_ASSERT(quick.cancelled == plain.cancelled);
        for (std::size_t v = 0; v < scene.rest.size(); ++v) {
            // Both are double but for what they are rounded to, floats of that size; where points nearly
            // coincide, the rounding of their centre is up to 1e-8 of how they lie to each other.
            const double size = 8192 + glm::length(glm::dvec2(plain.now[v]));
            RC_ASSERT(apart(plain.now[v], quick.now[v]) <= 2e-7 * size);
        }
    }
}

TEST(BlendTiles, AreTheBlendItself) {
    with_every_instruction_set([] {
        expect_always("any number of vertices, 1 to 40 probes, many turns",
                      [] { check_every_blend(any_weighed_scene(*whole(1, 100), *whole(1, 40), 5)); });
    });
}

TEST(BlendTiles, AreTheBlendWhereOneProbeHasNearlyAllTheWeight) {
    with_every_instruction_set([] {
        expect_always("shares of 1e-4 to 1e-30 for the others, or none", [] {
            WeighedScene scene = any_weighed_scene(*whole(1, 60), *whole(1, 6), 1);
            for (std::size_t v = 0; v < scene.rest.size(); ++v) {
                const auto heavy = std::size_t(*whole(0, int(scene.probes()) - 1));
                for (std::size_t i = 0; i < scene.probes(); ++i)
                    if (i != heavy)
                        scene.weights[v * scene.probes() + i] =
                            *rc::gen::element(1e-4f, 1e-8f, 1e-12f, 1e-16f, 1e-20f, 1e-30f, 0.0f);
                scene.weights[v * scene.probes() + heavy] = 1;
            }
            check_every_blend(scene);
        });
    });
}

TEST(BlendTiles, HaveNoAnswerWhereTheBlendHasNone) {
    with_every_instruction_set([] {
        expect_always("whole and half turns, in place or away, opposite probes, probes on one place", [] {
            WeighedScene scene = any_weighed_scene(*whole(1, 100), 1, 0);
            scene.motions.clear(), scene.transformations.clear(), scene.weights.clear();
            const std::complex<double> places[] = {{-500, 20}, {500, 20}, {500, 20}, {0, 300}};
            const int probes = *whole(1, 5);
            for (int i = 0; i < probes; ++i) {
                const double turn = *rc::gen::element(0.0, 90.0, 180.0, -180.0, 360.0, 720.0, 4e6 * 360.0);
                scene.add(motion<double>(turn * degrees, places[*whole(0, 3)], places[*whole(0, 3)]));
            }
            const std::size_t count = scene.rest.size() * scene.probes();
            for (std::size_t k = 0; k < count; ++k)
                scene.weights.push_back(k % scene.probes() == 0 ? 1.0f : *rc::gen::element(0.0f, 0.5f, 1.0f));
            check_every_blend(scene);
        });
    });
}

TEST(BlendTiles, HaveNoRotationForAMirroredSquare) {
    with_every_instruction_set([] {
        expect_always("seen in a mirror, no rotation of a square is nearer than another", [] {
            WeighedScene scene = any_weighed_scene(*whole(1, 50), 1, 0);
            scene.motions.clear(), scene.transformations.clear();
            for (const std::complex<double> corner :
                 {std::complex(300.0, 300.0), {-300, 300}, {-300, -300}, {300, -300}})
                scene.add(motion<double>(0, corner, std::conj(corner)));
            scene.weights.assign(4 * scene.rest.size(), 1);
            check_every_blend(scene);
            RC_ASSERT(by_tiles(scene, *find_blend_method("mls-rigid")).cancelled == scene.rest.size());
        });
    });
}

TEST(BlendTiles, MoveARunAsTheWhole) {
    with_every_instruction_set([] {
        expect_always("bit for bit, by every blend", [] {
            const WeighedScene scene = any_weighed_scene(*whole(1, 150), *whole(1, 9), 2);
            const int vertices = int(scene.rest.size()), first = *whole(0, vertices - 1);
            const VertexRun run{std::size_t(first), std::size_t(*whole(1, vertices - first))};
            const WeightTiles tiles = make_tiles(scene.weights, scene.probes());
            for (const BlendMethod& method : blends_in_double()) {
                const MovedVertices whole_mesh = by_tiles(scene, method);
                std::vector<glm::vec2> now(scene.rest.size(), glm::vec2(-7));
                method.deform(tiles, scene.rest, scene.pose(), run, now);
                for (std::size_t v = run.first; v < run.first + run.count; ++v)
                    RC_ASSERT(now[v] == whole_mesh.now[v]);
            }
        });
    });
}

}  // namespace
}  // namespace probewarp
