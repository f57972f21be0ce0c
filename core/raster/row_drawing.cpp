#include "raster/row_drawing.h"

#include <bit>
#include <cmath>

#ifndef PROBEWARP_ROW_DRAWING_ONCE
#define PROBEWARP_ROW_DRAWING_ONCE
namespace probewarp {
namespace {

static_assert(std::endian::native == std::endian::little, "pixels are taken apart as little-endian words");

/// How many rows of the picture ahead it is fetched from memory: the next rows of the target want it.
constexpr std::ptrdiff_t rows_ahead = 4;

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
    hwy::Prefetch(samples + 4 * (hn::GetLane(above) + rows_ahead * std::ptrdiff_t(level.width)));
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
        if (first < 0) {
            std::fill_n(&pixels[i], count, nothing);
            continue;
        }
        Colours colours =
            Trilinear<Kind::opaque, Sample>(levels, std::size_t(first), hn::Sub(level, fine),
                                            hn::LoadU(tag, &row.x[i]), hn::LoadU(tag, &row.y[i]));
        colours.a = hn::Set(tag, float(std::numeric_limits<Sample>::max()));
        Store(colours, count, pixels[i].data());
    }
}

template <class Sample>
void Draw(std::span<const Level> levels, std::span<const Span> spans, RowLookups& row,
          const Pixel<Sample>& nothing, std::span<Pixel<Sample>> pixels) {
    std::fill_n(row.level.begin(), pixels.size(), RowLookups::nothing_there);
    for (const Span& span : spans) Note(span, row);
    DrawPixels(levels, row, nothing, pixels);
}

/// Lays a span's pixels over what is there.
template <class Sample>
void Blend(std::span<const Level> levels, const Span& span, LayerRow& layer) {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag), end = std::size_t(span.end);
    const Vector lane = hn::Iota(tag, 0), one = hn::Set(tag, 1.0f);
    const Vector across_x = hn::Set(tag, float(span.across.x)), across_y = hn::Set(tag, float(span.across.y));
    const float fine = std::floor(span.level);
    const Vector part = hn::Set(tag, span.level - fine);
    glm::dvec2 at = span.at;
    for (std::size_t i = std::size_t(span.first); i < end; i += lanes, at += span.across * double(lanes)) {
        const Colours over = Trilinear<Kind::weighted, Sample>(
            levels, std::size_t(fine), part, hn::MulAdd(lane, across_x, hn::Set(tag, float(at.x))),
            hn::MulAdd(lane, across_y, hn::Set(tag, float(at.y))));
        const Vector through = hn::Sub(one, over.a);
        const auto inside = hn::FirstN(tag, end - i);
        const auto lay = [&](Vector top, std::vector<float>& on) {
            hn::BlendedStore(hn::MulAdd(through, hn::LoadU(tag, &on[i]), top), inside, tag, &on[i]);
        };
        lay(over.r, layer.r), lay(over.g, layer.g), lay(over.b, layer.b), lay(over.a, layer.a);
    }
}

template <class Sample>
void BlendAll(std::span<const Level> levels, std::span<const Span> spans, LayerRow& layer) {
    for (const Span& span : spans) Blend<Sample>(levels, span, layer);
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

void DrawRow8(std::span<const Level> levels, std::span<const Span> spans, RowLookups& row,
              const Pixel<std::uint8_t>& nothing, std::span<Pixel<std::uint8_t>> pixels) {
    Draw(levels, spans, row, nothing, pixels);
}
void BlendRow8(std::span<const Level> levels, std::span<const Span> spans, LayerRow& layer) {
    BlendAll<std::uint8_t>(levels, spans, layer);
}
void ResolveRow8(const LayerRow& sum, int samples, const Pixel<std::uint8_t>* background,
                 std::span<Pixel<std::uint8_t>> pixels) {
    Resolve(sum, samples, background, pixels);
}
void DrawRow16(std::span<const Level> levels, std::span<const Span> spans, RowLookups& row,
               const Pixel<std::uint16_t>& nothing, std::span<Pixel<std::uint16_t>> pixels) {
    Draw(levels, spans, row, nothing, pixels);
}
void BlendRow16(std::span<const Level> levels, std::span<const Span> spans, LayerRow& layer) {
    BlendAll<std::uint16_t>(levels, spans, layer);
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
HWY_EXPORT(DrawRow16);
HWY_EXPORT(BlendRow8);
HWY_EXPORT(BlendRow16);
HWY_EXPORT(ResolveRow8);
HWY_EXPORT(ResolveRow16);

template <>
void draw_row(std::span<const Level> levels, std::span<const Span> spans, RowLookups& room,
              const Pixel<std::uint8_t>& nothing, std::span<Pixel<std::uint8_t>> pixels) {
    HWY_DYNAMIC_DISPATCH(DrawRow8)(levels, spans, room, nothing, pixels);
}
template <>
void draw_row(std::span<const Level> levels, std::span<const Span> spans, RowLookups& room,
              const Pixel<std::uint16_t>& nothing, std::span<Pixel<std::uint16_t>> pixels) {
    HWY_DYNAMIC_DISPATCH(DrawRow16)(levels, spans, room, nothing, pixels);
}

template <>
void blend_row<std::uint8_t>(std::span<const Level> levels, std::span<const Span> spans, LayerRow& layer) {
    HWY_DYNAMIC_DISPATCH(BlendRow8)(levels, spans, layer);
}
template <>
void blend_row<std::uint16_t>(std::span<const Level> levels, std::span<const Span> spans, LayerRow& layer) {
    HWY_DYNAMIC_DISPATCH(BlendRow16)(levels, spans, layer);
}

template <>
void resolve_row(const LayerRow& sum, int samples, const Pixel<std::uint8_t>* background,
                 std::span<Pixel<std::uint8_t>> pixels) {
    HWY_DYNAMIC_DISPATCH(ResolveRow8)(sum, samples, background, pixels);
}
template <>
void resolve_row(const LayerRow& sum, int samples, const Pixel<std::uint16_t>* background,
                 std::span<Pixel<std::uint16_t>> pixels) {
    HWY_DYNAMIC_DISPATCH(ResolveRow16)(sum, samples, background, pixels);
}

}  // namespace probewarp
#endif
