// Which triangles a view gets: all that show in it, and larger ones only where nobody sees it.
#include "render/mesh_detail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "model/deformation.h"
#include "model/paint.h"
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

/// Where a place of the picture at rest, in cells of the grid, is on a detail's triangles.
glm::dvec2 on_detail(const Mesh& mesh, const MeshDetail& detail, std::span<const glm::vec2> now,
                     glm::dvec2 at) {
    const auto cell = [&](double along, int cells) {
        return std::clamp(int(along / detail.stride), 0, (cells + detail.stride - 1) / detail.stride - 1);
    };
    const std::size_t first = detail.first[std::size_t(cell(at.y, mesh.rows)) * std::size_t(detail.columns) +
                                           std::size_t(cell(at.x, mesh.columns))];
    glm::dvec2 found(0);
    double nearest = -1e9;
    for (std::size_t t = first; t < first + 2; ++t) {
        const auto corner = [&](std::size_t k) { return triangles_of(mesh, detail)[3 * t + k]; };
        const glm::dvec2 a(mesh.rest[corner(0)]),
            u = glm::dvec2(mesh.rest[corner(1)]) - a, v = glm::dvec2(mesh.rest[corner(2)]) - a,
            p = at * mesh.size / glm::dvec2(mesh.columns, mesh.rows) - a;
        const double area = u.x * v.y - u.y * v.x;
        const double s1 = (p.x * v.y - p.y * v.x) / area, s2 = (u.x * p.y - u.y * p.x) / area;
        if (const double least = std::min({s1, s2, 1 - s1 - s2}); least > nearest) {
            nearest = least;
            found = glm::dvec2(now[corner(0)]) * (1 - s1 - s2) + glm::dvec2(now[corner(1)]) * s1 +
                    glm::dvec2(now[corner(2)]) * s2;
        }
    }
    return found;
}

TEST(MeshDetail, ErrorsAreNoLessThanTheyAre) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> off(-3, 3);
    for (const auto& [width, height, cells] : {std::array{300, 200, 100}, std::array{330, 30, 110}}) {
        Deformation deformation;
        update(deformation, pulled_mesh(width, height, cells));
        const Mesh& mesh = mesh_of(deformation);
        std::vector<glm::vec2> rough = deformation.now;
        for (glm::vec2& v : rough) v += glm::vec2(off(random), off(random));
        std::vector<glm::vec2> own = mesh.rest;  // the probes' own vertices alone, and far
        for (std::size_t v = mesh.grid.size(); v < own.size(); ++v) {
            own[v] += glm::vec2(4, 20);
            rough[v] += glm::vec2(4, 40);
        }
        for (const auto& now : {mesh.rest, deformation.now, rough, own}) {
            const auto errors = stride_errors(mesh, now);
            const std::size_t blocks_across = std::size_t((mesh.columns + block_cells - 1) / block_cells);
            for (std::size_t i = 0; i < StrideErrors().size(); ++i) {
                const MeshDetail detail = detail_of(mesh, 1 << i);
                double largest = 0, allowed = 0;
                for (const StrideErrors& block : errors) allowed = std::max(allowed, double(block[i]));
                for (std::size_t v = 0; i > 0 && v < mesh.rest.size(); ++v) {
                    const glm::dvec2 at =
                        glm::dvec2(mesh.rest[v]) / mesh.size * glm::dvec2(mesh.columns, mesh.rows);
                    const double error = glm::distance(glm::dvec2(now[v]), on_detail(mesh, detail, now, at));
                    largest = std::max(largest, error);
                    const std::size_t block =
                        std::size_t(std::min(at.y, mesh.rows - 0.5)) / block_cells * blocks_across +
                        std::size_t(std::min(at.x, mesh.columns - 0.5)) / block_cells;
                    ASSERT_LE(error, double(errors[block][i]) + 1e-3) << v << " at stride " << (1 << i);
                }
                // Each stride adds its own to those before it.
                EXPECT_LE(allowed, (now == own ? 1 : 6) * largest + 1e-3) << "nor much more";
            }
        }
    }
}

TEST(MeshDetail, IsAsFineAsTheScreen) {
    const Mesh mesh = grid_mesh(1000, 500, 500);  // of 2 pixels
    const auto stride = [&](double scale, std::span<const glm::vec2> now, double left = 0) {
        const View view{{left, 0}, glm::dvec2(scale), 1000, 500};
        const int found = stride_for(mesh, blocks_of(mesh, now), stride_errors(mesh, now), view, 4);
        EXPECT_EQ(may_be_coarser(mesh, view, 4), scale < 1);
        return found;
    };
    EXPECT_EQ(stride(1.01, mesh.rest), 1);
    EXPECT_EQ(stride(0.99, mesh.rest), 2);
    EXPECT_EQ(stride(0.49, mesh.rest), 4);
    EXPECT_EQ(stride(0.001, mesh.rest), block_cells);
    std::vector<glm::vec2> uneven = mesh.rest;
    uneven[501 * 7 + 11].y += 0.5f;
    EXPECT_EQ(stride(0.99, uneven), 1);
    EXPECT_EQ(stride(0.49, uneven), 4) << "a quarter of a pixel";
    EXPECT_EQ(stride(0.99, uneven, 200), 2) << "it does not show";
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

/// A disc in which the first probe alone is followed, with a hard edge.
PaintPtr disc(int width, int height) {
    PaintMap map = new_paint_map(width, height);
    const double middle = map.width * 0.5, radius = map.width * 0.2;
    edit_texels(map, 0, 0, map.width, map.height, [&](int x, int y, Paint) {
        return Paint{std::hypot(x - middle, y - map.height * 0.5) < radius ? 1.0f : 0.0f, 1};
    });
    return std::make_shared<const PaintMap>(std::move(map));
}

/// Returns how many times as many triangles the mesh has as were drawn.
double expect_that_nobody_sees(const Document& document) {
    Scene scene(document);
    const auto drawn = [&](Fineness fineness) {
        const View view = scene.whole(0.5);
        Image image = scene.blank(view);
        scene.renderer.draw(view, 1, false, 0, fineness);
        scene.renderer.read_back(image, 0, 0, view, 1, {});
        return image;
    };
    const Image all = drawn(Fineness::all);
    const std::size_t triangles = scene.renderer.drawn();
    const Image seen = drawn(Fineness::seen);
    std::size_t off = 0, far = 0;
    for (int y = 0; y < all.height; ++y)
        for (int x = 0; x < all.width; ++x) {
            const auto a = pixel(all, x, y), b = pixel(seen, x, y);
            int largest = 0;
            for (std::size_t c = 0; c < 4; ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
            off += largest > 1;
            far += largest > 8;
        }
    // A quarter of a pixel is a step or two of this picture; at its edges, and where it folds, a pixel here
    // and there is another one.
    EXPECT_LE(off, std::size_t(all.width * all.height) / 2000);
    EXPECT_LE(far, std::size_t(all.width * all.height) / 10000);
    return double(triangles) / double(scene.renderer.drawn());
}

TEST(MeshDetail, NobodySeesTheLargerTriangles) {
    const auto context = open_context("osmesa");
    Document document = pulled(soft(1200, 900), 0.1);
    document.mesh.cells = 600;
    document.probes[0].now = document.probes[0].rest + glm::dvec2(30, 12);
    EXPECT_GT(expect_that_nobody_sees(document), 3);
    Document painted = document;
    painted.probes[0].paint = disc(1200, 900);
    expect_that_nobody_sees(painted);
    Document close = document;
    close.probes.push_back(new_probe(close, close.probes[0].rest + glm::dvec2(5, 3)));
    expect_that_nobody_sees(close);
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
