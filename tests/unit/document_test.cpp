// The document and its deformation: what is computed anew and what is kept, and the pose of the picture at a
// place.
#include "math/blend.h"
#include "model/deformation.h"

#include <algorithm>
#include <limits>

#include "generators.h"
#include "model/paint_ops.h"
#include "pictures.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::blank_document;
using testing::blank_picture;
using testing::degrees;
using testing::error_of;
using testing::expect_always;
using testing::real;
using testing::whole;

double distance(glm::dvec2 a, glm::dvec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(Document, NewProbesHaveFreshIdsAndAReachOfAnEighth) {
    Document document = blank_document(640, 1024);
    const Probe first = add_probe(document, {1, 2}, {1, 2});
    EXPECT_EQ(first.id, 1);
    EXPECT_EQ(first.name, "Probe 1");
    EXPECT_EQ(first.colour, probe_colour(0));
    document.probes[0].id = 41;
    const Probe next = new_probe(document, {3, 4});
    EXPECT_EQ(next.id, 42);
    EXPECT_EQ(next.radius, 128);
    EXPECT_TRUE(at_rest(next));
    EXPECT_EQ(new_probe(blank_document(2, 1), {0, 0}).radius, 1);
}

TEST(Document, IdsStayWithinWhatAProjectHolds) {
    Document document = blank_document(8, 8);
    add_probe(document, {1, 2}, {1, 2});
    add_probe(document, {1, 2}, {1, 2}).id = max_probe_id;
    EXPECT_EQ(new_probe(document, {0, 0}).id, 2);  // the first that is free
}

TEST(Document, ProbesAreFoundById) {
    Document document = blank_document(8, 8);
    add_probe(document, {1, 2}, {1, 2});
    add_probe(document, {3, 4}, {3, 4});
    EXPECT_EQ(find_probe(document, 2), &document.probes[1]);
    EXPECT_EQ(find_probe(document, 3), nullptr);
    EXPECT_EQ(find_probe(document, 0), nullptr);
}

TEST(Document, UnposedIsAllButThePose) {
    Document document = blank_document(8, 8);
    add_probe(document, {1, 2}, {1, 2}, 0, 3);
    Document moved = document;
    moved.probes[0].now = {5, 6};
    EXPECT_EQ(unposed(moved), document);
    moved.probes[0].angle = 2;
    EXPECT_EQ(unposed(moved), document);
    moved.probes[0].radius = 4;
    EXPECT_NE(unposed(moved), document);
}

TEST(Deformation, ItsWeightsKeyIsThatOfEveryPose) {
    Document document = blank_document(8, 8);
    add_probe(document, {1, 2}, {3, 4}, 1);
    Deformation deformation;
    update(deformation, document);
    EXPECT_EQ(transformations_of(document), deformation.transformations);
    const WeightsKey key = weights_key(deformation);
    EXPECT_EQ(key.binding, deformation.binding);
    document.probes[0].now = {7, 7};
    update(deformation, document);
    EXPECT_EQ(weights_key(deformation), key);
    EXPECT_EQ(transformations_of(document), deformation.transformations);
    add_probe(document, {6, 2}, {6, 2});
    update(deformation, document);
    EXPECT_NE(weights_key(deformation), key);
}

TEST(Deformation, KnowsHowMuchThereIsToSettle) {
    Document document = blank_document(2000, 2000);
    add_probe(document, {100, 200}, {300, 400}, 1);
    add_probe(document, {1500, 200}, {1500, 200});
    Deformation deformation;
    update(deformation, document);
    const std::size_t table = deformation.now.size() * 2;
    const auto work = [&] { return refining_work(deformation, document); };
    EXPECT_EQ(work(), 0u);
    document.probes[0].now.x += 10;
    document.blend = "linear";
    EXPECT_EQ(work(), 0u) << "a pose";

    const PaintMap full = filled(new_paint_map(2000, 2000), 0.5f);
    document.probes[0].paint = std::make_shared<const PaintMap>(full);
    EXPECT_GE(work(), table);
    update(deformation, document);
    EXPECT_EQ(work(), 0u);
    PaintMap dabbed = full;
    edit_texels(dabbed, 10, 10, 12, 12, [](int, int, Paint) { return Paint{1, 1}; });
    document.probes[0].paint = std::make_shared<const PaintMap>(dabbed);
    EXPECT_GT(work(), 0u);
    EXPECT_LT(work(), table / 10) << "one tile";
    document.stiffness = document.probes[0].paint;
    EXPECT_GE(work(), table) << "it joins what is far apart";
    update(deformation, document);
    EXPECT_EQ(work(), 0u);
    document.weights.most = 1;
    EXPECT_GE(work(), table);
}

TEST(Deformation, VersionsGoOnWhereItIsReplaced) {
    Document document = blank_document(200, 200);
    add_probe(document, {10, 20}, {30, 40}, 1);
    Deformation deformation, same_mesh, other_mesh;
    update(deformation, document);
    pose(same_mesh, document, deformation.binding);
    update(other_mesh, document);
    const auto version = deformation.version, mesh = deformation.mesh_version;
    replace(deformation, same_mesh);
    EXPECT_EQ(deformation.version, version + 1);
    EXPECT_EQ(deformation.mesh_version, mesh);
    replace(deformation, other_mesh);
    EXPECT_EQ(deformation.version, version + 2);
    EXPECT_EQ(deformation.mesh_version, mesh + 1);
}

TEST(Deformation, CopiesKeepTheirWeights) {
    Document document = blank_document(200, 200);
    add_probe(document, {10, 20}, {30, 40}, 1);
    add_probe(document, {150, 20}, {150, 20});
    document.probes[0].paint = std::make_shared<const PaintMap>(filled(new_paint_map(200, 200), 0.5f));
    Deformation deformation;
    update(deformation, document);
    const Deformation copy = deformation;
    EXPECT_EQ(copy.refined, deformation.refined) << "shared";
    const auto before = *copy.refined;
    PaintMap dabbed = *document.probes[0].paint;
    edit_texels(dabbed, 10, 10, 50, 50, [](int, int, Paint) { return Paint{1, 1}; });
    document.probes[0].paint = std::make_shared<const PaintMap>(dabbed);
    update(deformation, document);
    EXPECT_NE(*deformation.refined, before);
    EXPECT_EQ(*copy.refined, before);
}

TEST(Document, AnotherPictureTakesTheProbesAlong) {
    Document document = blank_document(400, 200);
    add_probe(document, {200, 100}, {300, 50}, 1, 40);
    replace_picture(document, blank_picture(100, 200));  // half as long; centres (200, 100) and (50, 100)
    EXPECT_EQ(document.probes[0].rest, glm::dvec2(50, 100));
    EXPECT_EQ(document.probes[0].now, glm::dvec2(100, 75));
    EXPECT_EQ(document.probes[0].radius, 20);
    EXPECT_EQ(document.probes[0].angle, 1);
    Document empty;
    replace_picture(empty, blank_picture(100, 200));
    EXPECT_EQ(empty.picture->image.height, 200);
}

TEST(Document, RefusesMoreWeightsThanFit) {
    Document document = blank_document(100, 100, 1000);  // 1001^2 vertices: 66 probes fit in 2^26 weights
    for (int i = 0; i < 66; ++i) add_probe(document, {i, i}, {i, i});
    EXPECT_EQ(error_of([&] { check_size(document); }), "");
    add_probe(document, {0, 0}, {0, 0});
    const std::string error = error_of([&] { check_size(document); });
    EXPECT_NE(error.find("1002068 vertices times 67 probes"), std::string::npos) << error;
    Deformation deformation;
    EXPECT_NE(error_of([&] { update(deformation, document); }), "");
    EXPECT_EQ(deformation.version, 0u);  // and nothing is half done
}

struct Updates : ::testing::Test {
    Document document = blank_document(320, 200, 8);
    Deformation deformation;

    void SetUp() override {
        add_probe(document, {100, 100}, {120, 90}, 1);
        add_probe(document, {200, 100}, {200, 100});
        update(deformation, document);
    }
    /// The versions by which an update with the present document went on: {mesh's, everything's}.
    std::pair<unsigned long, unsigned long> steps() {
        const auto mesh = deformation.mesh_version, all = deformation.version;
        update(deformation, document);
        Deformation anew;
        update(anew, document);
        EXPECT_EQ(mesh_of(deformation).rest, mesh_of(anew).rest);
        EXPECT_EQ(deformation.binding->automatic, anew.binding->automatic);
        EXPECT_TRUE(std::ranges::equal(weights_of(deformation), weights_of(anew)));
        EXPECT_EQ(deformation.transformations, anew.transformations);
        EXPECT_EQ(deformation.now, anew.now);
        EXPECT_EQ(deformation.cancelled, anew.cancelled);
        EXPECT_EQ(deformation.source, document);
        return {deformation.mesh_version - mesh, deformation.version - all};
    }
};
using Steps = std::pair<unsigned long, unsigned long>;

TEST_F(Updates, NothingHappensWhereNothingChanged) {
    EXPECT_EQ(steps(), (Steps{0, 0}));
    document = Document(document);
    EXPECT_EQ(steps(), (Steps{0, 0}));
}

TEST_F(Updates, EveryChangeIsFollowed) {
    document.probes[0].now.x += 1;
    EXPECT_EQ(steps(), (Steps{0, 1}));
    document.probes[0].angle += 1;
    EXPECT_EQ(steps(), (Steps{0, 1}));
    document.probes[0].rest.y += 1;  // the mesh has a vertex there
    EXPECT_EQ(steps(), (Steps{1, 1}));
    document.probes[1].radius *= 2;
    EXPECT_EQ(steps(), (Steps{0, 1}));
    document.mesh.cells = 9;
    EXPECT_EQ(steps(), (Steps{1, 1}));
    document.picture = blank_picture(200, 320);
    EXPECT_EQ(steps(), (Steps{1, 1}));
    document.mesh.margin = 7;
    EXPECT_EQ(steps(), (Steps{1, 1}));
    document.weights.exponent = 3;
    EXPECT_EQ(steps(), (Steps{0, 1}));
    document.weights.scheme = "gaussian";
    EXPECT_EQ(steps(), (Steps{0, 1}));
    document.weights.falloff = 1.5;
    EXPECT_EQ(steps(), (Steps{0, 1}));
    document.weights.most = 1;
    EXPECT_EQ(steps(), (Steps{0, 1}));
    document.probes.pop_back();
    EXPECT_EQ(steps(), (Steps{1, 1}));
    document.probes.clear();
    EXPECT_EQ(steps(), (Steps{1, 1}));
    add_probe(document, {1, 1}, {2, 2});
    EXPECT_EQ(steps(), (Steps{1, 1}));
}

TEST_F(Updates, WeightsAreKeptWhereOnlyThePoseChanged) {
    const Binding* before = deformation.binding.get();
    document.probes[0].now.x += 5;
    update(deformation, document);
    EXPECT_EQ(deformation.binding.get(), before);
    document.probes[0].rest.x += 5;
    update(deformation, document);
    EXPECT_NE(deformation.binding.get(), before);
}

TEST(PoseAt, IsThePlaceAtRestAndTheTurn) {
    Document document = blank_document(320, 200, 8);
    Deformation deformation;
    update(deformation, document);
    const auto plain = pose_at(deformation, {33, 44});
    ASSERT_TRUE(plain);
    EXPECT_LT(distance(plain->rest, {33, 44}), 1e-10);  // roundings of numbers up to 320^2
    EXPECT_EQ(plain->angle, 0);
    EXPECT_FALSE(pose_at(deformation, {-1, 44}));

    add_probe(document, {100, 100}, {150, 80}, 90 * degrees);
    update(deformation, document);
    // One probe moves everything alike: (100, 100) + (x, y) goes to (150, 80) + (-y, x).
    const auto pose = pose_at(deformation, {150 - 20, 80 + 30});
    ASSERT_TRUE(pose);
    EXPECT_LT(distance(pose->rest, {130, 120}), 1e-4);  // the vertices are floats of up to 320: 3e-5
    EXPECT_NEAR(pose->angle, 90 * degrees, 1e-12);
}

TEST(PoseAt, CountsTheTurnsAsTheNeighboursDo) {
    for (const double turned : {270.0, -270.0, 350.0, -350.0, 360.0, 450.0, 720.0, 3600.0}) {
        Document document = blank_document(320, 200, 8);
        add_probe(document, {100, 100}, {100, 100}, turned * degrees);
        add_probe(document, {220, 100}, {220, 100}, turned * degrees);
        Deformation deformation;
        update(deformation, document);
        const auto pose = pose_at(deformation, deformation.now[30]);
        ASSERT_TRUE(pose);
        EXPECT_NEAR(pose->angle, turned * degrees, 1e-9) << turned;  // roundings of an angle of up to 63
    }
}

TEST(PoseAt, LiesBetweenTheNeighboursAngles) {
    expect_always("probes turned by less than a turn more or less than each other", [] {
        Document document = blank_document(320, 200, 8);
        const double base = *real(-40, 40);
        double low = 1e9, high = -1e9;
        const int count = *whole(1, 5);
        for (int i = 0; i < count; ++i) {
            const glm::dvec2 rest{*real(0, 320), *real(0, 200)};
            const double turned = base + *real(0, 3);
            add_probe(document, rest, rest, turned);
            low = std::min(low, turned), high = std::max(high, turned);
        }
        Deformation deformation;
        update(deformation, document);
        const auto pose = pose_at(deformation, deformation.now[std::size_t(*whole(0, 53))]);
        RC_ASSERT(pose.has_value());
        RC_ASSERT(pose->angle > low - 1e-9 && pose->angle < high + 1e-9);  // roundings, as above
    });
}

TEST(PoseAt, ANewProbeThereChangesNothingUnderIt) {
    expect_always("the blend at the new probe's place is its own transformation", [] {
        Document document = blank_document(320, 200, 16);
        const int count = *whole(1, 5);
        for (int i = 0; i < count; ++i) {
            const glm::dvec2 rest{*real(0, 320), *real(0, 200)};
            add_probe(document, rest, rest + glm::dvec2(*real(-9, 9), *real(-9, 9)), *real(-1, 1));
        }
        Deformation deformation;
        update(deformation, document);
        const glm::dvec2 at = deformation.now[std::size_t(*whole(0, 17 * 11 - 1))];
        const auto pose = pose_at(deformation, at);
        RC_ASSERT(pose.has_value());
        std::vector<float> weights(document.probes.size());
        inverse_distance_weights(document.probes, 2, pose->rest, weights);
        std::vector<DualComplex<double>> p;
        for (const Probe& probe : document.probes) p.push_back(motion_of(probe, {160, 100}).p);
        const auto blend = dlb<DualComplex<double>>(std::vector<double>(weights.begin(), weights.end()), p).p;
        Probe added = new_probe(document, pose->rest);
        added.now = at;
        added.angle = pose->angle;
        const auto own = motion_of(added, {160, 100}).p;
        RC_ASSERT(std::abs(own.p0 - blend.p0) < 1e-12);  // same sign: the half angle counts
        // The deformed vertices are floats (3e-5 of 320 pixels), their weights too (6e-8 of probes 320
        // apart).
        RC_ASSERT(std::abs(own.p1 - blend.p1) < 2e-4);
    });
}

}  // namespace
}  // namespace probewarp
