#include "raster/rasterizer.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <type_traits>

#include "raster/mipmaps.h"
#include "raster/scan_conversion.h"

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

View of_samples(View view, int samples) {
    view.scale *= double(samples);
    view.width *= samples;
    view.height *= samples;
    return view;
}

/// What is drawn beside the picture.
template <class Sample>
Pixel<Sample> filling(std::optional<Colour> background) {
    if (!background) return {};
    constexpr int one = std::numeric_limits<Sample>::max() / 255;
    return {Sample(background->r * one), Sample(background->g * one), Sample(background->b * one),
            std::numeric_limits<Sample>::max()};
}

/// Adds up each pixel's weighted colours, of which so many lie side by side.
void add_samples(const LayerRow& layer, std::size_t samples, LayerRow& sum) {
    for (const auto channel : {&LayerRow::r, &LayerRow::g, &LayerRow::b, &LayerRow::a})
        for (std::size_t i = 0; i < sum.width(); ++i)
            for (std::size_t k = 0; k < samples; ++k) (sum.*channel)[i] += (layer.*channel)[i * samples + k];
}

/// Rows of samples in a bin: few, so that a thread's spans stay in its caches, but several, since a triangle
/// is worked out in each bin that it touches.
constexpr int bin_sample_rows = 32;

}  // namespace

Rasterizer::Rasterizer(const Deformation& deformation, const View& view, const FileStyle& style)
    : picture_(*deformation.source.picture),
      samples_view_(of_samples(view, style.samples)),
      style_(style),
      opaque_(!has_alpha(picture_.image)),
      bin_rows_(std::max(1, bin_sample_rows / style.samples)) {
    assert(!style.overlay);
    const Image& image = picture_.image;
    if (deformation.moved) {
        mesh_ = {mesh_of(deformation).rest, deformation.now, mesh_of(deformation).triangles};
        if (const StillCells& still = deformation.binding->still; !still.triangles.empty()) lay_over(still);
    } else {  // all of the picture as it is, with the cells that the mesh leaves out
        static constexpr std::array<std::uint32_t, 6> two_triangles{0, 1, 2, 2, 1, 3};
        const float right = float(image.width), bottom = float(image.height);
        corners_ = {{{0, 0}, {right, 0}, {0, bottom}, {right, bottom}}};
        mesh_ = {corners_, corners_, two_triangles};
    }
    bins_ = bin_triangles(mesh_, samples_view_, bin_rows_ * style.samples);
    images_ = room_for_levels(image, wanted_levels(mesh_, samples_view_));
    if (!picture_.arriving) fetch(image.height);
}

/// Puts what stays under the mesh that moves.
void Rasterizer::lay_over(const StillCells& still) {
    rest_ = now_ = still.corners;
    triangles_ = still.triangles;
    rest_.insert(rest_.end(), mesh_.rest.begin(), mesh_.rest.end());
    now_.insert(now_.end(), mesh_.now.begin(), mesh_.now.end());
    const auto first = std::uint32_t(still.corners.size());
    std::ranges::transform(mesh_.triangles, std::back_inserter(triangles_),
                           [first](std::uint32_t corner) { return first + corner; });
    mesh_ = {rest_, now_, triangles_};
}

/// Waits for so many of the picture's rows, and works out what of the mipmaps follows from them.
void Rasterizer::fetch(int picture_rows) {
    const Image& image = picture_.image;
    if (picture_rows <= fetched_) return;
    wait_for_rows(picture_, picture_rows);
    fill_levels(image, images_, fetched_, picture_rows);
    fetched_ = picture_rows;
    if (fetched_ == image.height) {
        for (Image& mipmap : images_)
            if (is_thin(mipmap)) mipmap = thickened(mipmap);
        if (is_thin(image)) images_.insert(images_.begin(), thickened(image));
    }
    levels_.clear();
    const auto add_level = [&](const Image& level) {
        levels_.push_back({pixel_bytes(level).data(), level.width, level.height});
    };
    if (!is_thin(image)) add_level(image);
    for (const Image& mipmap : images_) add_level(mipmap);
}

/// How many of the picture's rows, from the top, show in these rows of the view, mipmaps included.
int Rasterizer::rows_shown(const Rows& rows) const {
    const Image& image = picture_.image;
    if (is_thin(image)) return image.height;
    // A thin mipmap, of which a pixel is more than half of a side, is there once it is whole.
    const double widest = std::min(image.width, image.height) / 4.0;
    using Range = oneapi::tbb::blocked_range<int>;
    const double lowest = oneapi::tbb::parallel_reduce(
        Range(rows.first / bin_rows_, (rows.end - 1) / bin_rows_ + 1), 1.0,
        [&](const Range& bins, double so_far) {
            for (int bin = bins.begin(); bin < bins.end(); ++bin)
                so_far = std::max(
                    so_far, lowest_lookup(mesh_, bins_.bin(std::size_t(bin)), samples_view_,
                                          {rows.first * style_.samples, rows.end * style_.samples}, widest));
            return so_far;
        },
        [](double a, double b) { return std::max(a, b); });
    // Whole pixels of the smallest mipmap.
    const double step = double(std::size_t{1} << images_.size());
    return int(std::min(std::ceil(lowest / step) * step, double(image.height)));
}

/// At one sample a pixel nothing has to be blended. rows: of one bin; pixels: #rows x width
template <class Sample>
void Rasterizer::draw_opaque(const Rows& rows, std::span<Pixel<Sample>> pixels) const {
    const std::size_t width = std::size_t(samples_view_.width);
    const Pixel<Sample> beside = filling<Sample>(style_.background);
    RowLookups room(width);
    for (const auto& spans : scan_convert(mesh_, bins_.bin(std::size_t(rows.first / bin_rows_)),
                                          samples_view_, rows, int(levels_.size()) - 1)) {
        draw_row(levels_, spans, room, beside, pixels.first(width));
        pixels = pixels.subspan(width);
    }
}

/// Any picture at any number of samples. As draw_opaque
template <class Sample>
void Rasterizer::blend(const Rows& rows, std::span<Pixel<Sample>> pixels) const {
    const std::size_t samples = std::size_t(style_.samples), width = std::size_t(samples_view_.width);
    const Pixel<Sample> background = filling<Sample>(style_.background);
    RowLookups room(width);
    LayerRow sum(width / samples);
    std::size_t sample_row = 0;
    for (const auto& spans :
         scan_convert(mesh_, bins_.bin(std::size_t(rows.first / bin_rows_)), samples_view_,
                      {rows.first * style_.samples, rows.end * style_.samples}, int(levels_.size()) - 1)) {
        LayerRow layer(width);
        if (opaque_)
            layer_row<Sample>(levels_, spans, room, layer);
        else
            blend_row<Sample>(levels_, spans, layer);
        add_samples(layer, samples, sum);
        if (++sample_row % samples > 0) continue;
        resolve_row(sum, style_.samples * style_.samples, style_.background ? &background : nullptr,
                    pixels.first(sum.width()));
        pixels = pixels.subspan(sum.width());
        sum = LayerRow(sum.width());
    }
}

void Rasterizer::draw_rows(int first_row, Image& band) {
    assert(band.width * style_.samples == samples_view_.width);
    if (fetched_ < picture_.image.height) fetch(rows_shown({first_row, first_row + band.height}));
    const auto draw = [&]<class Sample>(std::vector<Sample>& rgba) {
        const std::span pixels(reinterpret_cast<Pixel<Sample>*>(rgba.data()), rgba.size() / 4);
        const std::size_t width = std::size_t(band.width);
        const int first_bin = first_row / bin_rows_, end_row = first_row + band.height;
        oneapi::tbb::parallel_for(first_bin, (end_row - 1) / bin_rows_ + 1, [&](int bin) {
            const Rows rows{std::max(first_row, bin * bin_rows_), std::min(end_row, (bin + 1) * bin_rows_)};
            const auto to = pixels.subspan(std::size_t(rows.first - first_row) * width,
                                           std::size_t(rows.end - rows.first) * width);
            if (opaque_ && style_.samples == 1)
                draw_opaque<Sample>(rows, to);
            else
                blend<Sample>(rows, to);
        });
    };
    // Whoever waits for the last of them must not begin with another picture meanwhile.
    oneapi::tbb::this_task_arena::isolate([&] { std::visit(draw, band.rgba); });
}

}  // namespace probewarp
