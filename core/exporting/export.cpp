#include "exporting/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "model/error.h"

namespace probewarp {

namespace {

/// Rows of samples in a band: enough for all cores, few enough that what is drawn is soon encoded.
constexpr int band_sample_rows = 256;

struct Box {
    glm::dvec2 least, most;  ///< image pixels
};

/// The whole pixels that hold the deformed mesh and what stays under it.
Box bounds(const Deformation& deformation) {
    glm::dvec2 least(deformation.now.front()), most(least);
    for (const std::span<const glm::vec2> points :
         {std::span(deformation.now), std::span(deformation.binding->still.corners)})
        for (const glm::vec2 point : points) {
            least = {std::min(least.x, double(point.x)), std::min(least.y, double(point.y))};
            most = {std::max(most.x, double(point.x)), std::max(most.y, double(point.y))};
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

View export_view(const Deformation& deformation, const ExportSettings& settings) {
    const Image& image = deformation.source.picture->image;
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

namespace {

/// Whether the deformed picture covers the centre of every pixel of the view for sure: each of its sides has
/// stayed beyond the view's, or on it.
bool covers(const Deformation& deformation, const View& view) {
    const Image& picture = deformation.source.picture->image;
    const glm::dvec2 hair = 0.49 / view.scale, least = view.origin + hair,
                     most = view.origin + glm::dvec2(view.width, view.height) / view.scale - hair;
    if (!deformation.moved)
        return least.x >= 0 && least.y >= 0 && most.x <= picture.width && most.y <= picture.height;
    const Mesh& mesh = mesh_of(deformation);
    for (std::size_t v = 0; v < mesh.rest.size(); ++v) {
        const glm::dvec2 rest(mesh.rest[v]), now(deformation.now[v]);
        if ((rest.x <= 0 && now.x > least.x) || (rest.y <= 0 && now.y > least.y) ||
            (rest.x >= picture.width && now.x < most.x) || (rest.y >= picture.height && now.y < most.y))
            return false;
    }
    return true;
}

Image blank(const Image& like, int rows) {
    Image image = like;
    image.height = rows;
    const std::size_t samples = std::size_t(like.width) * std::size_t(rows) * 4;
    std::visit([samples](auto& rgba) { rgba.resize(samples); }, image.rgba);
    return image;
}

}  // namespace

std::optional<std::array<std::int32_t, 2>> exported_offset(const View& view, const Description& original) {
    const auto at = original.offset.value_or(std::array<std::int32_t, 2>{});
    const std::array offset{std::round((at[0] + view.origin.x) * view.scale.x),
                            std::round((at[1] + view.origin.y) * view.scale.y)};
    constexpr double furthest = std::numeric_limits<std::int32_t>::max();
    if (std::abs(offset[0]) > furthest || std::abs(offset[1]) > furthest) return {};
    return std::array{std::int32_t(offset[0]), std::int32_t(offset[1])};
}

FileStyle file_style(const ExportSettings& settings) {
    assert(settings.samples >= 1 && settings.samples <= max_samples);
    return {settings.samples, settings.background, settings.overlay};
}

ExportJob::ExportJob(PictureDrawer& drawer, const Deformation& deformation, const View& view,
                     const FileStyle& style)
    : drawer_(drawer),
      may_be_transparent_(!style.background && !(drawer.is_opaque() && covers(deformation, view))),
      band_rows_(std::max(1, band_sample_rows / style.samples)) {
    const Image& original = deformation.source.picture->image;
    like_.width = view.width;
    like_.height = view.height;
    like_.description = original.description;
    const auto offset = exported_offset(view, original.description);
    const bool is_said = original.description.offset || offset != std::array<std::int32_t, 2>{};
    like_.description.offset = is_said ? offset : std::nullopt;
    if (original.bits() == 16) like_.rgba = std::vector<std::uint16_t>();
}

Image ExportJob::next_band() {
    assert(!done());
    Image band = blank(like_, std::min(band_rows_, like_.height - next_row_));
    drawer_.draw_rows(next_row_, band);
    next_row_ += band.height;
    return band;
}

}  // namespace probewarp
