#include "render/rasterizer.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include "render/mipmaps.h"
#include "render/scan_conversion.h"

#ifndef PROBEWARP_RASTERIZER_ONCE
#define PROBEWARP_RASTERIZER_ONCE
namespace probewarp {
namespace {

static_assert(std::endian::native == std::endian::little, "pixels are taken apart as little-endian words");

/// The picture, or one of its mipmaps.
struct Level {
    const void* samples;  ///< RGBA
    int width, height;    ///< >= 2
};

/// What the pixels of a row show, one after the other: noted for all of them before any is looked up, so that
/// each is looked up once however many triangles lie over it.
struct RowLookups {
    std::vector<float> x, y;   ///< pixels of the picture at rest
    std::vector<float> level;  ///< of its mipmaps, 0 being the picture, mixed of two; or nothing_there

    explicit RowLookups(std::size_t width) : x(width + beyond), y(x.size()), level(x.size()) {}

    static constexpr std::size_t beyond = 16;  ///< where vectors reach
    static constexpr float nothing_there = -1;
};

/// How many rows of the picture ahead it is fetched from memory: the next rows of the target want it.
constexpr std::ptrdiff_t rows_ahead = 4;

/// RGBA.
template <class Sample>
using Pixel = std::array<Sample, 4>;

}  // namespace
}  // namespace probewarp
#endif

// This file is compiled once for each instruction set, all of them into one program.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/rasterizer.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace probewarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<Tag>;
using WordTag = hn::RebindToUnsigned<Tag>;
using Vector = hn::Vec<Tag>;
using Ints = hn::Vec<IntTag>;
using Words = hn::Vec<WordTag>;

/// Colours of as many pixels as a vector has lanes, in the samples' own steps.
struct Colours {
    Vector r, g, b;
};

HWY_INLINE Vector Channel(Words words) { return hn::ConvertTo(Tag(), hn::BitCast(IntTag(), words)); }

/// Four bytes of as many pixels as a vector has lanes, and the four behind them.
struct WordPairs {
    Words first, second;
};

/// place: in words
HWY_INLINE WordPairs PairsAt(const void* words, Ints place) {
    const WordTag tag;
#if HWY_TARGET == HWY_SCALAR
    const auto* base = static_cast<const std::uint32_t*>(words);
    return {hn::GatherIndex(tag, base, place), hn::GatherIndex(tag, base + 1, place)};
#else  // half as many loads
    const hn::Repartition<std::uint64_t, WordTag> pairs;
    const hn::RebindToSigned<decltype(pairs)> offsets;
    const auto* base = static_cast<const std::uint64_t*>(words);
    const auto at = [&](auto places) {
        return hn::BitCast(tag,
                           hn::GatherOffset(pairs, base, hn::ShiftLeft<2>(hn::PromoteTo(offsets, places))));
    };
    const hn::Half<IntTag> half;
    const Words low = at(hn::LowerHalf(half, place)), high = at(hn::UpperHalf(half, place));
    return {hn::ConcatEven(tag, high, low), hn::ConcatOdd(tag, high, low)};
#endif
}

HWY_INLINE Colours Unpacked(Words rgba) {
    const Words low = hn::Set(WordTag(), 0xFF);
    return {Channel(hn::And(rgba, low)), Channel(hn::And(hn::ShiftRight<8>(rgba), low)),
            Channel(hn::And(hn::ShiftRight<16>(rgba), low))};
}

HWY_INLINE Colours Unpacked(Words rg, Words ba) {
    const Words low = hn::Set(WordTag(), 0xFFFF);
    return {Channel(hn::And(rg, low)), Channel(hn::ShiftRight<16>(rg)), Channel(hn::And(ba, low))};
}

HWY_INLINE Vector Mix(Vector a, Vector b, Vector part) { return hn::MulAdd(part, hn::Sub(b, a), a); }

HWY_INLINE Colours Mix(const Colours& a, const Colours& b, Vector part) {
    return {Mix(a.r, b.r, part), Mix(a.g, b.g, part), Mix(a.b, b.b, part)};
}

/// The colour between a pixel and its right neighbour. place: the pixel's, in the level
HWY_INLINE Colours Across(const std::uint8_t* samples, Ints place, Vector part) {
    const WordPairs pixels = PairsAt(samples, place);
    return Mix(Unpacked(pixels.first), Unpacked(pixels.second), part);
}

HWY_INLINE Colours Across(const std::uint16_t* samples, Ints place, Vector part) {
    const Ints first = hn::Add(place, place), second = hn::Add(first, hn::Set(IntTag(), 2));
    const WordPairs near = PairsAt(samples, first), far = PairsAt(samples, second);
    return Mix(Unpacked(near.first, near.second), Unpacked(far.first, far.second), part);
}

/// A place along one axis.
struct Place {
    Ints pixel;   ///< never the last
    Vector part;  ///< of the next pixel: [0, 1]
};

/// at: pixels of a level, of which there are `count`
HWY_INLINE Place PlaceOf(Vector at, int count) {
    const Tag tag;
    // Nearer to a pixel's centre than vertices are known is on it: shaders/mesh.frag.
    const Vector on_centre = hn::Set(tag, 1.0f / 512), last = hn::Set(tag, float(count - 1));
    Vector place = hn::Min(hn::Max(hn::Sub(at, hn::Set(tag, 0.5f)), hn::Zero(tag)), last);
    const Vector centre = hn::Round(place);
    place = hn::IfThenElse(hn::Lt(hn::Abs(hn::Sub(place, centre)), on_centre), centre, place);
    const Vector corner = hn::Min(hn::Floor(place), hn::Sub(last, hn::Set(tag, 1.0f)));
    return {hn::ConvertTo(IntTag(), corner), hn::Sub(place, corner)};
}

template <class Sample>
HWY_INLINE Colours Bilinear(const Level& level, Vector x, Vector y) {
    const auto* samples = static_cast<const Sample*>(level.samples);
    const Place across = PlaceOf(x, level.width), down = PlaceOf(y, level.height);
    const Ints width = hn::Set(IntTag(), level.width);
    const Ints above = hn::Add(hn::Mul(down.pixel, width), across.pixel), below = hn::Add(above, width);
    hwy::Prefetch(samples + 4 * (hn::GetLane(above) + rows_ahead * std::ptrdiff_t(level.width)));
    return Mix(Across(samples, above, across.part), Across(samples, below, across.part), down.part);
}

HWY_INLINE Words Rounded(Vector sample) {
    return hn::BitCast(WordTag(), hn::ConvertTo(IntTag(), hn::Add(sample, hn::Set(Tag(), 0.5f))));
}

/// Writes the first `count` pixels.
HWY_INLINE void Store(const Colours& c, std::size_t count, std::uint8_t* to) {
    const WordTag words;
    const Words rgba = hn::Or(hn::Or(Rounded(c.r), hn::ShiftLeft<8>(Rounded(c.g))),
                              hn::Or(hn::ShiftLeft<16>(Rounded(c.b)), hn::Set(words, 0xFF000000)));
    auto* pixels = reinterpret_cast<std::uint32_t*>(to);
    if (HWY_LIKELY(count == hn::Lanes(words)))
        hn::StoreU(rgba, words, pixels);
    else
        hn::BlendedStore(rgba, hn::FirstN(words, count), words, pixels);
}

HWY_INLINE void Store(const Colours& c, std::size_t count, std::uint16_t* to) {
    const WordTag words;
    const Words rg = hn::Or(Rounded(c.r), hn::ShiftLeft<16>(Rounded(c.g)));
    const Words ba = hn::Or(Rounded(c.b), hn::Set(words, 0xFFFF0000));
    HWY_ALIGN std::uint32_t pairs[2 * hn::MaxLanes(words)];
    hn::StoreInterleaved2(rg, ba, words, pairs);
    std::copy_n(pairs, 2 * count, reinterpret_cast<std::uint32_t*>(to));
}

/// Notes what a span's pixels show.
void Note(const Span& span, RowLookups& row) {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag), end = std::size_t(span.end);
    const Vector lane = hn::Iota(tag, 0), level = hn::Set(tag, span.level);
    const Vector across_x = hn::Set(tag, float(span.across.x)), across_y = hn::Set(tag, float(span.across.y));
    glm::dvec2 at = span.at;
    for (std::size_t i = std::size_t(span.first); i < end; i += lanes, at += span.across * double(lanes)) {
        const auto inside = hn::FirstN(tag, end - i);
        hn::BlendedStore(hn::MulAdd(lane, across_x, hn::Set(tag, float(at.x))), inside, tag, &row.x[i]);
        hn::BlendedStore(hn::MulAdd(lane, across_y, hn::Set(tag, float(at.y))), inside, tag, &row.y[i]);
        hn::BlendedStore(level, inside, tag, &row.level[i]);
    }
}

/// x, y: pixels of the picture at rest; fine: the mipmap; part: of the next one, [0, 1)
template <class Sample>
HWY_INLINE Colours Trilinear(std::span<const Level> levels, std::size_t fine, Vector part, Vector x,
                             Vector y) {
    const Tag tag;
    const Vector smaller = hn::Set(tag, std::ldexp(1.0f, -int(fine))), half = hn::Set(tag, 0.5f);
    x = hn::Mul(x, smaller), y = hn::Mul(y, smaller);
    const Colours colours = Bilinear<Sample>(levels[fine], x, y);
    if (fine + 1 == levels.size() || hn::AllFalse(tag, hn::Gt(part, hn::Zero(tag)))) return colours;
    return Mix(colours, Bilinear<Sample>(levels[fine + 1], hn::Mul(x, half), hn::Mul(y, half)), part);
}

/// Draws a row, as many pixels at a time as are of one mipmap. pixels: #width
template <class Sample>
void DrawPixels(std::span<const Level> levels, const RowLookups& row, const Pixel<Sample>& nothing,
                std::span<Pixel<Sample>> pixels) {
    const Tag tag;
    for (std::size_t i = 0, count; i < pixels.size(); i += count) {
        const Vector level = hn::LoadU(tag, &row.level[i]), fine = hn::Floor(level);
        const float first = hn::GetLane(fine);
        const std::ptrdiff_t alike = hn::FindFirstTrue(tag, hn::Ne(fine, hn::Set(tag, first)));
        count = std::min(alike < 0 ? hn::Lanes(tag) : std::size_t(alike), pixels.size() - i);
        if (first < 0)
            std::fill_n(&pixels[i], count, nothing);
        else
            Store(Trilinear<Sample>(levels, std::size_t(first), hn::Sub(level, fine),
                                    hn::LoadU(tag, &row.x[i]), hn::LoadU(tag, &row.y[i])),
                  count, pixels[i].data());
    }
}

template <class Sample>
void DrawRow(std::span<const Level> levels, std::span<const Span> spans, RowLookups& row,
             const Pixel<Sample>& nothing, std::span<Pixel<Sample>> pixels) {
    std::fill_n(row.level.begin(), pixels.size(), RowLookups::nothing_there);
    for (const Span& span : spans) Note(span, row);
    DrawPixels(levels, row, nothing, pixels);
}

void DrawRow8(std::span<const Level> levels, std::span<const Span> spans, RowLookups& row,
              const Pixel<std::uint8_t>& nothing, std::span<Pixel<std::uint8_t>> pixels) {
    DrawRow(levels, spans, row, nothing, pixels);
}
void DrawRow16(std::span<const Level> levels, std::span<const Span> spans, RowLookups& row,
               const Pixel<std::uint16_t>& nothing, std::span<Pixel<std::uint16_t>> pixels) {
    DrawRow(levels, spans, row, nothing, pixels);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace probewarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace probewarp {

HWY_EXPORT(DrawRow8);
HWY_EXPORT(DrawRow16);

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

/// Draws rows of the view. pixels: #rows x row_pixels, of which view.width belong to it
template <class Sample>
void draw_rows(const DrawnTriangles& triangles, std::span<const Level> levels, const View& view,
               const Rows& rows, std::optional<Colour> background, Pixel<Sample>* pixels,
               std::size_t row_pixels) {
    const auto spans = scan_convert(triangles, view, rows, int(levels.size()) - 1);
    const std::size_t width = std::size_t(view.width);
    const Pixel<Sample> nothing = filling<Sample>(background);
    RowLookups row(width);
    for (const auto& of_row : spans) {
        const std::span to(pixels, width);
        if constexpr (sizeof(Sample) == 1)
            HWY_DYNAMIC_DISPATCH(DrawRow8)(levels, of_row, row, nothing, to);
        else
            HWY_DYNAMIC_DISPATCH(DrawRow16)(levels, of_row, row, nothing, to);
        pixels += row_pixels;
    }
}

/// Rows that one thread draws at a time: of triangles that lie in several such, each works out the corners.
constexpr int rows_at_once = 32;

}  // namespace

Rasterizer::Rasterizer(const Image& picture, int most_levels)
    : picture_(&picture), smaller_(smaller_levels(picture, most_levels)) {
    if (is_thin(picture)) picture_ = &thick_.emplace(thickened(picture));
    for (Image& image : smaller_)
        if (is_thin(image)) image = thickened(image);
    const float right = float(picture.width), bottom = float(picture.height);
    corners_ = {{{0, 0}, {right, 0}, {0, bottom}, {right, bottom}}};
}

void Rasterizer::set_mesh(const Mesh& mesh, std::span<const glm::vec2> now, bool moved) {
    static constexpr std::array<std::uint32_t, 6> two_triangles{0, 1, 2, 2, 1, 3};
    moved_ = moved;
    rest_ = moved ? std::span<const glm::vec2>(mesh.rest) : corners_;
    now_ = moved ? now : rest_;
    triangles_ = moved ? std::span<const std::uint32_t>(mesh.triangles) : two_triangles;
}

void Rasterizer::render(Image& image, int left, int top, const View& view, const FileStyle& style,
                        std::span<const TriangleRun> runs) {
    assert(style.samples == 1 && !style.overlay && image.bits() == picture_->bits());
    assert(left >= 0 && top >= 0 && left + view.width <= image.width && top + view.height <= image.height);
    const TriangleRun whole{0, 2, runs.empty() || runs.front().shrunk};
    const DrawnTriangles triangles{rest_, now_, triangles_, moved_ ? runs : std::span(&whole, 1)};
    const std::vector<Level> levels = levels_of(*picture_, smaller_);
    const auto draw = [&]<class Sample>(std::vector<Sample>& rgba) {
        const std::size_t row_pixels = std::size_t(image.width);
        auto* const pixels =
            reinterpret_cast<Pixel<Sample>*>(rgba.data()) + std::size_t(top) * row_pixels + std::size_t(left);
        using Range = oneapi::tbb::blocked_range<int>;
        oneapi::tbb::parallel_for(
            Range(0, view.height, rows_at_once),
            [&](const Range& range) {
                draw_rows(triangles, levels, view, {range.begin(), range.end()}, style.background,
                          pixels + std::size_t(range.begin()) * row_pixels, row_pixels);
            },
            oneapi::tbb::simple_partitioner());
    };
    std::visit(draw, image.rgba);
}

}  // namespace probewarp
#endif
