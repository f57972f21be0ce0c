// What draws a deformed picture for a file: the processor (Rasterizer), or a graphics driver.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "model/image.h"
#include "model/probe.h"

namespace probewarp {

/// What a target shows: target pixel t is the point origin + t / scale of the image's plane.
struct View {
    glm::dvec2 origin{0};  ///< image pixels
    glm::dvec2 scale{1};   ///< target pixels per image pixel, > 0
    int width = 0;         ///< of the target, pixels
    int height = 0;
};

/// How a picture for a file is drawn.
struct FileStyle {
    int samples = 1;                   ///< samples x samples a target pixel
    std::optional<Colour> background;  ///< empty: as transparent as it is
    bool overlay = false;              ///< with what lies over the picture; only drivers draw that
};

/// Draws one view of one deformed picture.
class PictureDrawer {
  public:
    virtual ~PictureDrawer() = default;
    /// Whether the picture is, everywhere.
    virtual bool is_opaque() const = 0;

    /// Draws the view's rows from `first_row` on, as many as the band has. band: as wide as the view and as
    /// deep as the picture
    virtual void draw_rows(int first_row, Image& band) = 0;
};

}  // namespace probewarp
