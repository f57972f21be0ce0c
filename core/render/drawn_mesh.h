// The deformed mesh as the graphics driver holds it: where its vertices rest and where they are now, whoever
// moved them. Only what has changed is handed over.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "math/dual_complex.h"
#include "model/mesh.h"
#include "render/gl_objects.h"
#include "render/mesh_detail.h"

namespace probewarp {

/// What of the mesh's triangles is drawn.
enum class Fineness {
    all,
    seen,  ///< fewer and larger ones where the mesh is finer than the target
};

/// Vertex attributes: 0 is the rest and 1 the place now, both image pixels.
class DrawnMesh {
  public:
    DrawnMesh();

    /// At rest, until it is moved. Lets go of the weights: they were another mesh's.
    void set_mesh(std::shared_ptr<const Mesh> mesh);

    /// As the processor moved it. Uploads the run from the first to the last vertex that changed; nothing if
    /// none did. now: #vertices, image pixels, or none: nothing is changed
    void set_positions(std::span<const glm::vec2> now);

    /// Keeps the weights for `move`, until the next mesh. weights: #vertices x #probes, row-major, or none:
    /// lets go of them. Throws Error where the driver has no buffer that large.
    void set_weights(std::span<const float> weights);
    /// Has the vertex shader move each vertex once, by DLB of the weights, which must be as many as these
    /// need. transformations: #probes, about `centre`
    void move(std::span<const DualComplex<float>> transformations, glm::vec2 centre);

    /// One more attribute, of `components` floats a vertex. values: #vertices x components floats
    void set_attribute(GLuint location, std::span<const std::byte> values, int components);

    /// Draws what may show in the view; larger triangles only where their sides are not longer than that many
    /// target pixels. Where the mesh folds, a later triangle lies over an earlier one.
    void draw(const View& view, Fineness fineness, double largest_side);
    /// The first triangle alone.
    void draw_one();
    /// Each edge once, as Fineness::seen.
    void draw_lines(const View& view, double largest_side);

    /// Triangles of the last draw: for tests.
    std::size_t drawn() const { return drawn_; }

    /// Bytes that were handed to the driver so far: for tests.
    std::size_t uploaded() const { return uploaded_; }

  private:
    void upload(GLenum target, const GlBuffer& buffer, std::span<const std::byte> bytes, GLenum usage);
    void upload_texels(const GlBuffer& buffer, const GlTexture& texture, std::span<const std::byte> bytes,
                       GLenum format);

    /// The mesh, or a coarser one, as the driver has it.
    struct Level {
        MeshDetail detail;
        GlBuffer triangles, edges;
        std::size_t edge_count = 0;  ///< 0 before the first time
    };
    Level& level_for(int stride);
    /// Null where it is not known where the mesh is now.
    const MeshBlocks* blocks();
    int stride_for_view(const View& view, double largest_side);
    void forget_blocks();

    GlVertexArray array_, rest_array_;  ///< all attributes; the rest alone
    GlBuffer rest_, now_, more_, weights_, transformations_;
    GlTexture weights_texture_, transformations_texture_;
    LazyProgram mover_;
    Target nowhere_;
    std::vector<glm::vec2> held_;       ///< what `now_` holds; empty where that is not known
    std::optional<MeshBlocks> blocks_;  ///< of `held_`, once there was need of them
    std::vector<StrideErrors> errors_;  ///< likewise
    std::shared_ptr<const Mesh> mesh_;  ///< null before the first one
    bool whole_ = false;                ///< as is_whole says
    std::vector<Level> levels_;
    std::size_t vertices_ = 0, weight_count_ = 0, uploaded_ = 0, drawn_ = 0;
};

}  // namespace probewarp
