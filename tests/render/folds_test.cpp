// The window's renderer marks the triangles that are folded, and no other place.
#include "model/folds.h"

#include <gtest/gtest.h>

#include "render/context.h"
#include "scene.h"

namespace probewarp {
namespace {

using Shot = std::vector<std::array<std::uint8_t, 4>>;

/// What the window would show, row after row from the top.
Shot shown(Scene& scene, const View& view, const ShownMesh& mesh) {
    scene.renderer.draw(view, 1, false, 0, Fineness::seen);
    const GLuint texture = scene.renderer.display(view, {}, 12, mesh);
    Shot shot(std::size_t(view.width) * std::size_t(view.height));
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, shot.data());
    return shot;
}

/// Whether the point lies well inside a folded triangle, or well outside of all of them.
enum class Place { folded, sound, beside };
Place place_of(const Scene& scene, glm::dvec2 point) {
    const Mesh& mesh = mesh_of(scene.deformation);
    Place place = Place::sound;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
        std::array<glm::dvec2, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = glm::dvec2(scene.deformation.now[mesh.triangles[i + k]]);
        const auto side =
            [&](std::size_t k) {  // twice the area beside it; positive inside where it is folded
                const glm::dvec2 p = corners[(k + 1) % 3] - corners[k], q = point - corners[k];
                return (p.x * q.y - p.y * q.x) / glm::length(p);
            };
        const double inside = std::min({side(0), side(1), side(2)});
        if (inside > 0.05) return Place::folded;
        if (inside > -0.05) place = Place::beside;
    }
    return place;
}

TEST(Folds, AreMarkedWhereTheyLie) {
    const auto context = open_context("osmesa");
    Document document;
    document.picture = noise<std::uint8_t>(120, 80);
    document.mesh.cells = 30;
    document.probes.push_back(new_probe(document, {30, 40}));
    document.probes.push_back(new_probe(document, {70, 40}));
    document.probes[1].now = {22, 44};
    Scene scene(document);
    ASSERT_GT(folded_triangles(mesh_of(scene.deformation), scene.deformation.now), 20u);
    const View view = scene.whole(2);
    const Shot plain = shown(scene, view, {}), marked = shown(scene, view, {false, 7});
    std::size_t folded = 0, white = 0, dark = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const std::size_t at = std::size_t(y) * std::size_t(view.width) + std::size_t(x);
            const Place place = place_of(scene, (glm::dvec2(x, y) + 0.5) / view.scale);
            if (place == Place::sound) {
                ASSERT_EQ(marked[at], plain[at]) << x << " " << y;
            }
            if (place != Place::folded) continue;
            const auto [r, g, b, a] = marked[at];
            ASSERT_LT(std::max({r, g, b}) - std::min({r, g, b}), 8) << "no grey at " << x << " " << y;
            ++folded;
            white += r == 255;
            dark += r == 13;
        }
    // Lines as broad as the room between them, and a pixel of transition on each side.
    EXPECT_GT(folded, 200u);
    EXPECT_GT(double(white), 0.2 * double(folded));
    EXPECT_GT(double(dark), 0.2 * double(folded));
}

TEST(Folds, AreNotMarkedAtRest) {
    const auto context = open_context("osmesa");
    Document document;
    document.picture = noise<std::uint8_t>(60, 40);
    document.probes.push_back(new_probe(document, {30, 20}));
    Scene scene(document);
    const View view = scene.whole(2);
    EXPECT_EQ(shown(scene, view, {false, 7}), shown(scene, view, {}));
}

}  // namespace
}  // namespace probewarp
