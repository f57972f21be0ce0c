#include "render/renderer.h"

#include <fmt/format.h>
#include <shaders/embedded.h>

#include <algorithm>
#include <cassert>

namespace probewarp {

namespace {

template <class Sample>
std::vector<Sample> half_size(const std::vector<Sample>& from, int width, int height) {
    const int half_width = std::max(1, width / 2), half_height = std::max(1, height / 2);
    std::vector<Sample> to(std::size_t(half_width) * std::size_t(half_height) * 4);
    for (int y = 0; y < half_height; ++y)
        for (int x = 0; x < half_width; ++x) {
            const int right = std::min(2 * x + 1, width - 1), below = std::min(2 * y + 1, height - 1);
            std::uint64_t sum[4]{}, plain[3]{};
            for (const auto& [px, py] :
                 {std::array{2 * x, 2 * y}, {right, 2 * y}, {2 * x, below}, {right, below}}) {
                const Sample* p = &from[(std::size_t(py) * std::size_t(width) + std::size_t(px)) * 4];
                for (int k = 0; k < 3; ++k) sum[k] += std::uint64_t(p[k]) * p[3], plain[k] += p[k];
                sum[3] += p[3];
            }
            Sample* q = &to[(std::size_t(y) * std::size_t(half_width) + std::size_t(x)) * 4];
            for (int k = 0; k < 3; ++k)
                q[k] = Sample(sum[3] > 0 ? (sum[k] + sum[3] / 2) / sum[3] : (plain[k] + 2) / 4);
            q[3] = Sample((sum[3] + 2) / 4);
        }
    return to;
}

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
void begin(const Target& target) {
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.name());
    glViewport(0, 0, target.width, target.height);
    glDisable(GL_SCISSOR_TEST);
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

std::vector<Image> smaller_levels(const Image& image) {
    std::vector<Image> levels;
    const Image* from = &image;
    while (from->width > 1 || from->height > 1) {
        Image next;
        next.width = std::max(1, from->width / 2);
        next.height = std::max(1, from->height / 2);
        std::visit([&](const auto& samples) { next.rgba = half_size(samples, from->width, from->height); },
                   from->rgba);
        levels.push_back(std::move(next));
        from = &levels.back();
    }
    return levels;
}

GlTexture preview_texture(const Image& image) {
    GlTexture texture = make_texture();
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width, image.height, 0, GL_RGBA,
                 image.bits() == 16 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, pixel_bytes(image).data());
    glGenerateMipmap(GL_TEXTURE_2D);
    return texture;
}

void clear_window(int width, int height, glm::vec3 colour) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(colour.x, colour.y, colour.z, 1);
    glClear(GL_COLOR_BUFFER_BIT);
}

void check_texture_size(const Image& image) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    if (image.width > largest || image.height > largest)
        throw Error(fmt::format("the picture is {} x {} pixels; this graphics driver holds at most {} x {}",
                                image.width, image.height, largest, largest));
}

PictureUpload::PictureUpload(const Image& image, std::span<const Image> levels)
    : image_(image), levels_(levels) {
    check_texture_size(image);
    texture_ = {make_texture(), image.width, image.height, int(levels.size())};
    glBindTexture(GL_TEXTURE_2D, texture_.texture.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, texture_.last_level);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    for (int level = 0; level <= texture_.last_level; ++level) {
        const Image& from = level == 0 ? image : levels[std::size_t(level) - 1];
        glTexImage2D(GL_TEXTURE_2D, level, image.bits() == 16 ? GL_RGBA16 : GL_RGBA8, from.width, from.height,
                     0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    }
    check_gl("making room for the picture");
}

void PictureUpload::step() {
    assert(!done());
    const Image& from = level_ == 0 ? image_ : levels_[std::size_t(level_) - 1];
    const int rows = std::clamp((1 << 20) / from.width, 1, from.height - row_);
    const bool deep = from.bits() == 16;
    const std::size_t row_bytes = std::size_t(from.width) * (deep ? 8 : 4);
    glBindTexture(GL_TEXTURE_2D, texture_.texture.name());
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glTexSubImage2D(GL_TEXTURE_2D, level_, 0, row_, from.width, rows, GL_RGBA,
                    deep ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE,
                    pixel_bytes(from).data() + std::size_t(row_) * row_bytes);
    check_gl("uploading the picture");
    row_ += rows;
    if (row_ == from.height) row_ = 0, ++level_;
}

PictureTexture PictureUpload::take() {
    assert(done());
    return std::move(texture_);
}

PictureTexture upload_picture(const Image& image) {
    const std::vector<Image> levels = smaller_levels(image);
    PictureUpload upload(image, levels);
    while (!upload.done()) upload.step();
    return upload.take();
}

Renderer::Renderer()
    : mesh_program_(make_program(shaders::mesh_vert, shaders::mesh_frag)),
      mesh_dlb_program_(make_program(shaders::mesh_dlb_vert, shaders::mesh_frag)),
      resolve_program_(make_program(shaders::screen_vert, shaders::resolve_frag)),
      display_program_(make_program(shaders::screen_vert, shaders::display_frag)),
      lines_program_(make_program(shaders::mesh_vert, shaders::lines_frag)),
      lines_dlb_program_(make_program(shaders::mesh_dlb_vert, shaders::lines_frag)),
      mesh_array_(make_vertex_array()),
      empty_array_(make_vertex_array()),
      rest_(make_buffer()),
      now_(make_buffer()),
      triangles_(make_buffer()),
      edges_(make_buffer()),
      weights_(make_buffer()),
      transformations_(make_buffer()),
      weights_texture_(make_texture()),
      transformations_texture_(make_texture()) {}

void Renderer::set_picture(PictureTexture picture) { picture_ = std::move(picture); }

void Renderer::set_mesh(const Mesh& mesh) {
    glBindVertexArray(mesh_array_.name());
    upload_vertices(rest_, mesh.rest, 0, GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(mesh.triangles.size() * sizeof(std::uint32_t)),
                 mesh.triangles.data(), GL_STATIC_DRAW);
    triangle_places_ = mesh.triangles;
    edge_count_ = 0;
    set_positions(mesh.rest);
}

void Renderer::set_positions(std::span<const glm::vec2> now) {
    glBindVertexArray(mesh_array_.name());
    upload_vertices(now_, now, 1, GL_STREAM_DRAW);
    blend_centre_.reset();
    check_gl("uploading the mesh");
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

void Renderer::draw(const View& view, int samples) {
    // Float, because the sums of weighted colours must give every byte of a file back.
    resize(layer_, view.width * samples, view.height * samples, GL_RGBA32F);
    begin(layer_);
    const GLfloat nothing[4]{};
    glClearBufferfv(GL_COLOR, 0, nothing);
    const GlProgram& program = blend_centre_ ? mesh_dlb_program_ : mesh_program_;
    glUseProgram(program.name());
    set_view(program, view, samples);
    bind_blend(program);
    set(program, "picture", 0);
    set(program, "last_level", picture_.last_level);
    glBindTexture(GL_TEXTURE_2D, picture_.texture.name());
    // Where the mesh folds, a later triangle lies over an earlier one.
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glBindVertexArray(mesh_array_.name());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_.name());
    glDrawElements(GL_TRIANGLES, GLsizei(triangle_places_.size()), GL_UNSIGNED_INT, nullptr);
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
    begin(shown_);
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
