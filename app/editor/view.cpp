#include "editor/view.h"

#include <algorithm>
#include <cmath>

namespace probewarp {

glm::dvec2 to_canvas(const CanvasView& view, glm::dvec2 image_point) {
    return view.corner + view.zoom * image_point;
}

glm::dvec2 to_image(const CanvasView& view, glm::dvec2 canvas_point) {
    return (canvas_point - view.corner) / view.zoom;
}

void zoom_at(CanvasView& view, glm::dvec2 fixed, double factor) {
    double zoom = std::clamp(view.zoom * factor, least_zoom, most_zoom);
    if (std::abs(zoom - 1) < 1e-9)
        zoom = 1;  // pixel for pixel is exactly that, however the factors were rounded
    view.corner = fixed + (zoom / view.zoom) * (view.corner - fixed);
    view.zoom = zoom;
    if (zoom == 1) view.corner = {std::round(view.corner.x), std::round(view.corner.y)};
}

CanvasView fitted(glm::dvec2 image_size, glm::dvec2 canvas_size, double margin, double most) {
    const glm::dvec2 room{std::max(1.0, canvas_size.x - 2 * margin),
                          std::max(1.0, canvas_size.y - 2 * margin)};
    CanvasView view;
    view.zoom =
        std::clamp(std::min({room.x / image_size.x, room.y / image_size.y, most}), least_zoom, most_zoom);
    view.corner = (canvas_size - view.zoom * image_size) / 2.0;
    view.corner = {std::round(view.corner.x), std::round(view.corner.y)};
    return view;
}

}  // namespace probewarp
