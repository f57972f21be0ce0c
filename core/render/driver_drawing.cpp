#include "render/driver_drawing.h"

#include <algorithm>

namespace probewarp {

namespace {

/// Texels along a tile's sides.
constexpr int layer_width = 4096, layer_height = 256;

}  // namespace

void DriverDrawing::draw_rows(int first_row, Image& band) {
    const int width = layer_width / style_.samples, height = layer_height / style_.samples;
    for (int top = 0; top < band.height; top += height)
        for (int left = 0; left < band.width; left += width) {
            View tile = view_;
            tile.origin += glm::dvec2(left, first_row + top) / view_.scale;
            tile.width = std::min(width, band.width - left);
            tile.height = std::min(height, band.height - top);
            renderer_.draw(tile, style_.samples, style_.overlay);
            renderer_.read_back(band, left, top, tile, style_.samples, style_.background);
        }
}

}  // namespace probewarp
