#include "render/renderer.h"

#include <fmt/format.h>
#include <shaders/embedded.h>

#include <algorithm>
#include <cassert>

namespace probewarp {

namespace {

void set(const GlProgram& program, const char* name, glm::dvec2 v) {
    glUniform2f(uniform(program, name), float(v.x), float(v.y));
}
void set(const GlProgram& program, const char* name, glm::vec3 v) {
    glUniform3f(uniform(program, name), v.x, v.y, v.z);
}
void set(const GlProgram& program, const char* name, glm::vec4 v) {
    glUniform4f(uniform(program, name), v.x, v.y, v.z, v.w);
}
void set(const GlProgram& program, const char* name, float v) { glUniform1f(uniform(program, name), v); }
void set(const GlProgram& program, const char* name, int v) { glUniform1i(uniform(program, name), v); }

/// Target pixels that larger triangles may have in place of several; what an overlay shows has edges of its
/// own, for which it is half of that.
constexpr double largest_side = 4;

/// The window's toolkit shares the context: what we rely on is set anew each time.
/// Left of `first_column` the target stays as it is.
void begin(const Target& target, int first_column = 0) {
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.name());
    glViewport(0, 0, target.width, target.height);
    if (first_column > 0) {
        glEnable(GL_SCISSOR_TEST);
        glScissor(first_column, 0, std::max(0, target.width - first_column), target.height);
    } else {
        glDisable(GL_SCISSOR_TEST);
    }
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glDisable(GL_DITHER);
    glBindSampler(0, 0);
    glActiveTexture(GL_TEXTURE0);
}

/// Has the bound array take the corners both as where they rest and as where they are.
void set_still_points(const GlBuffer& corners, std::span<const glm::vec2> points) {
    glBindBuffer(GL_ARRAY_BUFFER, corners.name());
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(points.size_bytes()), points.data(), GL_STATIC_DRAW);
    for (const GLuint location : {0u, 1u}) {
        glVertexAttribPointer(location, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
        glEnableVertexAttribArray(location);
    }
}

}  // namespace

void clear_window(int width, int height, glm::vec3 colour) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(colour.x, colour.y, colour.z, 1);
    glClear(GL_COLOR_BUFFER_BIT);
}

Renderer::Renderer()
    : mesh_program_([] { return make_program(shaders::mesh_vert, shaders::mesh_frag); }),
      mesh_overlay_program_([] { return make_program(shaders::mesh_vert, shaders::mesh_frag, "OVERLAY"); }),
      resolve_program_([] { return make_program(shaders::screen_vert, shaders::resolve_frag); }),
      display_program_([] { return make_program(shaders::screen_vert, shaders::display_frag); }),
      lines_program_([] { return make_program(shaders::mesh_vert, shaders::lines_frag); }),
      folds_program_([] { return make_program(shaders::mesh_vert, shaders::folds_frag); }),
      picture_array_(make_vertex_array()),
      empty_array_(make_vertex_array()),
      still_array_(make_vertex_array()),
      picture_corners_(make_buffer()),
      still_corners_(make_buffer()),
      still_triangles_(make_buffer()) {}

void Renderer::set_picture(PictureTexture picture) {
    picture_ = std::move(picture);
    const float right = float(picture_.width), bottom = float(picture_.height);
    const std::array<glm::vec2, 4> corners{{{0, 0}, {right, 0}, {0, bottom}, {right, bottom}}};
    glBindVertexArray(picture_array_.name());
    set_still_points(picture_corners_, corners);
}

void Renderer::set_mesh(std::shared_ptr<const Mesh> mesh, const StillCells& still) {
    mesh_.set_mesh(std::move(mesh));
    glBindVertexArray(still_array_.name());
    set_still_points(still_corners_, still.corners);
    const auto indices = std::span(still.triangles);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, still_triangles_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(indices.size_bytes()), indices.data(), GL_STATIC_DRAW);
    check_gl("uploading what stays");
    still_count_ = GLsizei(indices.size());
    moved_ = false;
    overlay_style_.reset();
}

void Renderer::set_positions(std::span<const glm::vec2> now, bool moved) {
    mesh_.set_positions(now);
    moved_ = moved;
}

void Renderer::set_overlay(std::span<const OverlayVertex> vertices, const OverlayStyle& style) {
    overlay_style_.reset();
    if (vertices.empty()) return;
    constexpr int components = 4;
    static_assert(sizeof(OverlayVertex) == components * sizeof(float));
    mesh_.set_attribute(2, std::as_bytes(vertices), components);
    overlay_style_ = style;
}

void Renderer::set_weights(std::span<const float> weights) { mesh_.set_weights(weights); }

void Renderer::set_pose(std::span<const DualComplex<float>> transformations, glm::vec2 centre) {
    mesh_.move(transformations, centre);
    moved_ = std::any_of(transformations.begin(), transformations.end(),
                         [](const auto& p) { return p != DualComplex<float>{}; });
}

void Renderer::set_view(const GlProgram& program, const View& view, int samples) const {
    set(program, "origin", view.origin);
    set(program, "scale", view.scale * double(samples));
    set(program, "size", glm::dvec2(view.width * samples, view.height * samples));
}

void Renderer::use_mesh_program(const View& view, int samples, bool with_overlay) {
    const GlProgram& program = (with_overlay ? mesh_overlay_program_ : mesh_program_).get();
    glUseProgram(program.name());
    set_view(program, view, samples);
    set(program, "picture", 0);
    set(program, "last_level", picture_.last_level);
    if (!with_overlay) return;
    set(program, "heat", overlay_style_->heat ? 1 : 0);
    set(program, "iso_lines", overlay_style_->iso_lines ? 1 : 0);
    set(program, "opacity", overlay_style_->opacity);
    for (std::size_t i = 0; i < heat_colours.size(); ++i) {
        const Colour c = heat_colours[i];
        set(program, fmt::format("heat_colours[{}]", i).c_str(), glm::vec3(c.r, c.g, c.b) / 255.0f);
    }
}

void Renderer::draw(const View& view, int samples, bool with_overlay, int first_column, Fineness fineness) {
    with_overlay = with_overlay && overlay_style_;
    // Float, because the sums of weighted colours must give every byte of a file back.
    resize(layer_, view.width * samples, view.height * samples, GL_RGBA32F);
    begin(layer_, first_column * samples);
    const GLfloat nothing[4]{};
    glClearBufferfv(GL_COLOR, 0, nothing);
    glBindTexture(GL_TEXTURE_2D, picture_.texture.name());
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const bool meshed = moved_ || with_overlay;
    if (meshed && still_count_ > 0) {
        use_mesh_program(view, samples, false);
        draw_still();
    }
    use_mesh_program(view, samples, with_overlay);
    if (meshed)
        mesh_.draw(view, fineness, with_overlay ? largest_side / 2 : largest_side);
    else
        draw_picture();
    glDisable(GL_BLEND);
    check_gl("drawing the picture");
}

void Renderer::draw_picture() {
    glBindVertexArray(picture_array_.name());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void Renderer::draw_still() {
    glBindVertexArray(still_array_.name());
    glDrawElements(GL_TRIANGLES, still_count_, GL_UNSIGNED_INT, nullptr);
}

void Renderer::read_back(Image& image, int left, int top, const View& view, int samples,
                         std::optional<Colour> background) {
    resolve(view, image.bits() == 16, samples, background);
    read_integers(image, left, top, view);
}

void Renderer::resolve(const View& view, bool deep, int samples, std::optional<Colour> background) {
    resize(integers_, view.width, view.height, deep ? GL_RGBA16UI : GL_RGBA8UI);
    begin(integers_);
    const GlProgram& program = resolve_program_.get();
    glUseProgram(program.name());
    set(program, "layer", 0);
    set(program, "samples", samples);
    set(program, "largest", deep ? 65535.0f : 255.0f);
    const Colour fill = background.value_or(Colour{});
    set(program, "background",
        glm::vec4(fill.r / 255.0f, fill.g / 255.0f, fill.b / 255.0f, background ? 1.0f : 0.0f));
    glBindTexture(GL_TEXTURE_2D, layer_.texture.name());
    glBindVertexArray(empty_array_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::read_integers(Image& image, int left, int top, const View& view) {
    assert(left >= 0 && top >= 0 && left + view.width <= image.width && top + view.height <= image.height);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ROW_LENGTH, image.width);
    const std::size_t first = (std::size_t(top) * std::size_t(image.width) + std::size_t(left)) * 4;
    std::visit(
        [&](auto& samples_of) {
            glReadPixels(0, 0, view.width, view.height, GL_RGBA_INTEGER,
                         sizeof samples_of[0] == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE,
                         samples_of.data() + first);
        },
        image.rgba);
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    check_gl("reading the picture back");
}

GLuint Renderer::display(const View& view, const DisplayColours& colours, double square,
                         const ShownMesh& mesh, int first_column) {
    resize(shown_, view.width, view.height, GL_RGBA8);
    begin(shown_, first_column);
    const GlProgram& program = display_program_.get();
    glUseProgram(program.name());
    const glm::dvec2 corner = -view.origin * view.scale;
    const glm::dvec2 opposite = corner + glm::dvec2(picture_.width, picture_.height) * view.scale;
    set(program, "layer", 0);
    set(program, "frame", glm::vec4(corner.x, corner.y, opposite.x, opposite.y));
    set(program, "square", float(square));
    set(program, "light", colours.light);
    set(program, "dark", colours.dark);
    set(program, "canvas", colours.canvas);
    glBindTexture(GL_TEXTURE_2D, layer_.texture.name());
    glBindVertexArray(empty_array_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    if (mesh.lines) draw_lines(view, colours.lines);
    if (mesh.hatching > 0 && moved_) draw_folds(view, mesh.hatching);
    check_gl("showing the picture");
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return shown_.texture.name();
}

void Renderer::draw_lines(const View& view, glm::vec4 colour) {
    const GlProgram& program = lines_program_.get();
    glUseProgram(program.name());
    set_view(program, view, 1);
    set(program, "colour", colour);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    mesh_.draw_lines(view, largest_side);
    glDisable(GL_BLEND);
}

/// The driver tells which way round the corners go, wherever they were moved by.
void Renderer::draw_folds(const View& view, double hatching) {
    const GlProgram& program = folds_program_.get();
    glUseProgram(program.name());
    set_view(program, view, 1);
    set(program, "period", float(hatching));
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);  // at rest, y down, the corners go round clockwise as the driver sees them
    glFrontFace(GL_CCW);
    mesh_.draw(view, Fineness::seen, largest_side);
    glDisable(GL_CULL_FACE);
}

}  // namespace probewarp
