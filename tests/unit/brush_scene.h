// A picture to let dabs fall on, and what a mask has at a texel, for the tests of the brush.
#pragma once

#include <variant>
#include <vector>

#include "model/brush.h"

namespace probewarp::testing {

/// A picture of 512 x 512 over 64 x 64 cells, with a paint map of a texel a pixel.
struct BrushScene {
    Image image;
    Mesh mesh;
    std::vector<glm::vec2> now;
    PaintMap map = new_paint_map(512, 512);
    PictureFrame frame{{256, 256}, 512};

    BrushScene() : mesh(grid_mesh(512, 512, 64)), now(mesh.rest) {
        image.width = image.height = 512;
        image.rgba = std::vector<std::uint8_t>(std::size_t{512} * 512 * 4, 255);
    }
    void set_alpha(int x, int y, std::uint8_t alpha) {
        std::get<0>(image.rgba)[(std::size_t(y) * 512 + std::size_t(x)) * 4 + 3] = alpha;
    }
    template <class Where>
    void move(const Where& where) {
        for (std::size_t i = 0; i < now.size(); ++i) now[i] = where(glm::dvec2(mesh.rest[i]));
    }
    Mask dab_at(glm::dvec2 centre, const Brush& brush) const {
        return dab_mask(map, frame, mesh, now, image, brush, centre);
    }
};

inline Brush round_brush(double radius, double hardness = 0) {
    Brush brush;
    brush.radius = radius;
    brush.hardness = hardness;
    return brush;
}

inline float strength_at(const Mask& mask, int x, int y) {
    x -= mask.left, y -= mask.top;
    if (x < 0 || y < 0 || x >= mask.width || y >= mask.height) return 0;
    return mask.strength[std::size_t(y) * std::size_t(mask.width) + std::size_t(x)];
}

}  // namespace probewarp::testing
