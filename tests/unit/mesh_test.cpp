// The grid mesh: its numbers of cells, its cut, and that every point of the picture is found in it.
#include "model/mesh.h"

#include "generators.h"

namespace probewarp {
namespace {

using testing::expect_always;
using testing::real;
using testing::whole;

using Size = std::array<int, 2>;

TEST(Mesh, HasTheCellsAlongTheLongerSide) {
    EXPECT_EQ(grid_size(300, 200, 100), (Size{100, 67}));  // 66.7
    EXPECT_EQ(grid_size(200, 300, 100), (Size{67, 100}));
    EXPECT_EQ(grid_size(512, 512, 100), (Size{100, 100}));
    EXPECT_EQ(grid_size(1000, 24, 100), (Size{100, 2}));  // 2.4
    EXPECT_EQ(grid_size(1000, 25, 100), (Size{100, 3}));  // 2.5
    EXPECT_EQ(grid_size(32768, 1, 100), (Size{100, 1}));  // never none
    EXPECT_EQ(grid_size(1, 32768, 1000), (Size{1, 1000}));
    EXPECT_EQ(grid_size(7, 5, 1), (Size{1, 1}));
}

Mesh any_mesh() { return grid_mesh(*whole(1, 8192), *whole(1, 8192), *whole(1, 30)); }

TEST(Mesh, RunsRowByRowFromTheTopLeftCornerToTheBottomRight) {
    const Mesh mesh = grid_mesh(40, 20, 4);
    EXPECT_EQ(mesh.columns, 4);
    EXPECT_EQ(mesh.rows, 2);
    ASSERT_EQ(mesh.rest.size(), 15u);
    EXPECT_EQ(mesh.rest[0], glm::vec2(0, 0));
    EXPECT_EQ(mesh.rest[1], glm::vec2(10, 0));
    EXPECT_EQ(mesh.rest[5], glm::vec2(0, 10));
    EXPECT_EQ(mesh.rest[14], glm::vec2(40, 20));
    expect_always("the corners are the picture's", [] {
        const int width = *whole(1, 32768), height = *whole(1, 32768);
        const Mesh any = grid_mesh(width, height, *whole(1, 30));
        RC_ASSERT(any.rest.size() == std::size_t(any.columns + 1) * std::size_t(any.rows + 1));
        RC_ASSERT(any.rest.front() == glm::vec2(0, 0));
        RC_ASSERT(any.rest[std::size_t(any.columns)] == glm::vec2(width, 0));
        RC_ASSERT(any.rest.back() == glm::vec2(width, height));
    });
}

TEST(Mesh, IsCutFromTopLeftToBottomRightAndTurnsOneWay) {
    expect_always("every cell", [] {
        const Mesh mesh = any_mesh();
        RC_ASSERT(mesh.triangles.size() == std::size_t(mesh.columns) * std::size_t(mesh.rows) * 6);
        for (std::size_t cell = 0; cell < mesh.triangles.size() / 6; ++cell) {
            const auto row = cell / std::size_t(mesh.columns), column = cell % std::size_t(mesh.columns);
            const auto top_left = std::uint32_t(row * std::size_t(mesh.columns + 1) + column);
            const auto bottom_right = std::uint32_t(top_left + std::uint32_t(mesh.columns) + 2);
            for (std::size_t t = 6 * cell; t < 6 * cell + 6; t += 3) {
                const auto* corners = mesh.triangles.data() + t;
                RC_ASSERT(std::count(corners, corners + 3, top_left) == 1);
                RC_ASSERT(std::count(corners, corners + 3, bottom_right) == 1);
                const glm::vec2 a = mesh.rest[corners[0]], b = mesh.rest[corners[1]] - a,
                                c = mesh.rest[corners[2]] - a;
                RC_ASSERT(b.x * c.y - b.y * c.x < 0);  // anticlockwise as seen, y down
            }
        }
    });
}

double distance(glm::dvec2 a, glm::dvec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(Mesh, EveryPointOfThePictureIsFoundWhereItIs) {
    expect_always("rest_point(locate(p)) = p", [] {
        const Mesh mesh = any_mesh();
        const glm::dvec2 size = mesh.rest.back();
        // Anywhere, or on the grid's own lines and corners, where rounding might let a point fall through.
        glm::dvec2 p{*real(0, size.x), *real(0, size.y)};
        if (*whole(0, 1)) p.x = double(mesh.rest[std::size_t(*whole(0, mesh.columns))].x);
        if (*whole(0, 1)) p.y = double(mesh.rest[std::size_t(*whole(0, mesh.rows) * (mesh.columns + 1))].y);
        const auto at = locate(mesh, mesh.rest, p);
        RC_ASSERT(at.has_value());
        RC_ASSERT(std::abs(at->barycentric.x + at->barycentric.y + at->barycentric.z - 1) < 1e-15);
        // The areas of cells up to 8192 x 8192 pixels, thinnest 1 pixel, cancel by as much: 1e-16 * 8192^2.
        RC_ASSERT(distance(rest_point(mesh, *at), p) < 1e-8);
    });
}

TEST(Mesh, NothingIsFoundBesideThePicture) {
    const Mesh mesh = grid_mesh(40, 20, 4);
    for (const glm::dvec2 p : {glm::dvec2{-0.001, 10}, {40.001, 10}, {20, -0.001}, {20, 20.001}, {1e9, 1e9}})
        EXPECT_FALSE(locate(mesh, mesh.rest, p)) << p.x << " " << p.y;
}

TEST(Mesh, WhereItFoldsTheLastDrawnIsFound) {
    // Two cells of 10 x 10; the right one is folded back over the left one.
    const Mesh mesh = grid_mesh(20, 10, 2);
    std::vector<glm::vec2> folded = mesh.rest;
    folded[2].x = folded[5].x = 0;
    const auto at = locate(mesh, folded, {4, 5});
    ASSERT_TRUE(at);
    // 4 pixels from the left is 6 pixels into the folded cell; exact in floats but for the division.
    EXPECT_LT(distance(rest_point(mesh, *at), {16, 5}), 1e-12);
}

TEST(Mesh, CellsWithoutAreaAreNotFound) {
    const Mesh mesh = grid_mesh(20, 10, 2);
    std::vector<glm::vec2> flat = mesh.rest;
    for (std::size_t v : {std::size_t(2), std::size_t(5)})
        flat[v] = flat[v - 1];  // the right cell is a line now
    const auto at = locate(mesh, flat, {10, 5});
    ASSERT_TRUE(at);
    EXPECT_LT(distance(rest_point(mesh, *at), {10, 5}), 1e-12);  // as above
    std::fill(flat.begin(), flat.end(), glm::vec2(3, 3));
    EXPECT_FALSE(locate(mesh, flat, {3, 3}));
}

}  // namespace
}  // namespace probewarp
