// The renderer's own promises: what it refuses and how it says so, and that its two ways of deforming agree.
#include "raster/mipmaps.h"
#include "render/renderer.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <shaders/embedded.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <utility>

#include "exporting/export.h"
#include "model/deformation.h"
#include "render/context.h"
#include "render/deform_trial.h"
#include "scene.h"

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
    const Shader broken{"shaders/broken.frag",
                        "#version 330 core\nout vec4 c;\nvoid main() { c = nonsense; }\n"};
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
    EXPECT_NE(said.find("the picture is 32768 x 4 pixels; this graphics driver holds at most"),
              std::string::npos)
        << said;
}

TEST(Mipmaps, AreAlphaWeightedMeansDownToOnePixel) {
    Image image;
    image.width = 4;
    image.height = 2;
    // Left: red, half there, beside green that is not there at all. Right: black and white, opaque.
    image.rgba =
        std::vector<std::uint8_t>{255, 0, 0, 200, 0, 255, 0, 0, 0,   0,   0,   255, 255, 255, 255, 255,
                                  255, 0, 0, 200, 0, 255, 0, 0, 255, 255, 255, 255, 0,   0,   0,   255};
    const auto levels = smaller_levels(image);
    ASSERT_EQ(levels.size(), 2u);
    EXPECT_EQ(std::get<0>(levels[0].rgba), (std::vector<std::uint8_t>{255, 0, 0, 100, 128, 128, 128, 255}));
    EXPECT_EQ(levels[1].width * levels[1].height, 1);
}

TEST(Opacity, OneClearPixelIsFound) {
    // In the last of a texture's uploads, which hold a million pixels each.
    const auto context = open_context("osmesa");
    for (const int clear : {-1, 1100}) {
        const Scene scene(pulled(noise<std::uint8_t>(1300, 1200, clear), 0.2));
        const bool opaque = clear < 0;
        EXPECT_EQ(scene.renderer.is_opaque(), opaque);
        EXPECT_EQ(Rasterizer(scene.deformation, scene.whole(1), {}).is_opaque(), opaque);
    }
}

/// The alpha-weighted mean of four pixels in double, rounded.
std::array<int, 4> mean_of(const Image& image, int x, int y) {
    double weighted[3]{}, plain[3]{}, alpha = 0;
    for (const int dy : {0, 1})
        for (const int dx : {0, 1}) {
            const auto p =
                pixel(image, std::min(2 * x + dx, image.width - 1), std::min(2 * y + dy, image.height - 1));
            for (std::size_t c = 0; c < 3; ++c) weighted[c] += double(p[c]) * p[3], plain[c] += p[c];
            alpha += p[3];
        }
    std::array<int, 4> mean{};
    for (std::size_t c = 0; c < 3; ++c)
        mean[c] = int(std::floor((alpha > 0 ? weighted[c] / alpha : plain[c] / 4) + 0.5));
    mean[3] = int(std::floor(alpha / 4 + 0.5));
    return mean;
}

TEST(Mipmaps, OfOpaqueAndOfClearPicturesAreMeansToo) {
    for (const auto& picture : {noise<std::uint8_t>(37, 21), noise<std::uint16_t>(37, 21),
                                translucent<std::uint8_t>(37, 21), translucent<std::uint16_t>(1, 21)}) {
        const Image& image = picture->image;
        const Image smaller = smaller_levels(image, 1).at(0);
        ASSERT_EQ(smaller.height, 10);
        for (int y = 0; y < smaller.height; ++y)
            for (int x = 0; x < smaller.width; ++x)
                ASSERT_EQ(pixel(smaller, x, y), mean_of(image, x, y)) << x << ", " << y;
    }
}

/// A picture whose every pixel says where it is: red is x, green is y, in 65535ths of the side.
PicturePtr ramp(int side) {
    Picture picture;
    picture.image.width = picture.image.height = side;
    std::vector<std::uint16_t> rgba;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (const int v : {65535 * x / side, 65535 * y / side, 0, 65535})
                rgba.push_back(std::uint16_t(v));
    picture.image.rgba = std::move(rgba);
    return std::make_shared<const Picture>(std::move(picture));
}

Image exported(Renderer& renderer, const Deformation& deformation) {
    const View view = export_view(deformation, {});
    DriverDrawing drawing(renderer, view, {});
    return exported(drawing, deformation, view);
}

/// A renderer that holds a document's picture and its deformed mesh.
void prepare(Renderer& renderer, const Document& document, const Deformation& deformation) {
    renderer.set_picture(upload_picture(document.picture->image));
    renderer.set_mesh(deformation.binding->mesh);
    renderer.set_positions(deformation.now, deformation.moved);
}

void expect_shader_deforms_as_the_processor(const char* backend) {
    constexpr unsigned seed = 20261122;
    std::printf("seed %u\n", seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0, 256), way(-20, 20), angle(-1, 1);
    const auto context = open_context(backend);
    Renderer renderer;
    for (const int probes : {0, 1, 3, 20}) {
        Document document;
        document.picture = ramp(256);
        for (int i = 0; i < probes; ++i) {
            Probe probe = new_probe(document, {place(random), place(random)});
            probe.now += glm::dvec2(way(random), way(random));
            probe.angle = angle(random);
            document.probes.push_back(probe);
        }
        if (probes == 3) {  // a whole turn cancels between them: both must choose the heaviest
            document.probes[0].angle = 2 * std::numbers::pi;
            document.probes[1] = document.probes[0];
            document.probes[1].angle = 0;
            document.probes.pop_back();
        }
        Deformation deformation;
        update(deformation, document);
        EXPECT_EQ(deformation.cancelled > 0, probes == 3);
        renderer.set_picture(upload_picture(document.picture->image));
        renderer.set_mesh(deformation.binding->mesh);
        renderer.set_weights(weights_of(deformation));
        renderer.set_pose(deformation.transformations, {128, 128});
        const Image shader = exported(renderer, deformation);
        renderer.set_positions(deformation.now, deformation.moved);
        const Image processor = exported(renderer, deformation);
        // A hundredth of a pixel is 2.6 of the 256 levels that the ramp climbs a pixel; on the border, a
        // pixel may be covered by one of the two only.
        int far = 0;
        for (int y = 0; y < 256; ++y)
            for (int x = 0; x < 256; ++x)
                for (std::size_t k = 0; k < 2; ++k)
                    far += std::abs(pixel(processor, x, y)[k] - pixel(shader, x, y)[k]) > 3;
        EXPECT_LE(far, probes == 0 ? 0 : 8) << probes << " probes";
    }
}

TEST(VertexShader, DeformsAsTheProcessorDoes) { expect_shader_deforms_as_the_processor("osmesa"); }
TEST(VertexShader, DeformsSoWithoutAFramebufferOfTheContext) {
    expect_shader_deforms_as_the_processor("egl");
}

TEST(VertexShader, GivesSmallWeightsAFinitePlaceToo) {
    const auto context = open_context("osmesa");
    Document document;
    document.picture = ramp(64);
    document.probes.push_back(new_probe(document, {10, 20}));
    document.probes[0].now += glm::dvec2(5, 3);
    document.probes[0].angle = 0.3;
    Deformation deformation;
    update(deformation, document);
    Renderer renderer;
    prepare(renderer, document, deformation);
    const auto drawn = [&](float weight) {
        renderer.set_weights(std::vector<float>(deformation.now.size(), weight));
        renderer.set_pose(deformation.transformations, {32, 32});
        return exported(renderer, deformation);
    };
    const Image whole = drawn(1);
    for (const float weight : {1e-10f, 1e-18f, 1e-20f, 1e-30f, 1e-38f}) {
        const Image small = drawn(weight);
        // A lone probe's weight is of no account but for rounding. The ramp climbs 1024 levels a pixel, and
        // 20 is a fiftieth of one; on the border a pixel may be covered by one of the two only.
        int far = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                for (std::size_t k = 0; k < 4; ++k)
                    far += std::abs(pixel(whole, x, y)[k] - pixel(small, x, y)[k]) > 20;
        EXPECT_LE(far, 16) << weight;
    }
}

/// What all the context's buffers take.
std::int64_t buffered_bytes() {
    std::int64_t total = 0;
    for (GLuint name = 1; name < 100; ++name) {  // these tests make a few, and names are given out in order
        if (!glIsBuffer(name)) continue;
        GLint size = 0;
        glBindBuffer(GL_COPY_READ_BUFFER, name);
        glGetBufferParameteriv(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &size);
        total += size;
    }
    glBindBuffer(GL_COPY_READ_BUFFER, 0);
    return total;
}

TEST(VertexShader, KeepsNoWeightsOfTheMeshBeforeNorWhereItIsGivenNone) {
    const auto context = open_context("osmesa");
    Document document;
    document.picture = ramp(64);
    document.probes.push_back(new_probe(document, {10, 20}));
    Deformation deformation;
    update(deformation, document);
    Renderer renderer;
    prepare(renderer, document, deformation);
    const std::int64_t without = buffered_bytes();
    ASSERT_GT(without, 0);
    const auto bytes = std::int64_t(weights_of(deformation).size_bytes());
    renderer.set_weights(weights_of(deformation));
    EXPECT_EQ(buffered_bytes(), without + bytes);
    renderer.set_mesh(deformation.binding->mesh);
    EXPECT_EQ(buffered_bytes(), without);
    renderer.set_weights(weights_of(deformation));
    renderer.set_weights({});
    EXPECT_EQ(buffered_bytes(), without);
}

TEST(DeformChoice, IsAskedForOrTheQuickerOneAndNeverTheShaderOfASoftwareRasteriser) {
    const auto by = [](DeformBy wanted, const char* renderer, std::optional<DeformTimes> times) {
        return choose_deform(wanted, renderer, times).by;
    };
    constexpr DeformTimes shader_wins{2, 1}, processor_wins{1, 2};
    EXPECT_EQ(by(DeformBy::automatic, "NVIDIA H200", shader_wins), DeformBy::shader);
    EXPECT_EQ(by(DeformBy::automatic, "NVIDIA H200", processor_wins), DeformBy::processor);
    EXPECT_EQ(by(DeformBy::automatic, "NVIDIA H200", {}), DeformBy::processor);
    for (const char* software : {"llvmpipe", "softpipe", "SwiftShader Device", "Software Rasterizer"})
        EXPECT_EQ(by(DeformBy::automatic, software, shader_wins), DeformBy::processor) << software;
    EXPECT_EQ(by(DeformBy::shader, "llvmpipe", processor_wins), DeformBy::shader);
    EXPECT_EQ(by(DeformBy::processor, "NVIDIA H200", shader_wins), DeformBy::processor);
    EXPECT_EQ(choose_deform(DeformBy::automatic, "llvmpipe", {}).why, "llvmpipe draws in software");
}

TEST(DeformTrial, MeasuresBothAndLeavesTheRenderersMeshAlone) {
    const auto context = open_context("osmesa");
    Document document;
    document.picture = ramp(64);
    document.probes.push_back(new_probe(document, {10, 20}));
    document.probes[0].now += glm::dvec2(5, 3);
    Deformation deformation;
    update(deformation, document);
    Renderer renderer;
    prepare(renderer, document, deformation);
    const Image before = exported(renderer, deformation);
    // What the renderer draws into holds another picture now, in case that it draws nothing afterwards.
    renderer.set_positions(mesh_of(deformation).rest, false);
    ASSERT_NE(exported(renderer, deformation).rgba, before.rgba);
    renderer.set_positions(deformation.now, deformation.moved);
    const auto times = measured_deform_times();
    ASSERT_TRUE(times);
    EXPECT_GT(times->processor, 0);
    EXPECT_GT(times->shader, 0);
    EXPECT_EQ(exported(renderer, deformation).rgba, before.rgba);
}

/// Notes, in their order, the calls that wait for the driver ('F') and some of those that give it work ('w').
struct NotedCalls {
    static inline std::string calls;
    static inline PFNGLFINISHPROC finish;
    static inline PFNGLBINDBUFFERPROC bind_buffer;
    static inline PFNGLBINDFRAMEBUFFERPROC bind_framebuffer;

    NotedCalls() {
        finish = std::exchange(glad_glFinish, [] { calls += 'F', finish(); });
        bind_buffer = std::exchange(
            glad_glBindBuffer, [](GLenum target, GLuint name) { calls += 'w', bind_buffer(target, name); });
        bind_framebuffer = std::exchange(glad_glBindFramebuffer, [](GLenum target, GLuint name) {
            calls += 'w', bind_framebuffer(target, name);
        });
    }
    ~NotedCalls() {
        glad_glFinish = finish, glad_glBindBuffer = bind_buffer, glad_glBindFramebuffer = bind_framebuffer;
    }
};

TEST(DeformTrial, IsNotChargedForWhatWasDrawnBefore) {
    const auto context = open_context("osmesa");
    DeformTrial trial;
    const NotedCalls noted;
    while (!trial.done()) {
        NotedCalls::calls.clear();
        trial.step();
        // What was drawn before is waited for first, then the step's own work: the clock runs in between.
        EXPECT_THAT(NotedCalls::calls, testing::MatchesRegex("Fw+F"));
    }
}

TEST(Upload, IsOfTheVerticesThatMovedAndNothingElse) {
    const auto context = open_context("osmesa");
    Document document;
    document.picture = ramp(64);
    document.mesh.cells = 8;
    document.probes.push_back(new_probe(document, {10, 20}));
    document.probes[0].now += glm::dvec2(5, 3);
    Deformation deformation;
    update(deformation, document);
    Renderer renderer;
    renderer.set_picture(upload_picture(document.picture->image));
    renderer.set_mesh(deformation.binding->mesh);
    constexpr std::size_t a_vertex = 2 * sizeof(float);
    const auto handed_over = [&](std::span<const glm::vec2> now) {
        const std::size_t before = renderer.uploaded();
        renderer.set_positions(now, true);
        return renderer.uploaded() - before;
    };
    std::vector<glm::vec2> now = deformation.now;
    EXPECT_EQ(handed_over(now), now.size() * a_vertex);
    EXPECT_EQ(handed_over(now), 0u);
    now[20].x += 1;
    now[26].y -= 1;
    EXPECT_EQ(handed_over(now), 7 * a_vertex);
    EXPECT_EQ(handed_over(now), 0u);
    now.back().x -= 2;
    EXPECT_EQ(handed_over(now), a_vertex);
    now.front().x += 2;
    EXPECT_EQ(handed_over(now), a_vertex);

    // What is drawn after many small changes is what is drawn by one who sees the last alone.
    std::mt19937 random(5);
    for (int step = 0; step < 40; ++step) {
        const std::size_t first = random() % now.size(), count = random() % (now.size() - first);
        for (std::size_t v = first; v < first + count; v += 1 + random() % 3) now[v].y += 0.5f;
        handed_over(now);
    }
    Renderer other;
    other.set_picture(upload_picture(document.picture->image));
    other.set_mesh(deformation.binding->mesh);
    other.set_positions(now, true);
    const Image drawn = exported(renderer, deformation);
    EXPECT_EQ(drawn.rgba, exported(other, deformation).rgba);

    // Once the shader has moved them nobody knows where they are.
    renderer.set_weights(weights_of(deformation));
    const std::size_t before = renderer.uploaded();
    renderer.set_pose(deformation.transformations, {32, 32});
    EXPECT_EQ(renderer.uploaded() - before, 4 * sizeof(float));
    EXPECT_EQ(handed_over(now), now.size() * a_vertex);
    EXPECT_EQ(exported(renderer, deformation).rgba, drawn.rgba);
}

TEST(Sampling, AWholePixelShiftIsExactAlsoWhereVerticesAreRounded) {
    // Noise of 16 bits: a ten-thousandth of a pixel beside a centre, as far out as vertices are off there by
    // float's rounding, would change the last digits.
    constexpr int width = 3001, height = 40, right = 37, down = 3;
    Picture picture;
    picture.image.width = width;
    picture.image.height = height;
    std::mt19937 random(7);
    std::vector<std::uint16_t> rgba;
    for (int i = 0; i < width * height * 4; ++i) rgba.push_back(i % 4 == 3 ? 65535 : std::uint16_t(random()));
    picture.image.rgba = std::move(rgba);
    Document document;
    document.picture = std::make_shared<const Picture>(std::move(picture));
    Probe probe = new_probe(document, {1234.5, 17});
    probe.now += glm::dvec2(right, down);
    document.probes.push_back(probe);
    Deformation deformation;
    update(deformation, document);
    const auto context = open_context("osmesa");
    Renderer renderer;
    renderer.set_picture(upload_picture(document.picture->image));
    renderer.set_mesh(deformation.binding->mesh);
    renderer.set_positions(deformation.now, deformation.moved);
    const Image shifted = exported(renderer, deformation);
    int wrong = 0;
    for (int y = down; y < height; ++y)
        for (int x = right; x < width; ++x)
            wrong += pixel(shifted, x, y) != pixel(document.picture->image, x - right, y - down);
    EXPECT_EQ(wrong, 0);
}

/// A ring of noise, its left half faint, with colour also where there is no alpha.
PicturePtr ring(int side) {
    Picture picture;
    picture.image.width = picture.image.height = side;
    std::mt19937 random(11);
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double far = std::hypot(x + 0.5 - side / 2.0, y + 0.5 - side / 2.0) / side;
            for (int k = 0; k < 3; ++k) rgba.push_back(std::uint8_t(random()));
            const unsigned most = x < side / 2 ? 20 : 255;
            rgba.push_back(far > 0.2 && far < 0.4 ? std::uint8_t(random() % most + 1) : std::uint8_t{0});
        }
    picture.image.rgba = std::move(rgba);
    return std::make_shared<const Picture>(std::move(picture));
}

TEST(Outline, CellsThatAreLeftOutChangeNoUndeformedByte) {
    const auto context = open_context("osmesa");
    Renderer renderer;
    Document document;
    document.picture = ring(120);
    document.mesh.cells = 40;
    document.mesh.threshold = 100;  // leaves out cells of visible pixels too
    document.mesh.margin = 0;
    for (const glm::dvec2 rest : {glm::dvec2(60, 24), glm::dvec2(95.5, 61.5), glm::dvec2(3, 3)}) {
        Deformation deformation;
        document.probes.push_back(new_probe(document, rest));
        update(deformation, document);
        ASSERT_LT(mesh_of(deformation).triangles.size(), std::size_t{3} * 2 * 40 * 40);
        prepare(renderer, document, deformation);
        const Image same = exported(renderer, deformation);
        EXPECT_EQ(same.rgba, document.picture->image.rgba) << document.probes.size() << " probes";
    }
}

TEST(Outline, WhatIsVisibleMovesWhole) {
    const auto context = open_context("osmesa");
    Renderer renderer;
    Document document;
    document.picture = ring(120);
    document.mesh.cells = 40;
    constexpr int right = 7, down = -5;
    for (const glm::dvec2 rest : {glm::dvec2(60, 24), glm::dvec2(61, 97)}) {
        Probe probe = new_probe(document, rest);
        probe.now += glm::dvec2(right, down);
        document.probes.push_back(probe);
    }
    Deformation deformation;
    update(deformation, document);
    ASSERT_LT(mesh_of(deformation).triangles.size(), std::size_t{3} * 2 * 40 * 40);
    prepare(renderer, document, deformation);
    const Image moved = exported(renderer, deformation);
    const Image& picture = document.picture->image;
    int visible = 0, wrong = 0;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 120; ++x) {
            const int from_x = x - right, from_y = y - down;
            const bool inside = from_x >= 0 && from_y >= 0 && from_x < 120 && from_y < 120;
            const auto was = inside ? pixel(picture, from_x, from_y) : std::array<int, 4>{};
            visible += was[3] > 0;
            // Whole pixels are exact; of what cannot be seen only that counts.
            wrong += was[3] > 0 ? pixel(moved, x, y) != was : pixel(moved, x, y)[3] != 0;
        }
    EXPECT_GT(visible, 5000);
    EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace probewarp
