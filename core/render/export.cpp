#include "render/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace probewarp {

namespace {

/// Texels along a tile's sides: wide and low, so that whole rows are soon done. They are constants, so that
/// the same document gives the same bytes everywhere.
constexpr int layer_width = 4096, layer_height = 256;

struct Box {
    glm::dvec2 least, most;  ///< image pixels
};

/// The whole pixels that hold the deformed mesh.
Box bounds(const Deformation& deformation) {
    glm::dvec2 least(deformation.now.front()), most(least);
    for (const glm::vec2 vertex : deformation.now) {
        least = {std::min(least.x, double(vertex.x)), std::min(least.y, double(vertex.y))};
        most = {std::max(most.x, double(vertex.x)), std::max(most.y, double(vertex.y))};
    }
    // A vertex that rounding put a hair beyond a pixel's edge does not add a pixel.
    constexpr double hair = 1.0 / 512;
    return {{std::floor(least.x + hair), std::floor(least.y + hair)},
            {std::ceil(most.x - hair), std::ceil(most.y - hair)}};
}

void check_export_size(double width, double height, int bits) {
    if (width > max_image_side || height > max_image_side ||
        width * height * 4 * (bits / 8) > double(max_image_bytes))
        throw Error(fmt::format(
            "the export would be {:.0f} x {:.0f} pixels; at most {} along a side and {} million "
            "in all fit: choose a smaller scale",
            width, height, max_image_side, max_image_bytes / std::size_t(4 * (bits / 8)) / 1000000));
}

}  // namespace

View export_view(const Document& document, const Deformation& deformation, const ExportSettings& settings) {
    const Image& image = document.picture->image;
    Box box{{0, 0}, {image.width, image.height}};
    if (settings.canvas == Canvas::fit) box = bounds(deformation);
    const glm::dvec2 extent{std::max(1.0, box.most.x - box.least.x), std::max(1.0, box.most.y - box.least.y)};
    View view;
    if (settings.size) {
        const glm::dvec2 size{(*settings.size)[0], (*settings.size)[1]};
        check_export_size(size.x, size.y, image.bits());
        const double scale = std::min(size.x / extent.x, size.y / extent.y);
        view.scale = glm::dvec2(scale);
        view.origin = box.least - (size / scale - extent) / 2.0;
        view.width = int(size.x);
        view.height = int(size.y);
        return view;
    }
    const glm::dvec2 size{std::max(1.0, std::round(extent.x * settings.scale)),
                          std::max(1.0, std::round(extent.y * settings.scale))};
    check_export_size(size.x, size.y, image.bits());
    view.origin = box.least;
    view.scale = size / extent;
    view.width = int(size.x);
    view.height = int(size.y);
    return view;
}

ExportJob::ExportJob(Renderer& renderer, const Document& document, const Deformation& deformation,
                     const ExportSettings& settings)
    : renderer_(renderer), settings_(settings), view_(export_view(document, deformation, settings)) {
    assert(settings.samples >= 1 && settings.samples <= max_samples);
    const Image& original = document.picture->image;
    image_.width = view_.width;
    image_.height = view_.height;
    image_.icc = original.icc;
    image_.resolution = original.resolution;
    const std::size_t samples = std::size_t(view_.width) * std::size_t(view_.height) * 4;
    if (original.bits() == 16)
        image_.rgba = std::vector<std::uint16_t>(samples);
    else
        image_.rgba = std::vector<std::uint8_t>(samples);
    tile_ = {layer_width / settings.samples, layer_height / settings.samples};
    tiles_ = {(view_.width + tile_[0] - 1) / tile_[0], (view_.height + tile_[1] - 1) / tile_[1]};
    shrunk_ = shrunk_triangles(deformation, view_);
}

void ExportJob::step() {
    assert(!done());
    const int left = next_ % tiles_[0] * tile_[0], top = next_ / tiles_[0] * tile_[1];
    View tile = view_;
    tile.origin += glm::dvec2(left, top) / view_.scale;
    tile.width = std::min(tile_[0], view_.width - left);
    tile.height = std::min(tile_[1], view_.height - top);
    renderer_.render(image_, left, top, tile,
                     {settings_.samples, settings_.background, settings_.overlay, any_within(shrunk_, tile)});
    ++next_;
}

Image ExportJob::take() {
    assert(done());
    return std::move(image_);
}

}  // namespace probewarp
