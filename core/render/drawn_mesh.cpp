#include "render/drawn_mesh.h"

#include <fmt/format.h>
#include <shaders/embedded.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>

namespace probewarp {

namespace {

void set_points(const GlBuffer& buffer, GLuint location) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    glVertexAttribPointer(location, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(location);
}

/// The vertices from the first that differs to the last.
VertexRun changed_run(std::span<const glm::vec2> before, std::span<const glm::vec2> after) {
    const auto first = std::mismatch(before.begin(), before.end(), after.begin()).first - before.begin();
    const auto same_end = std::mismatch(before.rbegin(), before.rend() - first, after.rbegin()).first;
    return {std::size_t(first), std::size_t(before.rend() - same_end - first)};
}

/// Each edge of the triangles once, from the lower vertex to the higher. corners: #triangles x 3
std::vector<std::array<std::uint32_t, 2>> edges_of(std::span<const std::uint32_t> corners,
                                                   std::size_t vertices) {
    const auto edge = [&](std::size_t i) {
        const std::uint32_t from = corners[i], to = corners[i % 3 == 2 ? i - 2 : i + 1];
        return std::array{std::min(from, to), std::max(from, to)};
    };
    // The higher ends, sorted by the lower ones: each of these has but a few.
    std::vector<std::size_t> first(vertices + 1);
    for (std::size_t i = 0; i < corners.size(); ++i) ++first[edge(i)[0] + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> ends(corners.size());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < corners.size(); ++i) ends[next[edge(i)[0]]++] = edge(i)[1];
    std::vector<std::array<std::uint32_t, 2>> edges;
    edges.reserve(corners.size() / 2 + vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        const auto own = std::span(ends).subspan(first[v], first[v + 1] - first[v]);
        std::ranges::sort(own);
        const auto repeated = std::ranges::unique(own);
        for (const std::uint32_t end : own.first(own.size() - repeated.size()))
            edges.push_back({std::uint32_t(v), end});
    }
    return edges;
}

void bind_texels(const GlProgram& program, const char* name, GLint unit, const GlTexture& texture) {
    glUniform1i(uniform(program, name), unit);
    glActiveTexture(GLenum(GL_TEXTURE0 + unit));
    glBindSampler(GLuint(unit), 0);
    glBindTexture(GL_TEXTURE_BUFFER, texture.name());
}

}  // namespace

DrawnMesh::DrawnMesh()
    : array_(make_vertex_array()),
      rest_array_(make_vertex_array()),
      rest_(make_buffer()),
      now_(make_buffer()),
      more_(make_buffer()),
      weights_(make_buffer()),
      transformations_(make_buffer()),
      weights_texture_(make_texture()),
      transformations_texture_(make_texture()),
      mover_([] { return make_feedback_program(shaders::deform_vert, "now"); }) {}

void DrawnMesh::upload(GLenum target, const GlBuffer& buffer, std::span<const std::byte> bytes,
                       GLenum usage) {
    glBindBuffer(target, buffer.name());
    glBufferData(target, GLsizeiptr(bytes.size()), bytes.data(), usage);
    uploaded_ += bytes.size();
}

void DrawnMesh::set_mesh(std::shared_ptr<const Mesh> mesh) {
    mesh_ = std::move(mesh);
    whole_ = is_whole(*mesh_);
    vertices_ = mesh_->rest.size();
    upload(GL_ARRAY_BUFFER, rest_, std::as_bytes(std::span(mesh_->rest)), GL_STATIC_DRAW);
    glBindVertexArray(rest_array_.name());
    set_points(rest_, 0);
    glBindVertexArray(array_.name());
    set_points(rest_, 0);
    set_points(now_, 1);
    levels_.clear();
    if (weight_count_ > 0) set_weights({});
    held_.clear();
    forget_blocks();
    set_positions(mesh_->rest);
}

void DrawnMesh::set_positions(std::span<const glm::vec2> now) {
    if (now.empty()) return;
    assert(now.size() == vertices_);
    const VertexRun run = held_.size() == now.size() ? changed_run(held_, now) : VertexRun{0, now.size()};
    const auto bytes = std::as_bytes(now.subspan(run.first, run.count));
    // A part of the buffer has to wait for what is still drawn from it; most of it is better replaced.
    if (run.count > now.size() / 2) {
        upload(GL_ARRAY_BUFFER, now_, std::as_bytes(now), GL_STREAM_DRAW);
    } else if (run.count > 0) {
        glBindBuffer(GL_ARRAY_BUFFER, now_.name());
        glBufferSubData(GL_ARRAY_BUFFER, GLintptr(run.first * sizeof(now[0])), GLsizeiptr(bytes.size()),
                        bytes.data());
        uploaded_ += bytes.size();
    }
    if (run.count > 0) forget_blocks();
    held_.resize(now.size());
    std::copy_n(now.begin() + std::ptrdiff_t(run.first), run.count,
                held_.begin() + std::ptrdiff_t(run.first));
    check_gl("uploading the mesh");
}

void DrawnMesh::upload_texels(const GlBuffer& buffer, const GlTexture& texture,
                              std::span<const std::byte> bytes, GLenum format) {
    upload(GL_TEXTURE_BUFFER, buffer, bytes, GL_STREAM_DRAW);
    glBindTexture(GL_TEXTURE_BUFFER, texture.name());
    glTexBuffer(GL_TEXTURE_BUFFER, format, buffer.name());
}

void DrawnMesh::set_weights(std::span<const float> weights) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &largest);
    if (weights.size() > std::size_t(largest))
        throw Error(
            fmt::format("{} weights are more than the {} that this graphics driver's shaders can read",
                        weights.size(), largest));
    weight_count_ = 0;  // should the driver have no memory
    upload_texels(weights_, weights_texture_, std::as_bytes(weights), GL_R32F);
    check_gl("uploading the weights");
    weight_count_ = weights.size();
}

void DrawnMesh::move(std::span<const DualComplex<float>> transformations, glm::vec2 centre) {
    static_assert(sizeof(DualComplex<float>) == 4 * sizeof(float));
    assert(weight_count_ == vertices_ * transformations.size());
    upload_texels(transformations_, transformations_texture_, std::as_bytes(transformations), GL_RGBA32F);
    const GlProgram& program = mover_.get();
    glUseProgram(program.name());
    glUniform1i(uniform(program, "probes"), GLint(transformations.size()));
    glUniform2f(uniform(program, "centre"), centre.x, centre.y);
    bind_texels(program, "weights", 1, weights_texture_);
    bind_texels(program, "transformations", 2, transformations_texture_);
    glActiveTexture(GL_TEXTURE0);
    // A context without a surface has no framebuffer, and none draws without one, not even nothing.
    resize(nowhere_, 1, 1, GL_RGBA8);
    glBindFramebuffer(GL_FRAMEBUFFER, nowhere_.framebuffer.name());
    glBindVertexArray(rest_array_.name());
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, now_.name());
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, GLsizei(vertices_));
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    held_.clear();
    forget_blocks();
    check_gl("moving the mesh");
}

void DrawnMesh::set_attribute(GLuint location, std::span<const std::byte> values, int components) {
    assert(values.size() == vertices_ * std::size_t(components) * sizeof(float));
    glBindVertexArray(array_.name());
    upload(GL_ARRAY_BUFFER, more_, values, GL_STREAM_DRAW);
    glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(location);
    check_gl("uploading the overlay");
}

DrawnMesh::Level& DrawnMesh::level_for(int stride) {
    const auto found = std::ranges::find(levels_, stride, [](const Level& l) { return l.detail.stride; });
    if (found != levels_.end()) return *found;
    Level level{detail_of(*mesh_, stride), make_buffer(), make_buffer()};
    glBindVertexArray(array_.name());
    upload(GL_ELEMENT_ARRAY_BUFFER, level.triangles,
           std::as_bytes(std::span(triangles_of(*mesh_, level.detail))), GL_STATIC_DRAW);
    check_gl("uploading the triangles");
    return levels_.emplace_back(std::move(level));
}

const MeshBlocks* DrawnMesh::blocks() {
    if (held_.empty()) return nullptr;
    if (!blocks_) blocks_ = blocks_of(*mesh_, held_);
    return &*blocks_;
}

void DrawnMesh::forget_blocks() {
    blocks_.reset();
    errors_.clear();
}

int DrawnMesh::stride_for_view(const View& view, double largest_side) {
    const MeshBlocks* now = blocks();
    if (!now || !whole_ || !may_be_coarser(*mesh_, view, largest_side)) return 1;
    if (errors_.empty()) errors_ = stride_errors(*mesh_, held_);
    return stride_for(*mesh_, *now, errors_, view, largest_side);
}

void DrawnMesh::draw(const View& view, Fineness fineness, double largest_side) {
    const MeshBlocks* now = blocks();
    const int stride = fineness == Fineness::seen ? stride_for_view(view, largest_side) : 1;
    const Level& level = level_for(stride);
    std::vector<TriangleRun> runs{{0, level.detail.first.back()}};
    if (now) runs = visible_runs(level.detail, *now, view);
    std::vector<GLsizei> counts;
    std::vector<const void*> starts;
    drawn_ = 0;
    for (const TriangleRun run : runs) {
        counts.push_back(GLsizei(run.count * 3));
        starts.push_back(reinterpret_cast<const void*>(run.first * 3 * sizeof(std::uint32_t)));
        drawn_ += run.count;
    }
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, level.triangles.name());
    glMultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_INT, starts.data(), GLsizei(runs.size()));
}

void DrawnMesh::draw_one() {
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, level_for(1).triangles.name());
    glDrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_INT, nullptr);
}

void DrawnMesh::draw_lines(const View& view, double largest_side) {
    Level& level = level_for(stride_for_view(view, largest_side));
    glBindVertexArray(array_.name());
    if (level.edge_count == 0) {
        const auto edges = edges_of(triangles_of(*mesh_, level.detail), vertices_);
        upload(GL_ELEMENT_ARRAY_BUFFER, level.edges, std::as_bytes(std::span(edges)), GL_STATIC_DRAW);
        level.edge_count = edges.size();
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, level.edges.name());
    glDrawElements(GL_LINES, GLsizei(level.edge_count * 2), GL_UNSIGNED_INT, nullptr);
}

}  // namespace probewarp
