#include "render/deform_trial.h"

#include <fmt/format.h>
#include <shaders/embedded.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>

namespace probewarp {

namespace {

constexpr int side = 1000;  // of the picture that the mesh would lie over, pixels

/// By the distance from probes on a circle, as the default scheme has them.
std::vector<float> trial_weights(const Mesh& mesh, std::span<const Motion<double>> motions,
                                 glm::vec2 centre) {
    std::vector<float> weights;
    weights.reserve(mesh.rest.size() * motions.size());
    for (const glm::vec2 rest : mesh.rest)
        for (const auto& m : motions)
            weights.push_back(1 / (1 + std::norm(std::complex<float>(rest.x - centre.x, rest.y - centre.y) -
                                                 std::complex<float>(m.rest))));
    return weights;
}

template <class Work>
double milliseconds(Work work) {
    using Clock = std::chrono::steady_clock;
    glFinish();  // what was drawn before is not this work's
    const auto before = Clock::now();
    work();
    glFinish();
    return std::chrono::duration<double, std::milli>(Clock::now() - before).count();
}

constexpr glm::vec2 centre{side / 2.0f, side / 2.0f};

/// Drawn by the rasterisers that Mesa, Google and Microsoft have for machines without a graphics card.
bool draws_in_software(const std::string& renderer) {
    constexpr std::array names{"llvmpipe",    "softpipe", "swrast",      "Software Rasterizer",
                               "SwiftShader", "lavapipe", "Basic Render"};
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

}  // namespace

DeformTrial::DeformTrial()
    : grid_(std::make_shared<const Mesh>(grid_mesh(side, side, cells))),
      now_(vertices),
      program_([] { return make_program(shaders::mesh_vert, shaders::lines_frag); }) {
    assert(grid_->rest.size() == vertices);
    for (int i = 0; i < probes; ++i) {
        const std::complex<double> rest = std::polar(side / 3.0, i * 0.8);
        motions_.push_back(motion(0.1 * i, rest, rest + 20.0));
        transformations_.push_back(cast<float>(motions_.back().p));
    }
    weights_ = trial_weights(*grid_, motions_, centre);
    tiles_ = make_tiles(weights_, probes);
    others_ = sum_others(tiles_, {motions_, transformations_, centre}, 0);
    mesh_.set_mesh(grid_);
    mesh_.set_weights(weights_);
}

/// A triangle into a few pixels: however the vertices were moved they are drawn alike, but only what is drawn
/// from is sure to be there.
void DeformTrial::draw() {
    resize(target_, 16, 16, GL_RGBA8);
    glBindFramebuffer(GL_FRAMEBUFFER, target_.framebuffer.name());
    glViewport(0, 0, target_.width, target_.height);
    for (const GLenum capability : {GL_SCISSOR_TEST, GL_DEPTH_TEST, GL_CULL_FACE, GL_BLEND})
        glDisable(capability);
    const GlProgram& program = program_.get();
    glUseProgram(program.name());
    glUniform2f(uniform(program, "origin"), 0, 0);
    glUniform2f(uniform(program, "scale"), 1, 1);
    glUniform2f(uniform(program, "size"), side, side);
    glUniform4f(uniform(program, "colour"), 1, 1, 1, 1);
    mesh_.draw_one();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glUseProgram(0);  // it goes with the trial: the window's toolkit would put it back
}

double DeformTrial::milliseconds_by_processor() {
    return milliseconds([this] {
        deform_dlb_dragged(tiles_, others_, grid_->rest, {motions_, transformations_, centre}, now_);
        mesh_.set_positions(now_);
        draw();
    });
}

double DeformTrial::milliseconds_by_shader() {
    return milliseconds([this] {
        mesh_.move(transformations_, centre);
        draw();
    });
}

void DeformTrial::step() {
    assert(!done());
    const bool shader = step_ % 2 != 0;
    const double took = shader ? milliseconds_by_shader() : milliseconds_by_processor();
    double& least = shader ? least_.shader : least_.processor;
    least = step_ < 4 ? took : std::min(least, took);
    ++step_;
    // The next step of the drag: every vertex goes elsewhere.
    motions_[0] = motion(0.01 * step_, motions_[0].rest, motions_[0].rest + double(step_));
    transformations_[0] = cast<float>(motions_[0].p);
    check_gl("measuring who deforms");
}

std::optional<DeformTimes> measured_deform_times() {
    try {
        DeformTrial trial;
        while (!trial.done()) trial.step();
        return trial.times();
    } catch (const Error&) {
        return {};
    }
}

DeformChoice choose_deform(DeformBy wanted, const std::string& renderer,
                           const std::optional<DeformTimes>& times) {
    if (wanted != DeformBy::automatic) return {wanted, "it was asked for"};
    if (draws_in_software(renderer)) return {DeformBy::processor, renderer + " draws in software"};
    if (!times) return {DeformBy::processor, "the vertex shader could not be measured"};
    if (times->shader < times->processor) return {DeformBy::shader, "it is quicker"};
    return {DeformBy::processor, "it is quicker"};
}

}  // namespace probewarp
