// Exporting: what a deformed document looks like as a picture of its own, rendered tile by tile.
#pragma once

#include <array>
#include <optional>

#include "model/deformation.h"
#include "raster/footprints.h"
#include "raster/picture_drawer.h"

namespace probewarp {

enum class Canvas {
    image,  ///< the picture's own rectangle: what moved out of it is cut off
    fit,    ///< grows or shrinks to the pixels that hold all of the deformed picture
};

inline constexpr int max_samples = 16;

struct ExportSettings {
    double scale = 1;  ///< exported pixels per image pixel, > 0
    std::optional<std::array<int, 2>>
        size;         ///< width, height: the largest scale that fits, centred; overrides scale
    int samples = 1;  ///< samples x samples a pixel, in [1, max_samples]
    Canvas canvas = Canvas::image;
    std::optional<Colour> background;  ///< empty: as transparent as the picture is
    bool overlay = false;              ///< with the drawer's overlay over the picture
};

/// What the whole export shows. Throws Error where it would be larger than a picture may be.
View export_view(const Document& document, const Deformation& deformation, const ExportSettings& settings);

/// One export under way: the drawer must hold the document's picture and deformed mesh, and be left alone
/// until done. Tiles keep each step short and the size unlimited by textures.
class ExportJob {
  public:
    /// Looks at the size, depth, profile and resolution of the document's picture, not at its pixels.
    ExportJob(PictureDrawer& drawer, const Document& document, const Deformation& deformation,
              const ExportSettings& settings);

    bool done() const { return next_ == tiles_[0] * tiles_[1]; }
    double progress() const { return double(next_) / (tiles_[0] * tiles_[1]); }
    /// What is exported: its size, and the original's depth, colour profile and resolution; no pixels.
    const Image& like() const { return like_; }
    /// Whether any pixel may be less than opaque, as far as can be told without drawing.
    bool may_be_transparent() const { return may_be_transparent_; }

    /// Renders the next tile of the whole picture, for take().
    void step();
    /// The exported picture. Requires done(), by step().
    Image take();

    /// Renders the next rows, for those who cannot keep them all: as wide as the picture. Requires !done(),
    /// and no step() before.
    Image next_band();
    /// Begins again at the top.
    void restart() { next_ = 0; }

  private:
    void draw_tile(Image& into, int first_row);

    PictureDrawer& drawer_;
    ExportSettings settings_;
    View view_;
    Image like_, whole_;
    bool may_be_transparent_ = true;
    TriangleBoxes boxes_;
    std::array<int, 2> tile_{};   ///< width and height of a tile, exported pixels
    std::array<int, 2> tiles_{};  ///< along x and y
    int next_ = 0;
};

}  // namespace probewarp
