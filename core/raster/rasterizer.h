// The deformed picture drawn by the processor's vector units, without a graphics driver: one that has no card
// takes several times as long.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "model/deformation.h"
#include "raster/row_drawing.h"
#include "raster/triangles.h"

namespace probewarp {

/// The values are those of shaders/mesh.frag and shaders/resolve.frag but for rounding.
class Rasterizer final : public PictureDrawer {
  public:
    /// deformation: with its document's picture must outlive it. style: without an overlay
    Rasterizer(const Deformation& deformation, const View& view, const FileStyle& style);
    Rasterizer(const Rasterizer&) = delete;
    Rasterizer& operator=(const Rasterizer&) = delete;

    bool is_opaque() const override { return opaque_; }
    /// Shared between all cores.
    void draw_rows(int first_row, Image& band) override;

  private:
    void lay_over(const StillCells& still);
    void fetch(int picture_rows);
    int rows_shown(const Rows& rows) const;
    template <class Sample>
    void draw_opaque(const Rows& rows, std::span<Pixel<Sample>> pixels) const;
    template <class Sample>
    void blend(const Rows& rows, std::span<Pixel<Sample>> pixels) const;

    const Picture& picture_;
    View samples_view_;  ///< of the samples
    FileStyle style_;
    bool opaque_;
    std::array<glm::vec2, 4> corners_;      ///< of the picture
    std::vector<glm::vec2> rest_, now_;     ///< of what stays and the mesh over it, where something stays
    std::vector<std::uint32_t> triangles_;  ///< #triangles x 3 places in rest_ and now_
    DeformedMesh mesh_;
    std::vector<Image> images_;  ///< the mipmaps, and the picture where it is one pixel wide or high
    std::vector<Level> levels_;
    int fetched_ = 0;  ///< rows of the picture that are there, with their mipmaps
    int bin_rows_;     ///< what one thread draws at a time: rows
    TriangleBins bins_;
};

}  // namespace probewarp
