// The renderer's own promises: what it refuses and how it says so, and that its two ways of deforming agree.
#include "render/renderer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <shaders/embedded.h>

#include <random>

#include "model/document.h"
#include "render/context.h"

namespace probewarp {
namespace {

/// What an Error says; empty where none is thrown.
template <class Work>
std::string message(Work work) {
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

TEST(Context, AnUnknownBackendIsNamed) {
    EXPECT_EQ(message([] { open_context("vulkan"); }),
              "there is no backend named vulkan; expected auto, osmesa or egl");
}

TEST(Shaders, ACompileErrorNamesTheFileAndTheLog) {
    const auto context = open_context("osmesa");
    const Shader broken{"shaders/broken.frag", "#version 330 core\nout vec4 c;\nvoid main() { c = nonsense; }\n"};
    const std::string said = message([&] { make_program(shaders::screen_vert, broken); });
    EXPECT_NE(said.find("shaders/broken.frag"), std::string::npos) << said;
    EXPECT_NE(said.find("nonsense"), std::string::npos) << said;
}

TEST(Shaders, AMissingUniformIsNamed) {
    const auto context = open_context("osmesa");
    const GlProgram program = make_program(shaders::screen_vert, shaders::resolve_frag);
    EXPECT_EQ(message([&] { uniform(program, "no_such"); }), "a shader has no uniform named no_such");
}

TEST(Picture, LargerThanATextureIsRefusedBeforeItIsUploaded) {
    const auto context = open_context("osmesa");
    Image image;  // no pixels: they must not be looked at
    image.width = 32768;
    image.height = 4;
    const std::string said = message([&] { check_texture_size(image); });
    EXPECT_NE(said.find("the picture is 32768 x 4 pixels; this graphics driver holds at most"), std::string::npos) << said;
}

TEST(Mipmaps, AreAlphaWeightedMeansDownToOnePixel) {
    Image image;
    image.width = 4;
    image.height = 2;
    // Left: red, half there, beside green that is not there at all. Right: black and white, opaque.
    image.rgba = std::vector<std::uint8_t>{255, 0, 0, 200, 0, 255, 0, 0, 0,   0,   0,   255, 255, 255, 255, 255,
                                           255, 0, 0, 200, 0, 255, 0, 0, 255, 255, 255, 255, 0,   0,   0,   255};
    const auto levels = smaller_levels(image);
    ASSERT_EQ(levels.size(), 2u);
    EXPECT_EQ(std::get<0>(levels[0].rgba), (std::vector<std::uint8_t>{255, 0, 0, 100, 128, 128, 128, 255}));
    EXPECT_EQ(levels[1].width * levels[1].height, 1);
}

}  // namespace
}  // namespace probewarp
