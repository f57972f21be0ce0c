// The processor draws what the graphics driver draws, with every instruction set.
#include "raster/rasterizer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "exporting/export.h"
#include "render/context.h"
#include "scene.h"
#include "support/every_instruction_set.h"

namespace probewarp {
namespace {

using testing::with_every_instruction_set;

struct Difference {
    std::size_t steps = 0;   ///< values that are up to one apart, of 255
    std::size_t others = 0;  ///< further
    std::size_t values = 0;
};

/// Of what can be seen: colours count as much as their alpha.
Difference difference(const Image& a, const Image& b) {
    Difference found;
    const double largest = a.bits() == 16 ? 65535 : 255;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            for (std::size_t c = 0; c < 4; ++c) {
                const auto seen = [&](const Image& image) {
                    const auto p = pixel(image, x, y);
                    return c == 3 ? p[c] : p[c] * p[3] / largest;
                };
                const double off = std::abs(seen(a) - seen(b)) * 255 / largest;
                found.steps += off > 0.125 && off <= 1;
                found.others += off > 1;
                ++found.values;
            }
    return found;
}

/// Drivers know places to float's 2^-15 of a pixel or so, from which noise makes 255 / 32768 of a step; but
/// in the slivers of a fold, where a place moves by pixels, far more of a few.
void expect_alike(const Image& a, const Image& b) {
    const Difference found = difference(a, b);
    EXPECT_LE(found.others, found.values / 10'000);
    EXPECT_LE(found.steps, found.values / 64);
}

void expect_as_the_driver(const Document& document, double scale, const FileStyle& style = {}) {
    Scene scene(document);
    const View view = scene.whole(scale);
    const Image by_driver = scene.by_driver(view, style);
    with_every_instruction_set([&] { expect_alike(scene.by_processor(view, style), by_driver); });
}

TEST(Rasterizer, DrawsAsTheDriverDoes) {
    const auto context = open_context("osmesa");
    for (const auto& picture : {noise<std::uint8_t>(300, 200), noise<std::uint16_t>(300, 200)})
        for (const double angle : {0.0, 0.4, 1.5, 3.0})
            for (const double scale : {1.0, 0.6, 0.07, 2.5}) {
                SCOPED_TRACE(std::to_string(angle) + ", " + std::to_string(scale));
                expect_as_the_driver(pulled(picture, angle), scale, {1, Colour{250, 3, 77}, false});
            }
}

TEST(Rasterizer, BlendsAsTheDriverDoes) {
    const auto context = open_context("osmesa");
    for (const auto& picture : {translucent<std::uint8_t>(120, 90), translucent<std::uint16_t>(120, 90)})
        for (const double angle : {0.0, 0.4, 3.0})
            for (const double scale : {1.0, 0.45, 1.7})
                for (const int samples : {1, 3})
                    for (const auto& background :
                         {std::optional<Colour>{}, std::optional<Colour>{{250, 3, 77}}}) {
                        SCOPED_TRACE(std::to_string(angle) + ", " + std::to_string(scale));
                        expect_as_the_driver(pulled(picture, angle), scale, {samples, background, false});
                    }
}

TEST(Rasterizer, AveragesTheSamplesOfAnOpaquePicture) {
    const auto context = open_context("osmesa");
    expect_as_the_driver(pulled(noise<std::uint8_t>(120, 90), 0.4), 1.2, {4, {}, false});
}

TEST(Rasterizer, LeavesWhatIsBesideThePictureClear) {
    const auto context = open_context("osmesa");
    expect_as_the_driver(pulled(noise<std::uint8_t>(300, 200), 0.8), 1.3);
}

TEST(Rasterizer, LaysLaterTrianglesOverEarlierOnes) {
    const auto context = open_context("osmesa");
    Document folded = pulled(noise<std::uint8_t>(300, 200), 0.4);
    folded.probes[0].now.x += 180;
    expect_as_the_driver(folded, 1);
}

TEST(Rasterizer, LeavesTrianglesWithoutAnAreaOut) {
    const auto context = open_context("osmesa");
    Scene scene(pulled(noise<std::uint8_t>(60, 40), 0.4));
    const View view = scene.whole(1);
    const Image nothing = scene.blank(view);
    for (glm::vec2& now : scene.deformation.now) now = {30.5f, now.y};
    with_every_instruction_set([&] { EXPECT_EQ(scene.by_processor(view).rgba, nothing.rgba); });
    // Corners that have an area on the grid of 1/256 of a pixel, but none that tells what to show.
    for (glm::vec2& now : scene.deformation.now) now = {30.501f + now.y * 1e-4f, now.y};
    with_every_instruction_set([&] { scene.by_processor(view); });
}

TEST(Rasterizer, VerticesMayBeFarAway) {
    const auto context = open_context("osmesa");
    Scene scene(pulled(noise<std::uint8_t>(60, 40), 0.4));
    const View view = scene.whole(1);
    std::mt19937 random(5);
    for (const float far : {1e5f, 1e7f, 1e15f, 1e30f}) {
        std::uniform_real_distribution<float> place(-far, far);
        for (glm::vec2& now : scene.deformation.now) now = {place(random), place(random)};
        for (const int samples : {1, 4})
            with_every_instruction_set([&] {
                const Image image = scene.by_processor(view, {samples, Colour{1, 2, 3}, false});
                for (int y = 0; y < view.height; ++y)
                    for (int x = 0; x < view.width; ++x) ASSERT_EQ(pixel(image, x, y)[3], 255);
            });
    }
}

TEST(Rasterizer, DrawsThinPictures) {
    const auto context = open_context("osmesa");
    for (const auto& picture :
         {noise<std::uint8_t>(1, 40), noise<std::uint16_t>(40, 1), noise<std::uint8_t>(1, 1)})
        for (const double scale : {1.0, 3.0, 13.7}) expect_as_the_driver(pulled(picture, 0.3), scale);
    expect_as_the_driver(pulled(noise<std::uint8_t>(3, 400), 0.3), 0.4);  // mipmaps one pixel wide
}

TEST(Rasterizer, GivesAnUndeformedPictureBack) {
    const auto context = open_context("osmesa");
    for (const auto& picture : {noise<std::uint8_t>(301, 67), noise<std::uint16_t>(301, 67),
                                translucent<std::uint8_t>(301, 67), translucent<std::uint16_t>(301, 67)}) {
        Document document;
        document.picture = picture;
        const Scene still(document);
        document.probes.push_back(new_probe(document, {10, 10}));
        Scene at_rest(document);
        at_rest.deformation.moved = true;  // by the mesh, not as the one picture that it is
        with_every_instruction_set([&] {
            for (const Scene* scene : {&still, &std::as_const(at_rest)})
                EXPECT_EQ(scene->by_processor(scene->whole(1)).rgba, picture->image.rgba);
        });
    }
}

TEST(Rasterizer, BandsDoNotShow) {
    const auto context = open_context("osmesa");
    for (const int samples : {1, 3, 16}) {
        const Scene scene(pulled(noise<std::uint8_t>(300, 200), 0.3));
        const View view = scene.whole(4.01);  // the last band is not whole
        const FileStyle style{samples, {}, false};
        Rasterizer rasterizer(scene.deformation, view, style);
        EXPECT_EQ(exported(rasterizer, scene.deformation, view, style).rgba,
                  scene.by_processor(view, style).rgba);
    }
}

TEST(Rasterizer, LevelsThatAreWantedAreThere) {
    // As the driver draws with all mipmaps.
    const auto context = open_context("osmesa");
    for (const double scale : {1.0, 0.99, 0.9, 0.51, 0.5, 0.49, 0.26, 0.24, 0.05}) {
        expect_as_the_driver(pulled(noise<std::uint8_t>(400, 300), 0.3), scale);
        Document still = pulled(noise<std::uint8_t>(400, 300), 0.3);
        still.probes.clear();
        expect_as_the_driver(still, scale);
    }
}

/// Rows that come when they are waited for, and not before.
struct RowsOnDemand final : ArrivingRows {
    const Image* all;                  ///< of the picture
    mutable Image* arrived = nullptr;  ///< its other image, of which only these rows are there
    mutable int rows = 0;

    explicit RowsOnDemand(const Image& of) : all(&of) {}
    void wait(int wanted) const override {
        rows = std::max(rows, wanted);
        const auto from = pixel_bytes(*all).first(std::size_t(rows) * std::size_t(all->width) * 4);
        std::memcpy(std::get<0>(arrived->rgba).data(), from.data(), from.size());
    }
    Times times() const override { return {}; }
};

/// The picture, none of whose rows has come yet.
PicturePtr arriving(const Picture& whole, const std::shared_ptr<RowsOnDemand>& rows) {
    auto picture = std::make_shared<Picture>(whole);
    picture->image.opaque = true;
    std::ranges::fill(std::get<0>(picture->image.rgba), std::uint8_t{0});
    picture->arriving = rows;
    rows->arrived = &picture->image;
    return picture;
}

TEST(Rasterizer, WaitsForTheRowsThatItShowsAndNoOthers) {
    for (const auto& [width, height] : {std::array{600, 3000}, std::array{401, 333}, std::array{2, 700},
                                        std::array{1, 900}, std::array{900, 1}})
        for (const double scale : {5.0, 2.0, 1.0, 0.9, 0.3})
            for (const double angle : {0.0, 0.3, -2.0})
                for (const int samples : {1, 2}) {
                    SCOPED_TRACE(fmt::format("{} x {}, {}, {}, {}", width, height, scale, angle, samples));
                    if (width * height * scale * scale > 8e6) continue;
                    const PicturePtr whole = noise<std::uint8_t>(width, height);
                    Deformation deformation;
                    update(deformation, pulled(whole, angle));
                    const View view{{},
                                    glm::dvec2(scale),
                                    std::max(1, int(width * scale)),
                                    std::max(1, int(height * scale))};
                    const FileStyle style{samples, {}, false};
                    Rasterizer at_once(deformation, view, style);

                    const auto rows = std::make_shared<RowsOnDemand>(whole->image);
                    Deformation late = deformation;
                    late.source.picture = arriving(*whole, rows);
                    Rasterizer bit_by_bit(late, view, style);
                    EXPECT_EQ(rows->rows, 0) << "nothing was drawn yet";

                    Image first =
                        blank(whole->image, {{}, view.scale, view.width, std::min(64, view.height)});
                    bit_by_bit.draw_rows(0, first);
                    if (angle == 0 && width == 600) {  // else the picture may stand on its head
                        EXPECT_LT(rows->rows, 64 / scale + 400);
                    }
                    EXPECT_EQ(exported(bit_by_bit, late, view, style).rgba,
                              exported(at_once, deformation, view, style).rgba);
                }
}

TEST(Triangles, WantNoMoreLevelsThanTheyShow) {
    const std::vector<glm::vec2> corners{{0, 0}, {300, 0}, {0, 200}};
    const std::vector<std::uint32_t> one{0, 1, 2};
    const DeformedMesh mesh{corners, corners, one};
    const auto wanted = [&](double scale) { return wanted_levels(mesh, {{}, glm::dvec2(scale), 300, 200}); };
    EXPECT_EQ(wanted(2), 0);
    EXPECT_EQ(wanted(1), 0);
    EXPECT_EQ(wanted(0.9), 1);
    EXPECT_EQ(wanted(0.51), 1);
    EXPECT_EQ(wanted(0.49), 2);
    EXPECT_EQ(wanted_levels(mesh, {{400, 400}, glm::dvec2(0.1), 30, 20}), 0) << "nothing shows there";
}

}  // namespace
}  // namespace probewarp
