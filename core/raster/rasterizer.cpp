#include "raster/rasterizer.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <type_traits>

#include "raster/mipmaps.h"
#include "raster/row_drawing.h"

namespace probewarp {

namespace {

bool is_thin(const Image& image) { return image.width == 1 || image.height == 1; }

/// The image with a second row or column like the first where it has but one: between two pixels everything
/// is looked up.
Image thickened(const Image& image) {
    Image thick;
    thick.width = std::max(2, image.width);
    thick.height = std::max(2, image.height);
    std::visit(
        [&](const auto& from) {
            std::remove_cvref_t<decltype(from)> to;
            for (int y = 0; y < thick.height; ++y)
                for (int x = 0; x < thick.width; ++x) {
                    const int row = std::min(y, image.height - 1), column = std::min(x, image.width - 1);
                    const auto pixel = from.begin() + (std::ptrdiff_t(row) * image.width + column) * 4;
                    to.insert(to.end(), pixel, pixel + 4);
                }
            thick.rgba = std::move(to);
        },
        image.rgba);
    return thick;
}

std::vector<Level> levels_of(const Image& picture, std::span<const Image> smaller) {
    std::vector<Level> levels;
    const auto add = [&](const Image& image) {
        levels.push_back({pixel_bytes(image).data(), image.width, image.height});
    };
    add(picture);
    for (const Image& image : smaller) add(image);
    return levels;
}

/// What is drawn beside the picture.
template <class Sample>
Pixel<Sample> filling(std::optional<Colour> background) {
    if (!background) return {};
    constexpr int one = std::numeric_limits<Sample>::max() / 255;
    return {Sample(background->r * one), Sample(background->g * one), Sample(background->b * one),
            std::numeric_limits<Sample>::max()};
}

/// Where a drawing goes.
template <class Sample>
struct Canvas {
    Pixel<Sample>* pixels;   ///< the view's first
    std::size_t row_pixels;  ///< from row to row

    std::span<Pixel<Sample>> row(int row, int width) const {
        return {pixels + std::size_t(row) * row_pixels, std::size_t(width)};
    }
};

/// What is drawn, and how.
struct Drawing {
    DeformedMesh mesh;
    TriangleRun triangles;
    std::vector<Level> levels;
    View view;
    FileStyle style;
};

/// Rows of an opaque picture at one sample a pixel, which leaves nothing to blend.
template <class Sample>
void draw_rows(const Drawing& d, const Rows& rows, const Canvas<Sample>& canvas) {
    const auto spans = scan_convert(d.mesh, d.triangles, d.view, rows, int(d.levels.size()) - 1);
    const Pixel<Sample> nothing = filling<Sample>(d.style.background);
    RowLookups room(std::size_t(d.view.width));
    for (int row = rows.first; row < rows.end; ++row)
        draw_row(d.levels, spans[std::size_t(row - rows.first)], room, nothing,
                 canvas.row(row, d.view.width));
}

/// Adds up each pixel's `samples` weighted colours, which lie side by side.
void add_samples(const std::vector<float>& layer, int samples, std::vector<float>& sum) {
    const std::size_t each = std::size_t(samples);
    for (std::size_t i = 0; i + beyond_row < sum.size(); ++i)
        for (std::size_t k = 0; k < each; ++k) sum[i] += layer[i * each + k];
}

/// Rows of any picture at any number of samples.
template <class Sample>
void blend_rows(const Drawing& d, const Rows& rows, const Canvas<Sample>& canvas) {
    const int samples = d.style.samples;
    View fine = d.view;  // of the samples
    fine.scale *= double(samples);
    fine.width *= samples;
    const auto spans = scan_convert(d.mesh, d.triangles, fine, {rows.first * samples, rows.end * samples},
                                    int(d.levels.size()) - 1);
    const Pixel<Sample> background = filling<Sample>(d.style.background);
    auto of_row = spans.begin();
    for (int row = rows.first; row < rows.end; ++row) {
        LayerRow sum(std::size_t(d.view.width));
        for (int i = 0; i < samples; ++i, ++of_row) {
            LayerRow layer(std::size_t(fine.width));
            blend_row<Sample>(d.levels, *of_row, layer);
            for (const auto channel : {&LayerRow::r, &LayerRow::g, &LayerRow::b, &LayerRow::a})
                add_samples(layer.*channel, samples, sum.*channel);
        }
        resolve_row(sum, samples * samples, d.style.background ? &background : nullptr,
                    canvas.row(row, d.view.width));
    }
}

/// Rows that one thread draws at a time: of triangles that lie in several such, each works out the corners.
constexpr int rows_at_once = 32;

}  // namespace

Rasterizer::Rasterizer(const Image& picture, int most_levels)
    : picture_(&picture), opaque_(!has_alpha(picture)), smaller_(smaller_levels(picture, most_levels)) {
    if (is_thin(picture)) picture_ = &thick_.emplace(thickened(picture));
    for (Image& image : smaller_)
        if (is_thin(image)) image = thickened(image);
    const float right = float(picture.width), bottom = float(picture.height);
    corners_ = {{{0, 0}, {right, 0}, {0, bottom}, {right, bottom}}};
}

void Rasterizer::set_mesh(const Mesh& mesh, std::span<const glm::vec2> now, bool moved) {
    static constexpr std::array<std::uint32_t, 6> two_triangles{0, 1, 2, 2, 1, 3};
    moved_ = moved;
    mesh_ = moved ? DeformedMesh{mesh.rest, now, mesh.triangles}
                  : DeformedMesh{corners_, corners_, two_triangles};
}

void Rasterizer::render(Image& image, int left, int top, const View& view, const FileStyle& style,
                        TriangleRun triangles) {
    assert(!style.overlay && image.bits() == picture_->bits());
    assert(left >= 0 && top >= 0 && left + view.width <= image.width && top + view.height <= image.height);
    if (!moved_) triangles = {0, 2};
    const Drawing drawing{mesh_, triangles, levels_of(*picture_, smaller_), view, style};
    const auto draw = [&]<class Sample>(std::vector<Sample>& rgba) {
        const std::size_t row_pixels = std::size_t(image.width);
        const Canvas<Sample> canvas{
            reinterpret_cast<Pixel<Sample>*>(rgba.data()) + std::size_t(top) * row_pixels + std::size_t(left),
            row_pixels};
        const auto draw_some = opaque_ && style.samples == 1 ? draw_rows<Sample> : blend_rows<Sample>;
        using Range = oneapi::tbb::blocked_range<int>;
        oneapi::tbb::parallel_for(
            Range(0, view.height, rows_at_once),
            [&](const Range& range) {
                draw_some(drawing, {range.begin(), range.end()}, canvas);
            },
            oneapi::tbb::simple_partitioner());
    };
    std::visit(draw, image.rgba);
}

}  // namespace probewarp
