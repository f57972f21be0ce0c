// Exporting: what a deformed document looks like as a picture of its own, drawn band by band.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "model/deformation.h"
#include "raster/picture_drawer.h"

namespace probewarp {

enum class Canvas {
    image,  ///< the picture's own rectangle: what moved out of it is cut off
    fit,    ///< grows or shrinks to the pixels that hold all of the deformed picture, and what stays under it
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

/// What the export of a deformed document shows. Throws Error where it would be larger than a picture may be.
View export_view(const Deformation& deformation, const ExportSettings& settings);

/// Where the export's top-left corner lies on the canvas on which the original says that it lies, or else
/// from the picture's own corner: exported pixels. Empty where that is further off than a file can say.
std::optional<std::array<std::int32_t, 2>> exported_offset(const View& view, const Description& original);

FileStyle file_style(const ExportSettings& settings);

/// One export under way, in bands of whole rows.
class ExportJob {
  public:
    /// drawer: of the deformation, in this view and style; left alone until done
    ExportJob(PictureDrawer& drawer, const Deformation& deformation, const View& view,
              const FileStyle& style);

    bool done() const { return next_row_ == like_.height; }
    double progress() const { return double(next_row_) / like_.height; }
    /// What is exported: its size, and the original's depth and description, but for the offset: that is
    /// exported_offset, which an original without one gets only where it is not 0, 0. No pixels.
    const Image& like() const { return like_; }
    /// Whether any pixel may be less than opaque, as far as can be told without drawing.
    bool may_be_transparent() const { return may_be_transparent_; }

    /// Draws the next rows. Requires !done().
    Image next_band();
    /// Begins again at the top.
    void restart() { next_row_ = 0; }

  private:
    PictureDrawer& drawer_;
    Image like_;
    bool may_be_transparent_ = true;
    int band_rows_;
    int next_row_ = 0;
};

}  // namespace probewarp
