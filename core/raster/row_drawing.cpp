#include "raster/row_drawing.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#ifndef PROBEWARP_ROW_DRAWING_ONCE
#define PROBEWARP_ROW_DRAWING_ONCE
namespace probewarp {
namespace {

static_assert(std::endian::native == std::endian::little, "pixels are taken apart as little-endian words");

/// How many rows of the picture ahead it is fetched from memory: the next rows of the target want it.
constexpr int rows_ahead = 4;

/// As in shaders/mesh.frag.
constexpr float least_weight = 0x1p-40f;

}  // namespace
}  // namespace probewarp
#endif

// This file is compiled once for each instruction set, all of them into one program.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/row_drawing.cpp"
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

/// Colours of as many pixels as a vector has lanes, in the samples' own steps; or weighted ones, colour times
/// weight and weight, as shaders/mesh.frag has them. (What nobody looks at is not worked out.)
struct Colours {
    Vector r, g, b, a;
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
            Channel(hn::And(hn::ShiftRight<16>(rgba), low)), Channel(hn::ShiftRight<24>(rgba))};
}

HWY_INLINE Colours Unpacked(Words rg, Words ba) {
    const Words low = hn::Set(WordTag(), 0xFFFF);
    return {Channel(hn::And(rg, low)), Channel(hn::ShiftRight<16>(rg)), Channel(hn::And(ba, low)),
            Channel(hn::ShiftRight<16>(ba))};
}

/// Exactly a and b at 0 and 1, however much larger one of them is.
HWY_INLINE Vector Mix(Vector a, Vector b, Vector part) {
    return hn::MulAdd(part, b, hn::NegMulAdd(part, a, a));
}

HWY_INLINE Colours Mix(const Colours& a, const Colours& b, Vector part) {
    return {Mix(a.r, b.r, part), Mix(a.g, b.g, part), Mix(a.b, b.b, part), Mix(a.a, b.a, part)};
}

/// How a picture is looked up: as one that is opaque, or with each pixel weighted by its alpha.
enum class Kind { opaque, weighted };

/// A weight is never nothing, so that a colour under zero alpha comes through where it is alone.
template <Kind kind, class Sample>
HWY_INLINE Colours Of(const Colours& c) {
    if (kind == Kind::opaque) return c;
    const Tag tag;
    const Vector one = hn::Set(tag, 1.0f / std::numeric_limits<Sample>::max());
    const Vector weight = hn::Max(hn::Mul(c.a, one), hn::Set(tag, least_weight));
    return {hn::Mul(c.r, weight), hn::Mul(c.g, weight), hn::Mul(c.b, weight), weight};
}

/// The colour between a pixel and its right neighbour. place: the pixel's, in the level
template <Kind kind>
HWY_INLINE Colours Across(const std::uint8_t* samples, Ints place, Vector part) {
    const WordPairs pixels = PairsAt(samples, place);
    return Mix(Of<kind, std::uint8_t>(Unpacked(pixels.first)),
               Of<kind, std::uint8_t>(Unpacked(pixels.second)), part);
}

template <Kind kind>
HWY_INLINE Colours Across(const std::uint16_t* samples, Ints place, Vector part) {
    const Ints first = hn::Add(place, place), second = hn::Add(first, hn::Set(IntTag(), 2));
    const WordPairs near = PairsAt(samples, first), far = PairsAt(samples, second);
    return Mix(Of<kind, std::uint16_t>(Unpacked(near.first, near.second)),
               Of<kind, std::uint16_t>(Unpacked(far.first, far.second)), part);
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

template <Kind kind, class Sample>
HWY_INLINE Colours Bilinear(const Level& level, Vector x, Vector y) {
    const auto* samples = static_cast<const Sample*>(level.samples);
    const Place across = PlaceOf(x, level.width), down = PlaceOf(y, level.height);
    const Ints width = hn::Set(IntTag(), level.width);
    const Ints above = hn::Add(hn::Mul(down.pixel, width), across.pixel), below = hn::Add(above, width);
    const int ahead = std::min(hn::GetLane(down.pixel) + rows_ahead, level.height - 1);
    hwy::Prefetch(samples + 4 * (std::ptrdiff_t(ahead) * level.width + hn::GetLane(across.pixel)));
    return Mix(Across<kind>(samples, above, across.part), Across<kind>(samples, below, across.part),
               down.part);
}

/// x, y: pixels of the picture at rest; fine: the mipmap; part: of the next one, [0, 1)
template <Kind kind, class Sample>
HWY_INLINE Colours Trilinear(std::span<const Level> levels, std::size_t fine, Vector part, Vector x,
                             Vector y) {
    const Tag tag;
    const Vector smaller = hn::Set(tag, std::ldexp(1.0f, -int(fine))), half = hn::Set(tag, 0.5f);
    x = hn::Mul(x, smaller), y = hn::Mul(y, smaller);
    const Colours colours = Bilinear<kind, Sample>(levels[fine], x, y);
    if (fine + 1 == levels.size() || hn::AllFalse(tag, hn::Gt(part, hn::Zero(tag)))) return colours;
    return Mix(colours, Bilinear<kind, Sample>(levels[fine + 1], hn::Mul(x, half), hn::Mul(y, half)), part);
}

HWY_INLINE Words Rounded(Vector sample) {
    return hn::BitCast(WordTag(), hn::ConvertTo(IntTag(), hn::Add(sample, hn::Set(Tag(), 0.5f))));
}

/// Writes the first `count` pixels: straight colours.
HWY_INLINE void Store(const Colours& c, std::size_t count, std::uint8_t* to) {
    const WordTag words;
    const Words rgba = hn::Or(hn::Or(Rounded(c.r), hn::ShiftLeft<8>(Rounded(c.g))),
                              hn::Or(hn::ShiftLeft<16>(Rounded(c.b)), hn::ShiftLeft<24>(Rounded(c.a))));
    auto* pixels = reinterpret_cast<std::uint32_t*>(to);
    if (HWY_LIKELY(count == hn::Lanes(words)))
        hn::StoreU(rgba, words, pixels);
    else
        hn::BlendedStore(rgba, hn::FirstN(words, count), words, pixels);
}

HWY_INLINE void Store(const Colours& c, std::size_t count, std::uint16_t* to) {
    const WordTag words;
    const Words rg = hn::Or(Rounded(c.r), hn::ShiftLeft<16>(Rounded(c.g)));
    const Words ba = hn::Or(Rounded(c.b), hn::ShiftLeft<16>(Rounded(c.a)));
    HWY_ALIGN std::uint32_t pairs[2 * hn::MaxLanes(words)];
    hn::StoreInterleaved2(rg, ba, words, pairs);
    std::copy_n(pairs, 2 * count, reinterpret_cast<std::uint32_t*>(to));
}

/// Calls each(i, inside, x, y) for every vector of a span's pixels, the first of them `i`: the places that
/// they show in the picture at rest, of use where `inside`.
template <class Each>
HWY_INLINE void ForPlaces(const PixelSpan& span, const Each& each) {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag), end = std::size_t(span.end);
    const Vector lane = hn::Iota(tag, 0);
    const Vector across_x = hn::Set(tag, float(span.across.x)), across_y = hn::Set(tag, float(span.across.y));
    glm::dvec2 at = span.at;
    for (std::size_t i = std::size_t(span.first); i < end; i += lanes, at += span.across * double(lanes))
        each(i, hn::FirstN(tag, end - i), hn::MulAdd(lane, across_x, hn::Set(tag, float(at.x))),
             hn::MulAdd(lane, across_y, hn::Set(tag, float(at.y))));
}

/// Notes what the pixels of a row show.
HWY_INLINE void Note(std::span<const PixelSpan> spans, std::size_t width, RowLookups& row) {
    const Tag tag;
    std::fill_n(row.level.begin(), width, RowLookups::nothing_there);
    for (const PixelSpan& span : spans)
        ForPlaces(span, [&](std::size_t i, auto inside, Vector x, Vector y) {
            hn::BlendedStore(x, inside, tag, &row.x[i]);
            hn::BlendedStore(y, inside, tag, &row.y[i]);
            hn::BlendedStore(hn::Set(tag, span.level), inside, tag, &row.level[i]);
        });
}

/// Looks a noted row up, as many pixels at a time as are of one mipmap: calls show(i, count, colours) for
/// `count` pixels from `i` on, or leave_out(i, count) where nothing is.
template <class Sample, class Show, class LeaveOut>
HWY_INLINE void ForPixels(std::span<const Level> levels, const RowLookups& row, std::size_t width,
                          const Show& show, const LeaveOut& leave_out) {
    const Tag tag;
    for (std::size_t i = 0, count; i < width; i += count) {
        const Vector level = hn::LoadU(tag, &row.level[i]), fine = hn::Floor(level);
        const float first = hn::GetLane(fine);
        const std::ptrdiff_t alike = hn::FindFirstTrue(tag, hn::Ne(fine, hn::Set(tag, first)));
        count = std::min(alike < 0 ? hn::Lanes(tag) : std::size_t(alike), width - i);
        if (first < 0)
            leave_out(i, count);
        else
            show(i, count,
                 Trilinear<Kind::opaque, Sample>(levels, std::size_t(first), hn::Sub(level, fine),
                                                 hn::LoadU(tag, &row.x[i]), hn::LoadU(tag, &row.y[i])));
    }
}

template <class Sample>
void Draw(std::span<const Level> levels, std::span<const PixelSpan> spans, RowLookups& row,
          const Pixel<Sample>& beside, std::span<Pixel<Sample>> pixels) {
    const Vector opaque = hn::Set(Tag(), float(std::numeric_limits<Sample>::max()));
    Note(spans, pixels.size(), row);
    ForPixels<Sample>(
        levels, row, pixels.size(),
        [&](std::size_t i, std::size_t count, const Colours& c) {
            Store({c.r, c.g, c.b, opaque}, count, pixels[i].data());
        },
        [&](std::size_t i, std::size_t count) { std::fill_n(&pixels[i], count, beside); });
}

template <class Sample>
void Layer(std::span<const Level> levels, std::span<const PixelSpan> spans, RowLookups& row,
           LayerRow& layer) {
    const Tag tag;
    const Vector zero = hn::Zero(tag);
    const auto put = [&](std::size_t i, std::size_t count, const Colours& c) {
        const auto inside = hn::FirstN(tag, count);
        hn::BlendedStore(c.r, inside, tag, &layer.r[i]);
        hn::BlendedStore(c.g, inside, tag, &layer.g[i]);
        hn::BlendedStore(c.b, inside, tag, &layer.b[i]);
        hn::BlendedStore(c.a, inside, tag, &layer.a[i]);
    };
    Note(spans, layer.width(), row);
    ForPixels<Sample>(
        levels, row, layer.width(),
        [&](std::size_t i, std::size_t count, const Colours& c) {
            put(i, count, {c.r, c.g, c.b, hn::Set(tag, 1.0f)});
        },
        [&](std::size_t i, std::size_t count) {
            put(i, count, {zero, zero, zero, zero});
        });
}

template <class Sample>
void Blend(std::span<const Level> levels, std::span<const PixelSpan> spans, LayerRow& layer) {
    const Tag tag;
    for (const PixelSpan& span : spans) {
        const float fine = std::floor(span.level);
        const Vector part = hn::Set(tag, span.level - fine);
        ForPlaces(span, [&](std::size_t i, auto inside, Vector x, Vector y) {
            const Colours over = Trilinear<Kind::weighted, Sample>(levels, std::size_t(fine), part, x, y);
            const Vector through = hn::Sub(hn::Set(tag, 1.0f), over.a);
            const auto lay = [&](Vector top, std::vector<float>& on) {
                hn::BlendedStore(hn::MulAdd(through, hn::LoadU(tag, &on[i]), top), inside, tag, &on[i]);
            };
            lay(over.r, layer.r), lay(over.g, layer.g), lay(over.b, layer.b), lay(over.a, layer.a);
        });
    }
}

/// Straight colours, of weighted ones that were added up `samples` times. background: likewise straight, or
/// null
template <class Sample>
void Resolve(const LayerRow& sum, int samples, const Pixel<Sample>* background,
             std::span<Pixel<Sample>> pixels) {
    const Tag tag;
    const float largest = std::numeric_limits<Sample>::max();
    const Vector zero = hn::Zero(tag), most = hn::Set(tag, largest);
    for (std::size_t i = 0; i < pixels.size(); i += hn::Lanes(tag)) {
        const Vector a = hn::LoadU(tag, &sum.a[i]),
                     some = hn::IfThenElse(hn::Gt(a, zero), a, hn::Set(tag, 1.0f));
        Vector alpha = hn::Mul(a, hn::Set(tag, 1.0f / float(samples)));
        const auto straight = [&](const std::vector<float>& weighted, std::size_t channel) {
            Vector colour = hn::Div(hn::LoadU(tag, &weighted[i]), some);
            if (background) colour = Mix(hn::Set(tag, float((*background)[channel])), colour, alpha);
            return hn::Min(colour, most);
        };
        Colours colours{straight(sum.r, 0), straight(sum.g, 1), straight(sum.b, 2), most};
        if (!background) colours.a = hn::Min(hn::Mul(alpha, most), most);
        Store(colours, std::min(hn::Lanes(tag), pixels.size() - i), pixels[i].data());
    }
}

void DrawRow8(std::span<const Level> levels, std::span<const PixelSpan> spans, RowLookups& row,
              const Pixel<std::uint8_t>& beside, std::span<Pixel<std::uint8_t>> pixels) {
    Draw(levels, spans, row, beside, pixels);
}
void LayerRow8(std::span<const Level> levels, std::span<const PixelSpan> spans, RowLookups& row,
               LayerRow& layer) {
    Layer<std::uint8_t>(levels, spans, row, layer);
}
void BlendRow8(std::span<const Level> levels, std::span<const PixelSpan> spans, LayerRow& layer) {
    Blend<std::uint8_t>(levels, spans, layer);
}
void ResolveRow8(const LayerRow& sum, int samples, const Pixel<std::uint8_t>* background,
                 std::span<Pixel<std::uint8_t>> pixels) {
    Resolve(sum, samples, background, pixels);
}
void DrawRow16(std::span<const Level> levels, std::span<const PixelSpan> spans, RowLookups& row,
               const Pixel<std::uint16_t>& beside, std::span<Pixel<std::uint16_t>> pixels) {
    Draw(levels, spans, row, beside, pixels);
}
void LayerRow16(std::span<const Level> levels, std::span<const PixelSpan> spans, RowLookups& row,
                LayerRow& layer) {
    Layer<std::uint16_t>(levels, spans, row, layer);
}
void BlendRow16(std::span<const Level> levels, std::span<const PixelSpan> spans, LayerRow& layer) {
    Blend<std::uint16_t>(levels, spans, layer);
}
void ResolveRow16(const LayerRow& sum, int samples, const Pixel<std::uint16_t>* background,
                  std::span<Pixel<std::uint16_t>> pixels) {
    Resolve(sum, samples, background, pixels);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace probewarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace probewarp {

HWY_EXPORT(DrawRow8);
HWY_EXPORT(LayerRow8);
HWY_EXPORT(BlendRow8);
HWY_EXPORT(ResolveRow8);
HWY_EXPORT(DrawRow16);
HWY_EXPORT(LayerRow16);
HWY_EXPORT(BlendRow16);
HWY_EXPORT(ResolveRow16);

template <>
void draw_row(std::span<const Level> levels, std::span<const PixelSpan> spans, RowLookups& room,
              const Pixel<std::uint8_t>& beside, std::span<Pixel<std::uint8_t>> pixels) {
    HWY_DYNAMIC_DISPATCH(DrawRow8)(levels, spans, room, beside, pixels);
}
template <>
void layer_row<std::uint8_t>(std::span<const Level> levels, std::span<const PixelSpan> spans,
                             RowLookups& room, LayerRow& layer) {
    HWY_DYNAMIC_DISPATCH(LayerRow8)(levels, spans, room, layer);
}
template <>
void blend_row<std::uint8_t>(std::span<const Level> levels, std::span<const PixelSpan> spans,
                             LayerRow& layer) {
    HWY_DYNAMIC_DISPATCH(BlendRow8)(levels, spans, layer);
}
template <>
void resolve_row(const LayerRow& sum, int samples, const Pixel<std::uint8_t>* background,
                 std::span<Pixel<std::uint8_t>> pixels) {
    HWY_DYNAMIC_DISPATCH(ResolveRow8)(sum, samples, background, pixels);
}

template <>
void draw_row(std::span<const Level> levels, std::span<const PixelSpan> spans, RowLookups& room,
              const Pixel<std::uint16_t>& beside, std::span<Pixel<std::uint16_t>> pixels) {
    HWY_DYNAMIC_DISPATCH(DrawRow16)(levels, spans, room, beside, pixels);
}
template <>
void layer_row<std::uint16_t>(std::span<const Level> levels, std::span<const PixelSpan> spans,
                              RowLookups& room, LayerRow& layer) {
    HWY_DYNAMIC_DISPATCH(LayerRow16)(levels, spans, room, layer);
}
template <>
void blend_row<std::uint16_t>(std::span<const Level> levels, std::span<const PixelSpan> spans,
                              LayerRow& layer) {
    HWY_DYNAMIC_DISPATCH(BlendRow16)(levels, spans, layer);
}
template <>
void resolve_row(const LayerRow& sum, int samples, const Pixel<std::uint16_t>* background,
                 std::span<Pixel<std::uint16_t>> pixels) {
    HWY_DYNAMIC_DISPATCH(ResolveRow16)(sum, samples, background, pixels);
}

}  // namespace probewarp
#endif
