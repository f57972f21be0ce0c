#include "io/png_encoder.h"

#include <libdeflate.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <limits>

#include "io/deflate_strip.h"
#include "io/formats.h"
#include "io/image_encoding.h"
#include "io/png_filter.h"

namespace probewarp {

namespace {

// ---- one strip ----

/// How hard a compression tries. The levels are libdeflate's.
struct Effort {
    std::array<FilterSet, 3>
        filters;                   ///< each in turn for the whole strip, the smallest kept; 0: none further
    int level;                     ///< 0: ISA-L
    int drawing_level;             ///< where the strip packs to a sixth or less, as photographs never do
    std::size_t strip_bytes;       ///< about
    std::array<unsigned, 2> zlib;  ///< the stream's two first bytes, which hint at the level
};

// Measured on photographs and drawings. On photographs level 1 makes what zlib's 5 does within one per cent,
// ten times as fast; drawings need level 4 for that, and there it costs little. 12 is libdeflate's best.
// Choosing row by row serves photographs best, but repetitive drawings do better with one filter throughout.
// Strips forget what was before: at a mebibyte that costs a thousandth.
constexpr Effort effort_of(Compression compression) {
    constexpr std::size_t mebibyte = std::size_t{1} << 20;
    switch (compression) {
        case Compression::fast:
            return {{all_filters}, 0, 1, mebibyte, {0x78, 0x01}};
        case Compression::small:
            return {{all_filters, no_filter, up_filter}, 12, 12, 4 * mebibyte, {0x78, 0xDA}};
        default:
            return {{all_filters}, 1, 4, mebibyte, {0x78, 0x9C}};
    }
}

/// What of the samples goes into the file.
struct Rows {
    Samples samples;
    int kept;  ///< channels
    int first, end;

    std::size_t pixel_bytes() const { return std::size_t(kept * samples.bits / 8); }
    std::size_t row_bytes() const { return std::size_t(samples.width) * pixel_bytes(); }
};

/// Copies the kept channels of every pixel. from: width x channels; to: width x kept, in the file's byte
/// order.
template <class Sample>
void pack_row(const Sample* from, const Rows& rows, std::uint8_t* to) {
    const auto channels = std::size_t(rows.samples.channels), kept = std::size_t(rows.kept);
    for (std::size_t x = 0; x < std::size_t(rows.samples.width); ++x)
        for (std::size_t c = 0; c < kept; ++c) {
            const Sample sample = from[x * channels + c];
            if constexpr (sizeof(Sample) == 2) *to++ = std::uint8_t(sample >> 8);
            *to++ = std::uint8_t(sample & 0xFF);
        }
}

void pack_row(const Rows& rows, int y, std::uint8_t* to) {
    const std::size_t samples =
        std::size_t(y) * std::size_t(rows.samples.width) * std::size_t(rows.samples.channels);
    if (rows.samples.bits == 8 && rows.samples.channels == 4 && rows.kept == 3)
        drop_alpha({reinterpret_cast<const std::uint8_t*>(rows.samples.first) + samples,
                    std::size_t(rows.samples.width) * 4},
                   {to, rows.row_bytes()});
    else if (rows.samples.bits == 16)
        pack_row(reinterpret_cast<const std::uint16_t*>(rows.samples.first) + samples, rows, to);
    else
        pack_row(reinterpret_cast<const std::uint8_t*>(rows.samples.first) + samples, rows, to);
}

std::vector<std::uint8_t> filtered(const Rows& rows, FilterSet filters) {
    const std::size_t bytes = rows.row_bytes();
    std::vector<std::uint8_t> out(std::size_t(rows.end - rows.first) * (bytes + 1));
    std::vector<std::uint8_t> row(bytes), above(bytes);
    if (rows.first > 0) pack_row(rows, rows.first - 1, above.data());
    for (int y = rows.first; y < rows.end; ++y) {
        pack_row(rows, y, row.data());
        const auto to = std::span(out).subspan(std::size_t(y - rows.first) * (bytes + 1), bytes + 1);
        filter_row(row, above, rows.pixel_bytes(), filters, to);
        std::swap(row, above);
    }
    return out;
}

/// Filtered in each of the effort's ways, the one that packs best at a level that is quick.
std::vector<std::uint8_t> best_filtered(const Rows& rows, const Effort& effort) {
    constexpr int trial_level = 2;
    std::vector<std::uint8_t> best = filtered(rows, effort.filters[0]);
    if (effort.filters[1] == 0) return best;
    std::size_t least = deflate_whole(std::as_bytes(std::span(best)), trial_level).size();
    for (const FilterSet filters : std::span(effort.filters).subspan(1)) {
        std::vector<std::uint8_t> other = filtered(rows, filters);
        const std::size_t size = deflate_whole(std::as_bytes(std::span(other)), trial_level).size();
        if (size >= least) continue;
        least = size;
        best = std::move(other);
    }
    return best;
}

std::vector<std::byte> deflated_strip(Bytes raw, const Effort& effort, bool last) {
    std::vector<std::byte> out =
        effort.level == 0 ? deflate_quickly(raw, last) : deflate_whole(raw, effort.level);
    const bool again = effort.drawing_level > effort.level && out.size() <= raw.size() / 6;
    if (again) out = deflate_whole(raw, effort.drawing_level);
    if ((again || effort.level > 0) && !last) open_end(out, raw.size());
    return out;
}

PngStrip strip_of(const Rows& rows, const Effort& effort) {
    const std::vector<std::uint8_t> raw = best_filtered(rows, effort);
    const Bytes bytes = std::as_bytes(std::span(raw));
    std::vector<std::byte> deflated = deflated_strip(bytes, effort, rows.end == rows.samples.height);
    if (rows.first == 0)
        deflated.insert(deflated.begin(), {std::byte(effort.zlib[0]), std::byte(effort.zlib[1])});
    PngStrip strip;
    strip.crc = libdeflate_crc32(libdeflate_crc32(0, "IDAT", 4), deflated.data(), deflated.size());
    strip.adler = libdeflate_adler32(1, raw.data(), raw.size());
    strip.filtered = raw.size();
    strip.bytes = std::move(deflated);
    return strip;
}

/// Whether the alpha of RGBA rows [first, end) is full everywhere.
template <class Sample>
bool is_opaque(const Samples& samples, int first, int end) {
    const auto* rgba = reinterpret_cast<const Sample*>(samples.first);
    const std::size_t row = std::size_t(samples.width) * 4;
    for (int y = first; y < end; ++y) {
        Sample all = std::numeric_limits<Sample>::max();
        for (std::size_t i = std::size_t(y) * row + 3; i < std::size_t(y + 1) * row; i += 4)
            all = Sample(all & rgba[i]);
        if (all != std::numeric_limits<Sample>::max()) return false;
    }
    return true;
}

bool is_opaque(const Samples& samples, int first, int end) {
    return samples.bits == 16 ? is_opaque<std::uint16_t>(samples, first, end)
                              : is_opaque<std::uint8_t>(samples, first, end);
}

}  // namespace

// ---- all strips ----

PngRows::PngRows(const Samples& samples, Compression compression)
    : samples_(samples), compression_(compression) {
    restart(samples.channels == 4 ? 3 : samples.channels);
}

PngRows::~PngRows() {
    tasks_.cancel();
    try {
        tasks_.wait();
    } catch (...) {  // of no use to anybody any more
    }
}

void PngRows::restart(int kept) {
    tasks_.cancel();
    tasks_.wait();
    kept_ = kept;
    const std::size_t row = Rows{samples_, kept, 0, 0}.row_bytes() + 1;
    strip_rows_ = int(std::max<std::size_t>(1, effort_of(compression_).strip_bytes / row));
    strips_.assign(std::size_t((samples_.height + strip_rows_ - 1) / strip_rows_), {});
    started_ = 0;
}

void PngRows::advance(int rows) {
    assert(rows >= rows_ && rows <= samples_.height);
    if (kept_ == 3 && !is_opaque(samples_, rows_, rows)) restart(4);
    rows_ = rows;
    for (; started_ < strips_.size(); ++started_) {
        const int first = int(started_) * strip_rows_, end = std::min(first + strip_rows_, samples_.height);
        if (end > rows_) return;
        tasks_.run([rows = Rows{samples_, kept_, first, end}, &strip = strips_[started_],
                    effort = effort_of(compression_)] { strip = strip_of(rows, effort); });
    }
}

std::vector<PngStrip> PngRows::finish() {
    assert(rows_ == samples_.height);
    tasks_.wait();
    return std::move(strips_);
}

// ---- the file ----

namespace {

void put_be32(std::vector<std::byte>& to, std::size_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) to.push_back(std::byte(value >> shift & 0xFF));
}

void put_text(std::vector<std::byte>& to, std::string_view text) {
    for (const char c : text) to.push_back(std::byte(c));
}

void put_bytes(std::vector<std::byte>& to, Bytes bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); }

void put_chunk(std::vector<std::byte>& to, std::string_view type, Bytes data) {
    put_be32(to, data.size());
    const std::size_t first = to.size();
    put_text(to, type);
    put_bytes(to, data);
    put_be32(to, libdeflate_crc32(0, to.data() + first, to.size() - first));
}

/// IHDR: section 11.2.1. kept: channels in the file
void put_header(std::vector<std::byte>& to, const Samples& samples, int kept) {
    constexpr std::array<unsigned, 5> colour_types{0, 0, 4, 2, 6};  // by channels
    std::vector<std::byte> data;
    put_be32(data, std::size_t(samples.width));
    put_be32(data, std::size_t(samples.height));
    data.push_back(std::byte(samples.bits));
    data.push_back(std::byte(colour_types[std::size_t(kept)]));
    data.resize(13);  // deflate, the five filters, not interlaced
    put_chunk(to, "IHDR", data);
}

void put_profile(std::vector<std::byte>& to, Bytes icc) {
    if (icc.empty()) return;
    std::vector<std::byte> data;
    put_text(data, std::string_view("ICC profile\0\0", 13));  // its name, its end, and the method: zlib
    uLongf length = compressBound(uLong(icc.size()));
    const std::size_t first = data.size();
    data.resize(first + length);
    if (compress(reinterpret_cast<Bytef*>(data.data() + first), &length,
                 reinterpret_cast<const Bytef*>(icc.data()), uLong(icc.size())) != Z_OK)
        throw std::bad_alloc();
    data.resize(first + length);
    put_chunk(to, "iCCP", data);
}

void put_resolution(std::vector<std::byte>& to, const std::optional<Resolution>& resolution) {
    if (!resolution || !is_resolution(resolution->x, resolution->y)) return;
    std::vector<std::byte> data;
    put_be32(data, resolution->x);
    put_be32(data, resolution->y);
    data.push_back(std::byte{1});  // per metre
    put_chunk(to, "pHYs", data);
}

/// Each strip an IDAT chunk; the last one ends with the Adler-32 of all.
void put_strips(std::vector<std::byte>& to, std::span<const PngStrip> strips) {
    std::size_t size = to.size() + 64;
    for (const PngStrip& strip : strips) size += strip.bytes.size() + 16;
    to.reserve(size);
    uLong adler = 1;
    for (const PngStrip& strip : strips) {
        adler = adler32_combine(adler, strip.adler, z_off_t(strip.filtered));
        const bool last = &strip == &strips.back();
        std::vector<std::byte> sum;
        if (last) put_be32(sum, adler);
        put_be32(to, strip.bytes.size() + sum.size());
        put_text(to, "IDAT");
        put_bytes(to, strip.bytes);
        put_bytes(to, sum);
        // Asked for the bytes at no address, libdeflate starts anew.
        put_be32(to, last ? libdeflate_crc32(strip.crc, sum.data(), sum.size()) : strip.crc);
    }
}

Samples rgba_of(const Image& image) {
    return {pixel_bytes(image).data(), image.width, image.height, 4, image.bits()};
}

std::vector<std::byte> file_of(const Samples& samples, PngRows& rows, Bytes icc,
                               const std::optional<Resolution>& resolution) {
    const std::vector<PngStrip> strips = rows.finish();
    std::vector<std::byte> file;
    put_text(file, "\x89PNG\r\n\x1a\n");
    put_header(file, samples, rows.kept_channels());
    put_profile(file, icc);
    put_resolution(file, resolution);
    put_strips(file, strips);
    put_chunk(file, "IEND", {});
    return file;
}

}  // namespace

ImageEncoding::ImageEncoding(const ImageFormat& format, const Image& image, const EncodeOptions& options)
    : format_(format), image_(image), options_(options) {
    if (format.encode == &encode_png) png_ = std::make_unique<PngRows>(rgba_of(image), options.compression);
}

ImageEncoding::~ImageEncoding() = default;

void ImageEncoding::advance(int rows) {
    if (png_) png_->advance(rows);
}

std::vector<std::byte> ImageEncoding::finish() {
    return png_ ? file_of(rgba_of(image_), *png_, image_.icc, image_.resolution)
                : format_.encode(image_, options_);
}

std::vector<std::byte> encode_png(const Image& image, const EncodeOptions& options) {
    PngRows rows(rgba_of(image), options.compression);
    rows.advance(image.height);
    return file_of(rgba_of(image), rows, image.icc, image.resolution);
}

std::vector<std::byte> encode_png_samples(int width, int height, int channels,
                                          std::span<const std::uint16_t> grey) {
    const Samples samples{std::as_bytes(grey).data(), width, height, channels, 16};
    PngRows rows(samples, Compression::standard);
    rows.advance(height);
    return file_of(samples, rows, {}, {});
}

}  // namespace probewarp
