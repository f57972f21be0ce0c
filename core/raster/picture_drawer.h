// What a deformed picture is drawn for a file by: the graphics driver (Renderer) or the processor itself
// (Rasterizer), to the same values but for rounding.
#pragma once

#include <cstddef>
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
    int first_column = 0;  ///< of the target: what is left of it stays as it was
};

/// How a picture for a file is drawn.
struct FileStyle {
    int samples = 1;                   ///< samples x samples a target pixel
    std::optional<Colour> background;  ///< empty: as transparent as it is
    bool overlay = false;
};

/// Some of the mesh's triangles, one after the other.
struct TriangleRun {
    std::size_t first = 0, count = 0;
};

/// Holds a picture and its deformed mesh.
class PictureDrawer {
  public:
    virtual ~PictureDrawer() = default;
    /// Whether the picture is, everywhere.
    virtual bool is_opaque() const = 0;

    /// Draws the view at (left, top) of `image`, whose depth it takes. triangles: at least those that show in
    /// the view; of no meaning where the mesh has not moved
    virtual void render(Image& image, int left, int top, const View& view, const FileStyle& style,
                        TriangleRun triangles) = 0;
};

}  // namespace probewarp
