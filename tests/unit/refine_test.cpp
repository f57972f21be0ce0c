// From automatic weights to those that deform: paint at the vertices, limits, rigid regions, and that only
// what changed is computed anew.
#include "model/refine.h"

#include "generators.h"
#include "model/deformation.h"
#include "pictures.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::blank_document;
using testing::expect_always;
using testing::real;
using testing::whole;

/// 320 x 200 in 16 x 10 cells of 20 pixels, three probes.
Document three_probes() {
    Document document = blank_document(320, 200, 16);
    add_probe(document, {40, 100}, {60, 90}, 0.5);
    add_probe(document, {160, 60}, {160, 60});
    add_probe(document, {280, 140}, {270, 150}, -0.4);
    return document;
}

PaintPtr painted(const Document& document, int left, int top, int right, int bottom, Paint paint) {
    const Image& image = document.picture->image;
    PaintMap map = new_paint_map(image.width, image.height);
    edit_texels(map, left, top, right, bottom, [paint](int, int, Paint) { return paint; });
    return std::make_shared<const PaintMap>(std::move(map));
}

std::span<const float> row_of(const Deformation& deformation, std::size_t vertex) {
    const std::size_t probes = deformation.source.probes.size();
    return weights_of(deformation).subspan(vertex * probes, probes);
}

TEST(Refine, WithoutPaintNothingIsCopied) {
    Deformation deformation;
    update(deformation, three_probes());
    EXPECT_FALSE(deformation.refined);
    EXPECT_EQ(weights_of(deformation).data(), deformation.binding->automatic.data());
}

TEST(Refine, FullyCoveredVerticesHaveExactlyThePaintedShare) {
    Document document = three_probes();
    document.probes[1].paint = painted(document, 100, 0, 200, 100, {0.25f, 1});  // texels are pixels here
    Deformation deformation;
    update(deformation, document);
    const Mesh& mesh = mesh_of(deformation);
    int inside = 0;
    for (std::size_t v = 0; v < mesh.rest.size(); ++v) {
        const glm::vec2 at = mesh.rest[v];
        const auto row = row_of(deformation, v);
        if (at.x > 101 && at.x < 199 && at.y < 99) {
            ++inside;
            EXPECT_EQ(row[1], std::round(0.25f * 65535) / 65535.0f) << at.x << " " << at.y;
            EXPECT_NEAR(row[0] + row[1] + row[2], 1, 1e-6);  // three floats
        } else if (at.x < 99 || at.x > 201 || at.y > 101) {
            for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(row[i], deformation.binding->automatic[v * 3 + i]);
        }
    }
    EXPECT_EQ(inside, 4 * 5);  // 120, 140, 160, 180 by 0 to 80; the probe's own is one of them
}

TEST(Refine, OnlyTheHeaviestProbesStayAtEachVertex) {
    Document document = three_probes();
    document.weights.most = 2;
    Deformation deformation;
    update(deformation, document);
    for (std::size_t v = 0; v < deformation.now.size(); ++v) {
        const auto row = row_of(deformation, v);
        EXPECT_LE(std::count_if(row.begin(), row.end(), [](float w) { return w > 0; }), 2);
    }
    document.weights.most = 3;
    update(deformation, document);
    EXPECT_FALSE(deformation.refined);
}

TEST(Refine, PaintingGivesWhatComputingAnewGives) {
    expect_always("after any strokes, undone and redone", [] {
        Document document = three_probes();
        document.weights.most = *whole(0, 3);
        Deformation deformation;
        update(deformation, document);
        std::vector<Document> steps{document};
        for (int i = 0; i < 6; ++i) {
            if (*whole(0, 3) == 0) {
                document = steps[std::size_t(*whole(0, int(steps.size()) - 1))];  // undo or redo
            } else {
                Probe& probe = document.probes[std::size_t(*whole(0, 2))];
                const int x = *whole(-20, 320), y = *whole(-20, 200);
                PaintMap map = probe.paint ? *probe.paint : new_paint_map(320, 200);
                const Paint paint{float(*real(0, 1)), float(*real(0, 1))};
                edit_texels(map, x, y, x + *whole(1, 90), y + *whole(1, 90),
                            [paint](int, int, Paint) { return paint; });
                probe.paint = is_blank(map) ? nullptr : std::make_shared<const PaintMap>(std::move(map));
                if (*whole(0, 3) == 0) document.probes[0].now.x += 3;
                if (*whole(0, 9) == 0) document.probes[2].locked = !document.probes[2].locked;
                steps.push_back(document);
            }
            update(deformation, document);
            Deformation anew;
            update(anew, document);
            RC_ASSERT(std::ranges::equal(weights_of(deformation), weights_of(anew)));
            RC_ASSERT(deformation.now == anew.now);
            RC_ASSERT(deformation.cancelled == anew.cancelled);
            for (const float w : weights_of(deformation)) RC_ASSERT(w >= 0 && w <= 1.000001f);
            for (std::size_t v = 0; v < deformation.now.size(); ++v) {
                const auto row = row_of(deformation, v);
                const auto automatic = std::span(deformation.binding->automatic).subspan(3 * v, 3);
                // Where nothing is painted they count up to a factor; the limit comes last and only drops
                // some.
                if (document.weights.most > 0 || std::equal(row.begin(), row.end(), automatic.begin()))
                    continue;
                RC_ASSERT(std::abs(row[0] + row[1] + row[2] - 1) < 1e-6f);  // three floats
            }
        }
    });
}

TEST(Refine, OnlyVerticesUnderChangedTilesAreComputed) {
    const Document before = three_probes();
    Document after = before;
    after.probes[1].paint = painted(before, 70, 5, 100, 20, {1, 1});  // one tile: 64 to 128, 0 to 64
    Deformation deformation;
    update(deformation, before);
    const auto runs = repainted(before, after, mesh_of(deformation));
    std::vector<int> hit(deformation.now.size(), 0);
    for (const VertexRun run : runs)
        for (std::size_t v = run.first; v < run.first + run.count; ++v) ++hit.at(v);
    for (std::size_t v = 0; v < hit.size() - 3; ++v) {  // the last three are the probes'
        const glm::vec2 at = mesh_of(deformation).rest[v];
        EXPECT_LE(hit[v], 1);
        if (at.x >= 63 && at.x <= 129 && at.y <= 65) {
            EXPECT_EQ(hit[v], 1) << at.x << " " << at.y;
        }
        if (at.x < 40 || at.x > 150 || at.y > 85) {
            EXPECT_EQ(hit[v], 0) << at.x << " " << at.y;
        }
    }
    EXPECT_TRUE(repainted(after, after, mesh_of(deformation)).empty());
}

TEST(Stiffen, ARegionMovesAsOne) {
    Document document = three_probes();
    document.stiffness = painted(document, 90, 30, 170, 130, {1, 1});
    Deformation deformation;
    update(deformation, document);
    const Mesh& mesh = mesh_of(deformation);
    std::vector<std::size_t> inside;
    for (std::size_t v = 0; v < mesh.rest.size(); ++v) {
        const glm::vec2 at = mesh.rest[v];
        if (at.x > 91 && at.x < 169 && at.y > 31 && at.y < 129) inside.push_back(v);
    }
    ASSERT_GT(inside.size(), 15u);
    for (const std::size_t v : inside)
        for (const std::size_t w : inside) {
            const auto length = [](glm::vec2 d) { return std::hypot(d.x, d.y); };
            // Rigid: every distance stays; the vertices are floats of up to 320 (3e-5).
            EXPECT_NEAR(length(deformation.now[v] - deformation.now[w]), length(mesh.rest[v] - mesh.rest[w]),
                        2e-4);
        }
    // Elsewhere nothing changed.
    EXPECT_EQ(row_of(deformation, 0)[0], deformation.binding->automatic[0]);
}

TEST(Stiffen, TakesTheMeanOfSharesWeightedByStiffness) {
    const Mesh mesh = grid_mesh(30, 10, 3);  // 4 x 2 vertices
    // Two probes; the upper row 0, 1, 2, 3.
    std::vector<float> weights{1, 0, 0, 2, 3, 1, 1, 1, 1, 0, 1, 0, 1, 0, 0, 1};
    const std::vector<float> stiffness{1, 0.5f, 0, 0, 0, 0, 0, 0.75f};
    const std::vector<float> before = weights;
    stiffen(mesh, stiffness, 2, weights);
    // Vertices 0 and 1 are one region: (1 * (1, 0) + 0.5 * (0, 1)) / 1.5.
    EXPECT_FLOAT_EQ(weights[0], 2.0f / 3);
    EXPECT_FLOAT_EQ(weights[1], 1.0f / 3);
    EXPECT_FLOAT_EQ(weights[2], 0.5f * 2 / 3);
    EXPECT_FLOAT_EQ(weights[3], 0.5f + 0.5f / 3);
    // Vertex 7 is another, alone: its own mean.
    EXPECT_FLOAT_EQ(weights[14], 0);
    EXPECT_FLOAT_EQ(weights[15], 1);
    for (const std::size_t v : {2u, 3u, 4u, 5u, 6u})
        EXPECT_TRUE(weights[2 * v] == before[2 * v] && weights[2 * v + 1] == before[2 * v + 1]) << v;
}

TEST(Stiffen, TwoCoresThatTouchSoftlyStayTwo) {
    const Mesh mesh = grid_mesh(50, 10, 5);  // 6 x 2 vertices
    std::vector<float> weights;
    for (int v = 0; v < 12; ++v)
        weights.insert(weights.end(), {v % 6 < 3 ? 1.0f : 0.0f, v % 6 < 3 ? 0.0f : 1.0f});
    const std::vector<float> stiffness{1, 1, 0.2f, 0.2f, 1, 1, 1, 1, 0.2f, 0.2f, 1, 1};
    stiffen(mesh, stiffness, 2, weights);
    EXPECT_FLOAT_EQ(weights[0], 1);  // not mixed with the other core
    EXPECT_FLOAT_EQ(weights[2 * 5], 0);
}

TEST(ReplacePicture, KeepsThePaintWhereItIs) {
    Document document = three_probes();
    document.probes[0].paint = painted(document, 0, 0, 320, 200, {0.5f, 1});
    const PaintPtr paint = document.probes[0].paint;
    replace_picture(document, testing::blank_picture(640, 200));
    EXPECT_EQ(document.probes[0].paint, paint);
    const PictureFrame frame = frame_of(document.picture->image);
    // The old picture's middle is the new one's, and its width the new one's: 640 wide, 400 high about (320,
    // 100).
    EXPECT_EQ(to_picture(*paint, frame, {160, 100}), glm::dvec2(320, 100));
    EXPECT_EQ(to_picture(*paint, frame, {0, 0}), glm::dvec2(0, -100));
    Deformation deformation;
    update(deformation, document);
    EXPECT_NEAR(row_of(deformation, 0)[0], 0.5f, 1e-5);  // 1/65535
}

}  // namespace
}  // namespace probewarp
