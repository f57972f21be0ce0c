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

void upload_vertices(const GlBuffer& buffer, std::span<const glm::vec2> points, GLuint location,
                     GLenum usage) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(points.size_bytes()), points.data(), usage);
    glVertexAttribPointer(location, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(location);
}

void upload_texels(const GlBuffer& buffer, const GlTexture& texture, std::span<const std::byte> bytes,
                   GLenum format) {
    glBindBuffer(GL_TEXTURE_BUFFER, buffer.name());
    glBufferData(GL_TEXTURE_BUFFER, GLsizeiptr(bytes.size()), bytes.data(), GL_STREAM_DRAW);
    glBindTexture(GL_TEXTURE_BUFFER, texture.name());
    glTexBuffer(GL_TEXTURE_BUFFER, format, buffer.name());
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
    : mesh_program_(make_program(shaders::mesh_vert, shaders::mesh_frag)),
      mesh_dlb_program_(make_program(shaders::mesh_dlb_vert, shaders::mesh_frag)),
      mesh_overlay_program_(make_program(shaders::mesh_vert, shaders::mesh_frag, "OVERLAY")),
      resolve_program_(make_program(shaders::screen_vert, shaders::resolve_frag)),
      display_program_(make_program(shaders::screen_vert, shaders::display_frag)),
      lines_program_(make_program(shaders::mesh_vert, shaders::lines_frag)),
      lines_dlb_program_(make_program(shaders::mesh_dlb_vert, shaders::lines_frag)),
      mesh_array_(make_vertex_array()),
      picture_array_(make_vertex_array()),
      empty_array_(make_vertex_array()),
      rest_(make_buffer()),
      now_(make_buffer()),
      overlay_(make_buffer()),
      triangles_(make_buffer()),
      edges_(make_buffer()),
      picture_corners_(make_buffer()),
      weights_(make_buffer()),
      transformations_(make_buffer()),
      weights_texture_(make_texture()),
      transformations_texture_(make_texture()) {}

void Renderer::set_picture(PictureTexture picture) {
    picture_ = std::move(picture);
    const float right = float(picture_.width), bottom = float(picture_.height);
    const std::array<glm::vec2, 4> corners{{{0, 0}, {right, 0}, {0, bottom}, {right, bottom}}};
    glBindVertexArray(picture_array_.name());
    for (const GLuint location : {0u, 1u})
        upload_vertices(picture_corners_, corners, location, GL_STATIC_DRAW);
}

void Renderer::set_mesh(const Mesh& mesh) {
    glBindVertexArray(mesh_array_.name());
    upload_vertices(rest_, mesh.rest, 0, GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(mesh.triangles.size() * sizeof(std::uint32_t)),
                 mesh.triangles.data(), GL_STATIC_DRAW);
    triangle_places_ = mesh.triangles;
    edge_count_ = 0;
    overlay_style_.reset();
    set_positions(mesh.rest, false);
}

void Renderer::set_positions(std::span<const glm::vec2> now, bool moved) {
    glBindVertexArray(mesh_array_.name());
    upload_vertices(now_, now, 1, GL_STREAM_DRAW);
    blend_centre_.reset();
    moved_ = moved;
    check_gl("uploading the mesh");
}

void Renderer::set_overlay(std::span<const OverlayVertex> vertices, const OverlayStyle& style) {
    overlay_style_.reset();
    if (vertices.empty()) return;
    glBindVertexArray(mesh_array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, overlay_.name());
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices.size_bytes()), vertices.data(), GL_STREAM_DRAW);
    static_assert(sizeof(OverlayVertex) == 4 * sizeof(float));
    glVertexAttribPointer(2, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(2);
    overlay_style_ = style;
    check_gl("uploading the overlay");
}

void Renderer::set_blend(std::span<const float> weights, std::span<const DualComplex<float>> transformations,
                         glm::vec2 centre) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &largest);
    if (weights.size() > std::size_t(largest))
        throw Error(
            fmt::format("{} weights are more than the {} that this graphics driver's shaders can read",
                        weights.size(), largest));
    upload_texels(weights_, weights_texture_, std::as_bytes(weights), GL_R32F);
    static_assert(sizeof(DualComplex<float>) == 4 * sizeof(float));
    upload_texels(transformations_, transformations_texture_, std::as_bytes(transformations), GL_RGBA32F);
    probes_ = int(transformations.size());
    blend_centre_ = centre;
    moved_ = std::any_of(transformations.begin(), transformations.end(),
                         [](const auto& p) { return p != DualComplex<float>{}; });
    check_gl("uploading the weights");
}

void Renderer::bind_blend(const GlProgram& program) const {
    if (!blend_centre_) return;
    set(program, "weights", 1);
    set(program, "transformations", 2);
    set(program, "probes", probes_);
    set(program, "centre", glm::dvec2(*blend_centre_));
    glActiveTexture(GL_TEXTURE1);
    glBindSampler(1, 0);
    glBindTexture(GL_TEXTURE_BUFFER, weights_texture_.name());
    glActiveTexture(GL_TEXTURE2);
    glBindSampler(2, 0);
    glBindTexture(GL_TEXTURE_BUFFER, transformations_texture_.name());
    glActiveTexture(GL_TEXTURE0);
}

void Renderer::set_view(const GlProgram& program, const View& view, int samples) const {
    set(program, "origin", view.origin);
    set(program, "scale", view.scale * double(samples));
    set(program, "size", glm::dvec2(view.width * samples, view.height * samples));
}

void Renderer::use_mesh_program(const View& view, int samples, bool with_overlay) const {
    const bool shader = blend_centre_ && moved_;
    const GlProgram& program = with_overlay ? mesh_overlay_program_
                               : shader     ? mesh_dlb_program_
                                            : mesh_program_;
    glUseProgram(program.name());
    set_view(program, view, samples);
    if (shader) bind_blend(program);
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

void Renderer::draw(const View& view, int samples, bool with_overlay) {
    with_overlay = with_overlay && overlay_style_;
    // Float, because the sums of weighted colours must give every byte of a file back.
    resize(layer_, view.width * samples, view.height * samples, GL_RGBA32F);
    begin(layer_, view.first_column * samples);
    const GLfloat nothing[4]{};
    glClearBufferfv(GL_COLOR, 0, nothing);
    use_mesh_program(view, samples, with_overlay);
    glBindTexture(GL_TEXTURE_2D, picture_.texture.name());
    // Where the mesh folds, a later triangle lies over an earlier one.
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    if (moved_ || with_overlay) {
        glBindVertexArray(mesh_array_.name());
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_.name());
        glDrawElements(GL_TRIANGLES, GLsizei(triangle_places_.size()), GL_UNSIGNED_INT, nullptr);
    } else {
        glBindVertexArray(picture_array_.name());
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
    glDisable(GL_BLEND);
    check_gl("drawing the picture");
}

void Renderer::read_back(Image& image, int left, int top, const View& view, int samples,
                         std::optional<Colour> background) {
    assert(left >= 0 && top >= 0 && left + view.width <= image.width && top + view.height <= image.height);
    const bool deep = image.bits() == 16;
    resize(integers_, view.width, view.height, deep ? GL_RGBA16UI : GL_RGBA8UI);
    begin(integers_);
    glUseProgram(resolve_program_.name());
    set(resolve_program_, "layer", 0);
    set(resolve_program_, "samples", samples);
    set(resolve_program_, "largest", deep ? 65535.0f : 255.0f);
    const Colour fill = background.value_or(Colour{});
    set(resolve_program_, "background",
        glm::vec4(fill.r / 255.0f, fill.g / 255.0f, fill.b / 255.0f, background ? 1.0f : 0.0f));
    glBindTexture(GL_TEXTURE_2D, layer_.texture.name());
    glBindVertexArray(empty_array_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);

    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ROW_LENGTH, image.width);
    const std::size_t first = (std::size_t(top) * std::size_t(image.width) + std::size_t(left)) * 4;
    std::visit(
        [&](auto& samples_of) {
            glReadPixels(0, 0, view.width, view.height, GL_RGBA_INTEGER,
                         deep ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, samples_of.data() + first);
        },
        image.rgba);
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    check_gl("reading the picture back");
}

GLuint Renderer::display(const View& view, const DisplayColours& colours, double square, bool lines) {
    resize(shown_, view.width, view.height, GL_RGBA8);
    begin(shown_, view.first_column);
    glUseProgram(display_program_.name());
    const glm::dvec2 corner = -view.origin * view.scale;
    const glm::dvec2 opposite = corner + glm::dvec2(picture_.width, picture_.height) * view.scale;
    set(display_program_, "layer", 0);
    set(display_program_, "frame", glm::vec4(corner.x, corner.y, opposite.x, opposite.y));
    set(display_program_, "square", float(square));
    set(display_program_, "light", colours.light);
    set(display_program_, "dark", colours.dark);
    set(display_program_, "canvas", colours.canvas);
    glBindTexture(GL_TEXTURE_2D, layer_.texture.name());
    glBindVertexArray(empty_array_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    if (lines) draw_lines(view, colours.lines);
    check_gl("showing the picture");
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return shown_.texture.name();
}

void Renderer::draw_lines(const View& view, glm::vec4 colour) {
    glBindVertexArray(mesh_array_.name());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, edges_.name());
    if (edge_count_ == 0) {
        std::vector<std::array<std::uint32_t, 2>> edges;
        edges.reserve(triangle_places_.size());
        for (std::size_t i = 0; i < triangle_places_.size(); ++i) {
            const std::uint32_t from = triangle_places_[i], to = triangle_places_[i % 3 == 2 ? i - 2 : i + 1];
            edges.push_back({std::min(from, to), std::max(from, to)});
        }
        std::sort(edges.begin(), edges.end());
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(edges.size() * sizeof(edges[0])), edges.data(),
                     GL_STATIC_DRAW);
        edge_count_ = edges.size();
    }
    const GlProgram& program = blend_centre_ ? lines_dlb_program_ : lines_program_;
    glUseProgram(program.name());
    set_view(program, view, 1);
    bind_blend(program);
    set(program, "colour", colour);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDrawElements(GL_LINES, GLsizei(edge_count_ * 2), GL_UNSIGNED_INT, nullptr);
    glDisable(GL_BLEND);
}

}  // namespace probewarp
