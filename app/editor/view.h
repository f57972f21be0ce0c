// How the canvas shows the picture's plane: a zoom and a place, and the arithmetic between the two.
#pragma once

#include <glm/vec2.hpp>

namespace probewarp {

inline constexpr double least_zoom = 0.01, most_zoom = 64;

/// Canvas pixels have their origin at the canvas's top-left corner.
struct CanvasView {
    glm::dvec2 corner{0};  ///< canvas pixels: where the image's top-left corner is
    double zoom = 1;       ///< canvas pixels per image pixel
    friend bool operator==(const CanvasView&, const CanvasView&) = default;
};

glm::dvec2 to_canvas(const CanvasView& view, glm::dvec2 image_point);
glm::dvec2 to_image(const CanvasView& view, glm::dvec2 canvas_point);

/// Zooms by `factor` (within the limits) and keeps what is under `fixed` (canvas pixels) where it is.
void zoom_at(CanvasView& view, glm::dvec2 fixed, double factor);

/// The whole image in the middle of the canvas with a margin, never larger than `most` canvas pixels per
/// image pixel.
CanvasView fitted(glm::dvec2 image_size, glm::dvec2 canvas_size, double margin, double most);

}  // namespace probewarp
