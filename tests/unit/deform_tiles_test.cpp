// The deformation by vector units against the plain function, with every instruction set that this machine
// has.
#include "model/deform_tiles.h"

#include <oneapi/tbb/task_arena.h>

#include <cmath>
#include <tuple>

#include "generators.h"
#include "math/blend.h"
#include "model/deformation.h"
#include "pictures.h"
#include "support/every_instruction_set.h"
#include "weighed_scene.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::angle;
using testing::any_weighed_scene;
using testing::apart;
using testing::blank_document;
using testing::degrees;
using testing::expect_always;
using testing::MovedVertices;
using testing::weighed_scene_of;
using testing::WeighedScene;
using testing::whole;
using testing::with_every_instruction_set;

MovedVertices plainly(const WeighedScene& scene) {
    MovedVertices moved{scene.rest, 0};
    moved.cancelled = deform_dlb(scene.rest, scene.weights, scene.pose(), moved.now);
    return moved;
}

MovedVertices by_tiles(const WeighedScene& scene) {
    MovedVertices moved{std::vector<glm::vec2>(scene.rest.size()), 0};
    moved.cancelled = deform_dlb(make_tiles(scene.weights, scene.probes()), scene.rest, scene.pose(),
                                 {0, scene.rest.size()}, moved.now);
    return moved;
}

/// |s0| / sum w of one vertex, in double.
double share_of(const WeighedScene& scene, std::size_t vertex) {
    std::complex<double> s0;
    double total = 0;
    for (std::size_t i = 0; i < scene.probes(); ++i) {
        const double w = double(scene.weights[vertex * scene.probes() + i]);
        s0 += w * scene.motions[i].p.p0;
        total += w;
    }
    return std::abs(s0) / total;
}

/// How far the quick function may be from the plain one; image pixels. As for Deform's own test: floats of up
/// to 8192 pixels, their rounding magnified where the sum is short, twice four times over.
double allowed_at(double share) { return std::max(0.01, 8192 * 0x1p-21 / (share * share)); }

MovedVertices by_dragging(const WeighedScene& scene, const WeightTiles& tiles, const OthersSum& others) {
    MovedVertices moved{std::vector<glm::vec2>(scene.rest.size()), 0};
    moved.cancelled = deform_dlb_dragged(tiles, others, scene.rest, scene.pose(), moved.now);
    return moved;
}

TEST(DeformTiles, IsThePlainFunctionUpToRounding) {
    with_every_instruction_set([] {
        expect_always("any number of vertices, 1 to 70 probes, many turns", [] {
            const WeighedScene scene = any_weighed_scene(*whole(1, 200), *whole(1, 70), 5);
            const MovedVertices plain = plainly(scene), quick = by_tiles(scene);
            RC_ASSERT(quick.cancelled == plain.cancelled);
            for (std::size_t v = 0; v < scene.rest.size(); ++v) {
                RC_ASSERT(apart(plain.now[v], quick.now[v]) <= allowed_at(share_of(scene, v)));
            }
        });
    });
}

TEST(DeformTiles, LeavesEveryVertexExactlyWhereNoProbeMoved) {
    with_every_instruction_set([] {
        expect_always("now = rest, exactly", [] {
            WeighedScene scene = any_weighed_scene(*whole(1, 100), *whole(1, 40), 1);
            const std::size_t probes = scene.probes();
            scene.motions.clear(), scene.transformations.clear();
            for (std::size_t i = 0; i < probes; ++i) scene.add(motion<double>(0, {3, 4}, {3, 4}));
            const MovedVertices moved = by_tiles(scene);
            RC_ASSERT(moved.now == scene.rest);
            RC_ASSERT(moved.cancelled == 0u);
        });
    });
}

TEST(DeformTiles, CancelledVerticesFollowTheHeaviestAsInThePlainFunction) {
    with_every_instruction_set([] {
        expect_always("a whole turn against none, equal weights or nearly", [] {
            WeighedScene scene = any_weighed_scene(*whole(1, 100), 3, 0);
            scene.motions.clear(), scene.transformations.clear();
            scene.add(motion<double>(0, {-500, 20}, {-490, 20}));
            scene.add(motion<double>(360 * degrees, {500, 20}, {530, 20}));
            scene.add(motion<double>(1, {0, 0}, {1, 1}));
            for (std::size_t v = 0; v < scene.rest.size(); ++v) {
                float* w = &scene.weights[3 * v];
                // Shares of 0, 5e-8 and 2.5e-7, below the threshold; 1e-5 and more, above it by as much.
                const float lacks[] = {0, 1e-7f, 5e-7f, 2e-5f, 0.5f};
                const float scale = *rc::gen::element(1.0f, 0.01f);
                w[0] = w[1] = scale, w[2] = 0;
                w[*whole(0, 1)] -= scale * lacks[*whole(0, 4)];
            }
            const MovedVertices plain = plainly(scene), quick = by_tiles(scene);
            RC_ASSERT(quick.cancelled == plain.cancelled);
            for (std::size_t v = 0; v < scene.rest.size(); ++v) {
                RC_ASSERT(std::isfinite(quick.now[v].x) && std::isfinite(quick.now[v].y));
                if (share_of(scene, v) < 1e-6) RC_ASSERT(plain.now[v] == quick.now[v]);
            }
        });
    });
}

TEST(DeformTiles, IsNeverNotANumber) {
    for (const float w : {0.0f, 1e-30f, 1e-20f, 1.0f, 1e15f}) {
        WeighedScene scene;
        scene.centre = glm::vec2(0);
        scene.add(motion<double>(0, 0, 5));
        scene.add(motion<double>(360 * degrees, 0, 7));
        for (int v = 0; v < 9; ++v) {
            scene.rest.push_back({v, 2 * v});
            scene.weights.insert(scene.weights.end(), {w, v % 2 ? w : 0});
        }
        with_every_instruction_set([&] {
            for (const glm::vec2 now : by_tiles(scene).now)
                EXPECT_TRUE(std::isfinite(now.x) && std::isfinite(now.y)) << w;
        });
    }
}

TEST(DeformTiles, ARunIsDeformedAsTheWhole) {
    with_every_instruction_set([] {
        expect_always("the run's vertices anew, the others within its blocks alike, none beyond", [] {
            const int vertices = *whole(1, 150);
            WeighedScene scene = any_weighed_scene(vertices, *whole(1, 9), 2);
            const std::size_t first = std::size_t(*whole(0, vertices - 1));
            const std::size_t count = std::size_t(*whole(0, vertices - int(first)));
            const WeightTiles tiles = make_tiles(scene.weights, scene.probes());
            const MovedVertices whole_mesh = by_tiles(scene);
            std::vector<glm::vec2> now(scene.rest.size(), glm::vec2(-7));
            deform_dlb(tiles, scene.rest, scene.pose(), {first, count}, now);
            for (std::size_t v = 0; v < now.size(); ++v) {
                const bool in_run = v >= first && v < first + count;
                const bool untouched = !in_run && now[v] == glm::vec2(-7);
                RC_ASSERT(untouched || now[v] == whole_mesh.now[v]);
                if (count == 0 || v + tile_block < first || v >= first + count + tile_block)
                    RC_ASSERT(untouched);
            }
        });
    });
}

/// One of the numbers that are kept of a vertex.
float other_at(const OthersSum& others, std::size_t vertex, std::size_t row) {
    return others.values[(vertex / tile_width * 4 + row) * tile_width + vertex % tile_width];
}

/// Whether two sums are the same at the vertices that there are: behind the last one nothing is promised, nor
/// which of the many bit patterns stands for what is not a number.
bool same(const OthersSum& a, const OthersSum& b, std::size_t vertices) {
    if (a.values.size() != b.values.size()) return false;
    for (std::size_t v = 0; v < vertices; ++v)
        for (std::size_t row = 0; row < 4; ++row) {
            const float x = other_at(a, v, row), y = other_at(b, v, row);
            if (x != y && !(std::isnan(x) && std::isnan(y))) return false;
        }
    return true;
}

TEST(DeformTiles, IsTheSameByAnyNumberOfThreads) {
    // 70 x 32 vertices of 64 probes: more than four times what one thread takes at least. Few cases, whose
    // failure is not made smaller: that takes long with so many weights, and tells no more.
    const auto moved = [](const WeighedScene& scene) {
        const WeightTiles tiles = make_tiles(scene.weights, 64);
        const OthersSum others = sum_others(tiles, scene.pose(), 7);
        return std::tuple(by_tiles(scene), by_dragging(scene, tiles, others), others);
    };
    with_every_instruction_set([&] {
        for (const int more : {0, 1, 15, 16, 17, 31}) {
            const WeighedScene scene = weighed_scene_of(unsigned(more), 70 * 32 + more, 64, 3);
            const auto [at_once, dragged, others] = moved(scene);
            oneapi::tbb::task_arena one(1);
            const auto [alone, alone_dragged, alone_others] = one.execute([&] { return moved(scene); });
            EXPECT_TRUE(at_once == alone) << more;
            EXPECT_TRUE(dragged == alone_dragged) << more;
            EXPECT_TRUE(same(others, alone_others, scene.rest.size())) << more;
        }
    });
}

TEST(DeformTiles, NothingIsLeftUnwrittenBehindTheLastVertex) {
    with_every_instruction_set([] {
        for (const int vertices : {1, 7, 8, 9, 16, 17, 31, 32, 33}) {
            const WeighedScene scene = weighed_scene_of(3, vertices, 5, 1);
            const WeightTiles tiles = make_tiles(scene.weights, 5);
            const OthersSum others = sum_others(tiles, scene.pose(), 2);
            // Such a vertex has no weight of the dragged probe: the others' sum over least_share.
            const DualComplex<float> first = scene.transformations[0];
            for (std::size_t v = scene.rest.size(); v < tiles.weights.size() / 5; ++v) {
                EXPECT_FLOAT_EQ(other_at(others, v, 0), first.p0.real() / 1e-12f) << vertices << ", " << v;
                EXPECT_FLOAT_EQ(other_at(others, v, 3), first.p1.imag() / 1e-12f) << vertices << ", " << v;
            }
        }
    });
}

TEST(DeformTiles, ADraggedProbeIsWhatAllProbesAreUpToRounding) {
    with_every_instruction_set([] {
        expect_always("at the end of a drag, and back at its beginning", [] {
            WeighedScene scene = any_weighed_scene(*whole(1, 200), *whole(1, 40), 5);
            const std::size_t probe = std::size_t(*whole(0, int(scene.probes()) - 1));
            const WeightTiles tiles = make_tiles(scene.weights, scene.probes());
            const OthersSum others = sum_others(tiles, scene.pose(), probe);
            const std::complex<double> rest = scene.motions[probe].rest;
            scene.motions[probe] = motion(*angle(5), rest, rest + *testing::point<double>(1000));
            scene.transformations[probe] = cast<float>(scene.motions[probe].p);
            const MovedVertices plain = plainly(scene), moved = by_dragging(scene, tiles, others);
            RC_ASSERT(moved.cancelled == plain.cancelled);
            for (std::size_t v = 0; v < scene.rest.size(); ++v)
                RC_ASSERT(apart(plain.now[v], moved.now[v]) <= allowed_at(share_of(scene, v)));
        });
    });
}

TEST(DeformTiles, ADraggedProbeMayCancelTheOthersOrHaveNoWeight) {
    with_every_instruction_set([] {
        expect_always("equal weights or nearly, none, or hardly any, turned against the others", [] {
            WeighedScene scene = any_weighed_scene(*whole(1, 100), 2, 0);
            scene.motions.clear(), scene.transformations.clear();
            scene.add(motion<double>(0, {-500, 20}, {-490, 20}));
            scene.add(motion<double>(0, {500, 20}, {530, 20}));
            for (std::size_t v = 0; v < scene.rest.size(); ++v) {
                const float scale = *rc::gen::element(1.0f, 1e-3f);
                const float shares[] = {1, 1 - 1e-7f, 1 - 2e-5f, 0.5f, 1e-14f, 1e-30f, 0};
                scene.weights[2 * v] = scale, scene.weights[2 * v + 1] = scale * shares[*whole(0, 6)];
            }
            const WeightTiles tiles = make_tiles(scene.weights, 2);
            const OthersSum others = sum_others(tiles, scene.pose(), 1);
            scene.motions[1] = motion<double>(*rc::gen::element(360.0, 359.0, 90.0) * degrees, {500, 20}, 0);
            scene.transformations[1] = cast<float>(scene.motions[1].p);
            const MovedVertices plain = plainly(scene), moved = by_dragging(scene, tiles, others);
            RC_ASSERT(moved.cancelled == plain.cancelled);
            for (std::size_t v = 0; v < scene.rest.size(); ++v) {
                const double share = share_of(scene, v);
                const bool same = plain.now[v] == moved.now[v];
                RC_ASSERT(same || (share >= 1e-6 && apart(plain.now[v], moved.now[v]) <= allowed_at(share)));
            }
        });
    });
}

TEST(WeightTiles, HoldEveryWeightAndTakeOverRuns) {
    expect_always("made at once or run by run", [] {
        const WeighedScene before = any_weighed_scene(*whole(1, 100), 5, 0);
        WeighedScene after = before;
        WeightTiles tiles = make_tiles(before.weights, 5);
        const std::size_t first = std::size_t(*whole(0, int(before.rest.size()) - 1));
        const std::size_t count = before.rest.size() - first;
        for (std::size_t k = 5 * first; k < after.weights.size(); ++k) after.weights[k] *= 0.5f;
        put(tiles, {first, count}, std::span(after.weights).subspan(5 * first));
        for (std::size_t v = 0; v < before.rest.size(); ++v)
            for (std::size_t i = 0; i < 5; ++i)
                RC_ASSERT(column(tiles, v)[i * tile_width] == after.weights[5 * v + i]);
        const std::size_t all = tiles.weights.size() / 5;
        RC_ASSERT(all % tile_block == 0 && all >= before.rest.size() &&
                  all < before.rest.size() + tile_block);
        RC_ASSERT(tiles.vertices == before.rest.size() && tiles.probes == 5u);
    });
}

/// A document with a few probes that turn little, so that a float's rounding counts nowhere much, and what
/// became of it.
struct Drags : ::testing::Test {
    Document document = blank_document(640, 480, 20);
    Deformation deformation;

    void SetUp() override {
        for (const int x : {100, 300, 500}) add_probe(document, {x, x / 2 + 40}, {x + 9, x / 2}, 0.3);
        update(deformation, document);
    }
    /// How far the vertices are at most from where a fresh deformation has them; image pixels.
    double error() const {
        Deformation anew;
        update(anew, document);
        EXPECT_EQ(deformation.cancelled, anew.cancelled);
        EXPECT_EQ(deformation.moved, anew.moved);
        EXPECT_EQ(weights_of(deformation).size(), weights_of(anew).size());
        double most = 0;
        for (std::size_t v = 0; v < anew.now.size(); ++v)
            most = std::max(most, apart(deformation.now[v], anew.now[v]));
        return most;
    }
};
constexpr double float_pixels = 640 * 0x1p-20;  // 16 roundings of the largest coordinate

TEST_F(Drags, DoNotGatherErrorsAndSettleInEveryBit) {
    for (int step = 0; step < 1000; ++step) {
        document.probes[1].now.x += 0.37, document.probes[1].angle += 0.001;
        update(deformation, document, Pace::dragging);
        EXPECT_TRUE(deformation.dragged);
    }
    EXPECT_LT(error(), float_pixels);
    const auto version = deformation.version;
    update(deformation, document, Pace::dragging);  // held still
    EXPECT_EQ(deformation.version, version);
    update(deformation, document);
    EXPECT_EQ(deformation.version, version + 1);
    EXPECT_FALSE(deformation.dragged);
    EXPECT_EQ(error(), 0);
}

TEST_F(Drags, EndExactlyAtRest) {
    for (Probe& probe : document.probes) probe.now = probe.rest, probe.angle = 0;
    update(deformation, document);
    document.probes[2].now.y += 50;
    update(deformation, document, Pace::dragging);
    document.probes[2].now = document.probes[2].rest;
    update(deformation, document, Pace::dragging);
    EXPECT_TRUE(deformation.dragged);
    EXPECT_EQ(deformation.now, mesh_of(deformation).rest);
}

TEST_F(Drags, FollowEveryOtherChangeInBetween) {
    const auto step = [&](const char* what) {
        update(deformation, document, Pace::dragging);
        EXPECT_LT(error(), float_pixels) << what;
        document.probes[0].now.x += 1;
        update(deformation, document, Pace::dragging);
        EXPECT_LT(error(), float_pixels) << what << ", then dragged";
    };
    document.probes[0].now.x += 5;
    step("the same probe");
    document.probes[1].angle -= 0.2;
    step("another probe");
    document.probes[1].angle -= 0.2, document.probes[0].angle += 0.1;
    step("two probes");
    document.blend = "spiral";
    step("another blend");
    document.blend = "dlb";
    step("and back");
    document.weights.most = 2;
    step("fewer probes a vertex");
    document.weights.exponent = 3;
    step("other weights");
    document.probes[0].radius = 40;
    step("another reach");
    document.probes.pop_back();
    step("a probe less");
    document.mesh.cells = 15;
    step("another mesh");
    document.probes[1].paint = std::make_shared<const PaintMap>(map_of(document, nullptr));
    step("blank paint");
    document.probes[1].name = "other";
    step("another name");
}

TEST(Deformation, ACopyDeformsOn) {
    Document document = blank_document(640, 480, 10);
    add_probe(document, {100, 100}, {150, 90}, 0.5);
    add_probe(document, {400, 300}, {410, 330}, -1);
    Deformation first;
    update(first, document);
    Deformation copy = first;
    const BlendMethod& spiral = *find_blend_method("spiral");
    EXPECT_EQ(positions_by(first, spiral), positions_by(copy, spiral));
    document.probes[0].angle = 2;
    update(first, document), update(copy, document);
    EXPECT_EQ(first.now, copy.now);
}

}  // namespace
}  // namespace probewarp
