// Exporting: what a deformed document looks like as a picture of its own, rendered tile by tile.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "model/deformation.h"
#include "render/footprints.h"
#include "render/renderer.h"

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
    bool overlay = false;              ///< with the renderer's overlay over the picture
};

/// What the whole export shows. Throws Error where it would be larger than a picture may be.
View export_view(const Document& document, const Deformation& deformation, const ExportSettings& settings);

/// One export under way: the renderer must hold the document's picture and deformed mesh, and be left alone
/// until done. Tiles keep each step short and the size unlimited by textures.
class ExportJob {
  public:
    ExportJob(Renderer& renderer, const Document& document, const Deformation& deformation,
              const ExportSettings& settings);

    bool done() const { return next_ == tiles_[0] * tiles_[1]; }
    double progress() const { return double(next_) / (tiles_[0] * tiles_[1]); }
    /// As far as it is rendered: rows [0, finished_rows()) are final. Stays where it is until take().
    const Image& image() const { return image_; }
    int finished_rows() const { return std::min(next_ / tiles_[0] * tile_[1], view_.height); }
    /// Renders the next tile.
    void step();
    /// The exported picture, with the original's depth, colour profile and resolution. Requires done().
    Image take();

  private:
    Renderer& renderer_;
    ExportSettings settings_;
    View view_;
    Image image_;
    std::vector<Footprint> shrunk_;
    std::array<int, 2> tile_{};   ///< width and height of a tile, exported pixels
    std::array<int, 2> tiles_{};  ///< along x and y
    int next_ = 0;
};

}  // namespace probewarp
