// Which triangles a view gets: all that show in it, and larger ones only where nobody sees it.
#include "render/mesh_detail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "model/deformation.h"
#include "render/context.h"
#include "scene.h"

namespace probewarp {
namespace {

/// A mesh of so many cells under two probes, pulled, one of them in the middle of a cell beside a block's
/// edge.
Document pulled_mesh(int width, int height, int cells) {
    Document document = pulled(noise<std::uint8_t>(width, height), 0.4);
    document.mesh.cells = cells;
    const double cell = double(std::max(width, height)) / cells;
    Probe own = new_probe(document, {cell * block_cells, cell * 2.5});
    own.now += glm::dvec2(-width / 3.0, height / 2.0);
    document.probes.push_back(own);
    return document;
}

bool may_show(std::span<const glm::vec2> now, std::span<const std::uint32_t> corners, const View& view) {
    glm::vec2 least = now[corners[0]], most = least;
    for (const std::uint32_t v : corners.first(3)) {
        least = {std::min(least.x, now[v].x), std::min(least.y, now[v].y)};
        most = {std::max(most.x, now[v].x), std::max(most.y, now[v].y)};
    }
    const glm::dvec2 end = view.origin + glm::dvec2(view.width, view.height) / view.scale;
    return least.x < end.x && most.x > view.origin.x && least.y < end.y && most.y > view.origin.y;
}

/// Returns how often a triangle was left out.
std::size_t expect_all_that_show(const Mesh& mesh, std::span<const glm::vec2> now, int stride,
                                 std::mt19937& random) {
    const MeshBlocks blocks = blocks_of(mesh, now);
    const MeshDetail detail = detail_of(mesh, stride);
    const auto all = triangles_of(mesh, detail);
    const std::size_t triangles = all.size() / 3;
    std::size_t left_out = 0;
    for (int i = 0; i < 20; ++i) {
        const auto within = [&](double size) {
            return std::uniform_real_distribution<double>(-0.2 * size, size)(random);
        };
        const View view{{within(mesh.size.x), within(mesh.size.y)}, glm::dvec2(4), 200, 150};
        std::vector<bool> drawn(triangles);
        std::size_t next = 0;
        for (const TriangleRun run : visible_runs(detail, blocks, view)) {
            EXPECT_GE(run.first, next) << "in their order, each once";
            EXPECT_GT(run.count, 0u);
            next = run.first + run.count;
            std::fill_n(drawn.begin() + std::ptrdiff_t(run.first), run.count, true);
        }
        EXPECT_LE(next, triangles);
        std::size_t missing = 0;
        for (std::size_t t = 0; t < triangles; ++t) {
            const auto corners = all.subspan(3 * t, 3);
            missing += !drawn[t] && may_show(now, corners, view);
            left_out += !drawn[t];
        }
        EXPECT_EQ(missing, 0u);
    }
    return left_out;
}

TEST(MeshDetail, VisibleRunsHaveEveryTriangleThatMayShow) {
    std::mt19937 random(3);
    for (const auto& [width, height, cells] : {std::array{300, 200, 100}, std::array{200, 300, 75},
                                               std::array{640, 64, 320}, std::array{50, 50, 5}}) {
        Deformation deformation;
        update(deformation, pulled_mesh(width, height, cells));
        const Mesh& mesh = mesh_of(deformation);
        // The probes' own vertices far from all others.
        std::vector<glm::vec2> torn = mesh.rest;
        for (std::size_t v = mesh.grid.size(); v < torn.size(); ++v)
            torn[v] = {float(width) - torn[v].x, float(height) - torn[v].y};
        std::size_t left_out = 0;
        for (const int stride : {1, 2, 8, 32}) {
            left_out += expect_all_that_show(mesh, deformation.now, stride, random);
            left_out += expect_all_that_show(mesh, torn, stride, random);
        }
        EXPECT_TRUE(left_out > 0 || cells < block_cells);
    }
}

TEST(MeshDetail, CoarserTrianglesLieOverTheSamePicture) {
    Deformation deformation;
    update(deformation, pulled_mesh(330, 170, 66));
    const Mesh& mesh = mesh_of(deformation);
    EXPECT_EQ(triangles_of(mesh, detail_of(mesh, 1)).data(), mesh.triangles.data());
    for (const int stride : {2, 4, 8, 16, 32}) {
        const MeshDetail detail = detail_of(mesh, stride);
        EXPECT_EQ(detail.first.size(), std::size_t(detail.columns * detail.rows) + 1);
        EXPECT_EQ(detail.first.back() * 3, detail.triangles.size());
        double area = 0;
        for (std::size_t i = 0; i < detail.triangles.size(); i += 3) {
            const auto at = [&](std::size_t k) { return glm::dvec2(mesh.rest[detail.triangles[i + k]]); };
            const glm::dvec2 a = at(1) - at(0), b = at(2) - at(0);
            const double own = (b.x * a.y - b.y * a.x) / 2;
            EXPECT_GT(own, 0) << "turned as the mesh's own";
            area += own;
        }
        EXPECT_NEAR(area, 330 * 170, 1e-6 * 330 * 170);
    }
}

TEST(MeshDetail, IsAsFineAsTheScreen) {
    Document document = pulled(noise<std::uint8_t>(1000, 500), 0.1);
    document.mesh.cells = 500;  // of 2 pixels
    Deformation deformation;
    update(deformation, document);
    const Mesh& mesh = mesh_of(deformation);
    const auto stride = [&](double scale, const MeshBlocks* blocks = nullptr) {
        return stride_for(mesh, blocks, {{}, glm::dvec2(scale), 1000, 500});
    };
    EXPECT_EQ(stride(2), 1);
    EXPECT_EQ(stride(1.01), 1);
    EXPECT_EQ(stride(0.99), 2);
    EXPECT_EQ(stride(0.49), 4);
    EXPECT_EQ(stride(0.001), block_cells);
    const MeshBlocks blocks = blocks_of(mesh, deformation.now);
    EXPECT_EQ(stride(0.9, &blocks), 2);
    std::vector<glm::vec2> stretched = mesh.rest;
    for (glm::vec2& v : stretched) v.x *= 4;
    const MeshBlocks wide = blocks_of(mesh, stretched);
    EXPECT_EQ(stride(0.7, &wide), 1) << "5.6 pixels a cell";
    EXPECT_EQ(stride(0.6, &wide), 2);
}

/// Nothing in it is smaller than some hundred pixels.
PicturePtr soft(int width, int height) {
    Picture picture;
    picture.image.width = width;
    picture.image.height = height;
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const double value : {std::sin(x / 60.0), std::cos(y / 50.0), std::sin((x + y) / 70.0), 1.0})
                rgba.push_back(std::uint8_t(std::lround(127.5 + 127.5 * value)));
    picture.image.rgba = std::move(rgba);
    return std::make_shared<const Picture>(std::move(picture));
}

TEST(MeshDetail, NobodySeesTheLargerTriangles) {
    const auto context = open_context("osmesa");
    Document document = pulled(soft(1200, 900), 0.3);
    document.mesh.cells = 600;
    Scene scene(document);
    const auto drawn = [&](Fineness fineness) {
        const View view = scene.whole(0.5);
        Image image = scene.blank(view);
        scene.renderer.draw(view, 1, false, 0, fineness);
        scene.renderer.read_back(image, 0, 0, view, 1, Colour{255, 255, 255});
        return image;
    };
    const Image all = drawn(Fineness::all);
    const std::size_t triangles = scene.renderer.drawn();
    const Image seen = drawn(Fineness::seen);
    EXPECT_GT(triangles, 500'000u);
    EXPECT_LT(scene.renderer.drawn() * 3, triangles);
    std::size_t off = 0;
    const auto &a = std::get<0>(all.rgba), &b = std::get<0>(seen.rgba);
    for (std::size_t i = 0; i < a.size(); ++i) {
        off += std::abs(a[i] - b[i]) > 1;
    }
    EXPECT_LT(off, a.size() / 1000) << "more than a step apart";
    EXPECT_NE(all.rgba, seen.rgba) << "or the test sees nothing";
}

TEST(MeshDetail, CellsThatAreLeftOutStayOut) {
    const auto context = open_context("osmesa");
    Document document = pulled(translucent<std::uint8_t>(300, 200), 0.3);
    auto picture = std::make_shared<Picture>(*document.picture);
    auto& rgba = std::get<0>(picture->image.rgba);
    for (std::size_t y = 0; y < 60; ++y)  // clear at the top left
        for (std::size_t x = 0; x < 90; ++x) rgba[(y * 300 + x) * 4 + 3] = 0;
    document.picture = picture;
    document.mesh.cells = 300;
    document.mesh.margin = 0;
    Scene scene(document);
    ASSERT_FALSE(is_whole(mesh_of(scene.deformation)));
    scene.renderer.draw(scene.whole(0.5), 1, false, 0, Fineness::seen);
    EXPECT_GT(scene.renderer.drawn() * 10, mesh_of(scene.deformation).triangles.size() / 3 * 9)
        << "but those that have left the frame";
}

}  // namespace
}  // namespace probewarp
