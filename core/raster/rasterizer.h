// The deformed picture drawn by the processor's vector units, without a graphics driver: one that has no card
// takes several times as long.
#pragma once

#include <array>
#include <vector>

#include "model/mesh.h"
#include "raster/triangles.h"

namespace probewarp {

/// The values are those of shaders/mesh.frag but for rounding.
class Rasterizer final : public PictureDrawer {
  public:
    /// picture: must outlive it. most_levels: that many mipmaps are made at most
    Rasterizer(const Image& picture, int most_levels);

    /// mesh, now (#vertices, image pixels): must outlive it. Where the mesh has not `moved`, all of the
    /// picture is drawn as it is.
    void set_mesh(const Mesh& mesh, std::span<const glm::vec2> now, bool moved);

    bool is_opaque() const override { return opaque_; }

    /// Without an overlay. Shared between all cores.
    void render(Image& image, int left, int top, const View& view, const FileStyle& style,
                TriangleRun triangles) override;

  private:
    Rasterizer(const Rasterizer&) = delete;
    Rasterizer& operator=(const Rasterizer&) = delete;

    const Image* picture_;
    bool opaque_;
    std::optional<Image> thick_;  ///< the picture, where it is one pixel wide or high
    std::vector<Image> smaller_;
    std::array<glm::vec2, 4> corners_;  ///< of the picture
    DeformedMesh mesh_;
    bool moved_ = false;
};

}  // namespace probewarp
