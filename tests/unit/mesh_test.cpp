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

/// How many vertices are shaded by a graphics card that remembers the last `size` of them (first in, first
/// out).
std::size_t shaded_vertices(const Mesh& mesh, std::size_t size) {
    std::vector<std::uint32_t> cache;
    std::size_t shaded = 0;
    for (const std::uint32_t v : mesh.triangles) {
        if (std::find(cache.begin(), cache.end(), v) != cache.end()) continue;
        ++shaded;
        cache.push_back(v);
        if (cache.size() > size) cache.erase(cache.begin());
    }
    return shaded;
}

TEST(Mesh, AVertexIsShadedOnceForTheCellsAboveItAndOnceForThoseBelow) {
    // Row by row it cannot be less where a row does not fit into the cache; the smallest one suffices for
    // this.
    const Mesh mesh = grid_mesh(1000, 700, 100);
    EXPECT_EQ(shaded_vertices(mesh, 16), 2u * 101 * 70);
    const Mesh narrow = grid_mesh(7, 1000, 700);  // five cells across: a row fits
    EXPECT_EQ(narrow.columns, 5);
    EXPECT_EQ(shaded_vertices(narrow, 16), narrow.rest.size());
}

TEST(Mesh, WhereCellsAreLeftOutOrProbesCutThemNoVertexIsShadedMoreOftenThanThat) {
    expect_always("twice at most, but for the neighbours of probes", [] {
        Image image;
        image.width = *whole(20, 500);
        image.height = *whole(20, 500);
        const int cells = *whole(20, 100);
        const auto [columns, rows] = grid_size(image.width, image.height, cells);
        std::vector<std::uint8_t> kept(std::size_t(columns) * std::size_t(rows));
        for (auto& cell : kept) cell = std::uint8_t(*whole(0, 3) > 0);
        std::vector<glm::dvec2> rests;
        for (int i = *whole(0, 3); i > 0; --i)
            rests.emplace_back(*real(0, image.width), *real(0, image.height));
        const Mesh mesh = probe_mesh(image, cells, kept, rests);
        // A probe adds its vertex, and may push the five around it out of the cache once more.
        RC_ASSERT(shaded_vertices(mesh, 16) <= 2 * mesh.rest.size() + 6 * rests.size());
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

TEST(Mesh, HoweverItIsDeformedTheLastTriangleThatHoldsAPointIsFound) {
    expect_always("none that comes later has the point on the inner side of its three edges", [] {
        const Mesh mesh = grid_mesh(40, 30, *whole(1, 6));
        std::vector<glm::vec2> vertices;
        for (const glm::vec2 v : mesh.rest)
            vertices.push_back(v + glm::vec2(float(*real(-15, 15)), float(*real(-15, 15))));
        const glm::dvec2 p{*real(-10, 50), *real(-10, 40)};
        std::optional<std::uint32_t> last;
        for (std::uint32_t t = 0; t < mesh.triangles.size() / 3; ++t) {
            int left = 0, right = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::dvec2 from = vertices[mesh.triangles[3 * t + k]];
                const glm::dvec2 way = glm::dvec2(vertices[mesh.triangles[3 * t + (k + 1) % 3]]) - from;
                const double side = way.x * (p.y - from.y) - way.y * (p.x - from.x);
                RC_PRE(std::abs(side) > 1e-3);  // on an edge either is right
                ++(side > 0 ? left : right);
            }
            if (left == 3 || right == 3) last = t;
        }
        const auto at = locate(mesh, vertices, p);
        RC_ASSERT(at.has_value() == last.has_value());
        if (at) RC_ASSERT(at->triangle == *last);
    });
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

/// A picture whose alpha is `alpha(x, y)`.
template <class Alpha>
Image picture(int width, int height, Alpha alpha) {
    Image image;
    image.width = width;
    image.height = height;
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) rgba.insert(rgba.end(), {9, 9, 9, std::uint8_t(alpha(x, y))});
    image.rgba = std::move(rgba);
    return image;
}

using Cells = std::vector<std::uint8_t>;

TEST(VisibleCells, AreThoseWithAPixelThatIsSeen) {
    MeshSettings settings;
    settings.cells = 4;
    settings.margin = 0;
    const Image one = picture(40, 20, [](int x, int y) { return x == 10 && y == 9 ? 7 : 0; });
    EXPECT_EQ(visible_cells(one, settings), (Cells{0, 1, 0, 0, 0, 0, 0, 0}));
    settings.threshold = 6;
    EXPECT_EQ(visible_cells(one, settings), (Cells{0, 1, 0, 0, 0, 0, 0, 0}));
    settings.threshold = 7;  // nothing is visible: the whole grid
    EXPECT_EQ(visible_cells(one, settings), (Cells(8, 1)));
    settings.threshold = 0;
    settings.margin = 1;  // to the left by one pixel, and down by one
    EXPECT_EQ(visible_cells(one, settings), (Cells{1, 1, 0, 0, 1, 1, 0, 0}));
    settings.from_alpha = false;
    EXPECT_EQ(visible_cells(one, settings), (Cells(8, 1)));
    const Image opaque = picture(40, 20, [](int, int) { return 255; });
    settings.from_alpha = true;
    EXPECT_EQ(visible_cells(opaque, settings), (Cells(8, 1)));
}

TEST(VisibleCells, MissNoVisiblePixelAndKeepNoCellWithoutOne) {
    expect_always("a cell stays where a visible pixel is in it or within the margin", [] {
        const int width = *whole(1, 60), height = *whole(1, 60);
        const Image image =
            picture(width, height, [](int, int) { return *whole(0, 30) == 0 ? *whole(0, 255) : 0; });
        MeshSettings settings;
        settings.cells = *whole(1, 40);
        settings.threshold = *whole(0, 254);
        settings.margin = *whole(0, 3);
        const auto [columns, rows] = grid_size(width, height, settings.cells);
        Cells expected(std::size_t(columns) * std::size_t(rows), 0);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                if (pixel(image, x, y)[3] <= settings.threshold) continue;
                for (int r = 0; r < rows; ++r)
                    for (int c = 0; c < columns; ++c) {
                        // Open intervals: what only touches the cell is not in it.
                        const bool across = (x - settings.margin) * columns < double(width) * (c + 1) &&
                                            (x + 1 + settings.margin) * columns > double(width) * c;
                        const bool down = (y - settings.margin) * rows < double(height) * (r + 1) &&
                                          (y + 1 + settings.margin) * rows > double(height) * r;
                        if (across && down)
                            expected[std::size_t(r) * std::size_t(columns) + std::size_t(c)] = 1;
                    }
            }
        if (std::count(expected.begin(), expected.end(), 1) == 0 || !has_alpha(image))
            std::fill(expected.begin(), expected.end(), std::uint8_t{1});
        RC_ASSERT(visible_cells(image, settings) == expected);
    });
}

TEST(ProbeMesh, LeavesCellsOutAndHasNoVertexThatNothingUses) {
    const Image image = picture(40, 20, [](int, int) { return 255; });
    const Mesh mesh = probe_mesh(image, 4, Cells{1, 0, 0, 1, 0, 0, 0, 1}, {});
    EXPECT_EQ(mesh.triangles.size(), 3u * 2 * 3);
    EXPECT_EQ(mesh.rest.size(), 4u + 6);
    EXPECT_EQ(mesh.grid[2], no_vertex);
    EXPECT_EQ(mesh.rest[mesh.grid[5]], glm::vec2(0, 10));
    EXPECT_FALSE(locate_at_rest(mesh, {15, 5}));
    ASSERT_TRUE(locate_at_rest(mesh, {35, 15}));
    const Islands islands = islands_of(mesh);
    EXPECT_EQ(islands.count, 2);
    EXPECT_EQ(islands.of[mesh.grid[0]], 0);
    EXPECT_EQ(islands.of[mesh.grid[14]], 1);
    EXPECT_EQ(islands.of[mesh.grid[4]], islands.of[mesh.grid[14]]);
}

TEST(ProbeMesh, HasAVertexAtEveryProbe) {
    expect_always("the triangles tile the kept cells as before, and each rest is a vertex", [] {
        const Image image = picture(*whole(1, 50), *whole(1, 50), [](int, int) { return 255; });
        const int cells = *whole(1, 9);
        const auto [columns, rows] = grid_size(image.width, image.height, cells);
        Cells kept(std::size_t(columns) * std::size_t(rows));
        for (auto& cell : kept) cell = std::uint8_t(*whole(0, 3) > 0);
        const int probes = *whole(0, 12);
        std::vector<glm::dvec2> rests;
        for (int i = 0; i < probes; ++i) {
            rests.emplace_back(*real(-3, image.width + 3), *real(-3, image.height + 3));
            if (*whole(0, 2) == 0) rests.back().x = double(image.width) * *whole(0, columns) / columns;
            if (i > 0 && *whole(0, 4) == 0) rests.back() = rests.front();
        }
        const Mesh mesh = probe_mesh(image, cells, kept, rests);
        const Mesh plain = probe_mesh(image, cells, kept, {});
        const auto area = [](const Mesh& m) {
            double sum = 0;
            for (std::size_t i = 0; i < m.triangles.size(); i += 3) {
                const glm::dvec2 a = m.rest[m.triangles[i]], b = glm::dvec2(m.rest[m.triangles[i + 1]]) - a,
                                 c = glm::dvec2(m.rest[m.triangles[i + 2]]) - a;
                sum += b.y * c.x - b.x * c.y;
            }
            return sum;
        };
        RC_ASSERT(std::abs(area(mesh) - area(plain)) <
                  1e-2);  // vertices are floats: 4e-6 of 50 pixels, 50 long
        RC_ASSERT(mesh.first_triangle.size() == kept.size() + 1);
        for (std::size_t i = 0; i < rests.size(); ++i) {
            const bool inside = plain.triangles.empty() ? false : bool(locate_at_rest(plain, rests[i]));
            RC_ASSERT((mesh.anchors[i] != no_vertex) == inside);
            if (!inside) continue;
            // A ten-thousandth of a cell's corner, at most 50 pixels wide.
            RC_ASSERT(distance(mesh.rest[mesh.anchors[i]], rests[i]) <
                      0.01 * image.width + 0.01 * image.height);
            const auto at = locate_at_rest(mesh, rests[i]);
            RC_ASSERT(at.has_value());
            double own = 0;
            for (int k = 0; k < 3; ++k)
                if (at->corners[std::size_t(k)] == mesh.anchors[i]) own += at->barycentric[k];
            RC_ASSERT(own > 0.999);
        }
        for (const std::uint32_t v : mesh.triangles) RC_ASSERT(v < mesh.rest.size());
    });
}

}  // namespace
}  // namespace probewarp
