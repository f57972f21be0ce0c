// Triangles that are turned over are counted, and what only moves, turns, stretches or is rounded is not.
#include "model/folds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pictures.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::blank_document;
using testing::degrees;

std::size_t folds_of(const Document& document) {
    Deformation deformation;
    update(deformation, document);
    return folded_triangles(mesh_of(deformation), deformation.now);
}

TEST(Folds, AreNoneAtRest) {
    const Mesh mesh = grid_mesh(640, 480, 40);
    EXPECT_EQ(folded_triangles(mesh, mesh.rest), 0u);
}

TEST(Folds, AreAllOfAMirroredMesh) {
    const Mesh mesh = grid_mesh(640, 480, 40);
    std::vector<glm::vec2> now = mesh.rest;
    for (glm::vec2& v : now) v.x = 640 - v.x;
    EXPECT_EQ(folded_triangles(mesh, now), mesh.triangles.size() / 3);
}

TEST(Folds, AreThoseAroundAVertexThatWasPulledOver) {
    // Two by one cells of 2 x 2 pixels; the middle vertex of the upper side goes beyond the right one.
    const Mesh mesh = grid_mesh(4, 2, 2);
    std::vector<glm::vec2> now = mesh.rest;
    now[1].x = 5;
    // Of the three triangles at the vertex the one that has both right corners turns over.
    EXPECT_EQ(folded_triangles(mesh, now), 1u);
    now[1] = {2, 3};  // beyond the lower side: those of the sides that it crosses turn over
    EXPECT_EQ(folded_triangles(mesh, now), 2u);
}

TEST(Folds, AreNoneWhereATriangleHasNoArea) {
    const Mesh mesh = grid_mesh(4, 2, 2);
    std::vector<glm::vec2> now = mesh.rest;
    for (glm::vec2& v : now) v.y = 1;
    EXPECT_EQ(folded_triangles(mesh, now), 0u);
}

TEST(Folds, AreNoneOfSliversThatAreRounded) {
    // Probes a hair beside the diagonals of small cells cut slivers; turned and moved far, their height is
    // less than a float can hold there.
    Image image;
    image.width = 3000, image.height = 2001;
    std::vector<glm::dvec2> rests;
    for (int i = 0; i < 300; ++i) {
        const double cell = 3 * (5 + 3 * i), along = 0.1 + 0.002 * i;
        rests.push_back(glm::dvec2(cell, 3 * (7 + 2 * i)) + 3.0 * along + glm::dvec2(1e-3, 0));
    }
    const std::vector<std::uint8_t> all(1000 * 667, 1);
    const Mesh mesh = probe_mesh(image, 1000, all, rests);
    ASSERT_EQ(mesh.rest.size(), 1001u * 668 + 300);
    std::vector<glm::vec2> now;
    for (const glm::dvec2 v : mesh.rest)
        now.emplace_back(glm::dvec2(15000.3, -9000.7) +
                         glm::dvec2(std::cos(0.57) * v.x - std::sin(0.57) * v.y,
                                    std::sin(0.57) * v.x + std::cos(0.57) * v.y));
    EXPECT_EQ(folded_triangles(mesh, now), 0u);
}

TEST(Folds, AreWhereTwoProbesCross) {
    Document document = blank_document(600, 400, 100);
    add_probe(document, {150, 200}, {150, 200});
    add_probe(document, {450, 200}, {460, 210});
    EXPECT_EQ(folds_of(document), 0u);
    document.probes[1].now = {100, 200};
    EXPECT_GT(folds_of(document), 100u);
}

TEST(Folds, AreFoundBesideAProbeThatDidNotMove) {
    Document document = blank_document(600, 400, 100);
    document.weights.scheme = "harmonic";
    add_probe(document, {150, 200}, {150, 200});
    add_probe(document, {450, 200}, {470, 230}, 35 * degrees);
    // A handful: how many exactly is for the weights' rounding to say.
    const std::size_t folds = folds_of(document);
    EXPECT_TRUE(folds >= 4 && folds <= 16) << folds;
}

}  // namespace
}  // namespace probewarp
