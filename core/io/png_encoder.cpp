#include "io/png_encoder.h"

#include <libdeflate.h>
#include <tbb/info.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <limits>

#include "io/deflate_strip.h"
#include "io/formats.h"
#include "io/png_filter.h"

namespace probewarp {

namespace {

// ---- one strip ----

/// How hard a compression tries.
struct Effort {
    std::array<FilterSet, 3>
        filters;      ///< each in turn for the whole strip, the smallest kept; 0: none further
    int quick_level;  ///< ISA-L's; 0: libdeflate's from the start
    /// libdeflate's, where a strip packs to a sixth or less, as photographs never do; 12: zlib besides, where
    /// it packs to a twentieth
    int level;
    std::size_t strip_bytes;       ///< about
    std::array<unsigned, 2> zlib;  ///< the stream's two first bytes, which hint at the level
};

// Measured on photographs and drawings. On photographs ISA-L makes what zlib's 5 does within three per cent,
// twenty times as fast; drawings need libdeflate's 4 for that, and there it costs little. 12 is its best.
// Choosing row by row serves photographs best, but repetitive drawings do better with one filter throughout.
// Strips forget what was before: at a mebibyte that costs a thousandth.
constexpr Effort effort_of(Compression compression) {
    constexpr std::size_t mebibyte = std::size_t{1} << 20;
    switch (compression) {
        case Compression::fast:
            return {{sub_or_up}, 1, 1, mebibyte, {0x78, 0x01}};
        case Compression::small:
            return {{all_filters, no_filter, up_filter}, 0, 12, 8 * mebibyte, {0x78, 0xDA}};
        default:
            return {{all_filters}, 2, 4, mebibyte, {0x78, 0x9C}};
    }
}

std::size_t pixel_bytes_of(const PngShape& shape) { return std::size_t(shape.kept * shape.bits / 8); }
std::size_t row_bytes_of(const PngShape& shape) { return std::size_t(shape.width) * pixel_bytes_of(shape); }

}  // namespace

/// The rows of one strip, and the one above them.
struct PngStripRows {
    PngShape shape;
    int first, end;
    std::vector<PngRows::Placed> bands;

    const std::byte* row(int y) const {
        const auto after = std::ranges::find_if(bands, [y](const auto& b) { return b.top > y; });
        const auto& holds = *std::prev(after);
        const std::size_t bytes = std::size_t(shape.width) * std::size_t(shape.channels * shape.bits / 8);
        return holds.band.first.get() + std::size_t(y - holds.top) * bytes;
    }
};

namespace {

/// Copies the kept channels of every pixel. from: width x channels; to: width x kept, in the file's byte
/// order.
template <class Sample>
void pack_row(const Sample* from, const PngShape& shape, std::uint8_t* to) {
    const auto channels = std::size_t(shape.channels), kept = std::size_t(shape.kept);
    for (std::size_t x = 0; x < std::size_t(shape.width); ++x)
        for (std::size_t c = 0; c < kept; ++c) {
            const Sample sample = from[x * channels + c];
            if constexpr (sizeof(Sample) == 2) *to++ = std::uint8_t(sample >> 8);
            *to++ = std::uint8_t(sample & 0xFF);
        }
}

void pack_row(const std::byte* from, const PngShape& shape, std::span<std::uint8_t> to) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(from);
    if (shape.bits == 16)
        pack_row(reinterpret_cast<const std::uint16_t*>(from), shape, to.data());
    else if (shape.channels == 4 && shape.kept == 3)
        drop_alpha({bytes, std::size_t(shape.width) * 4}, to);
    else
        std::ranges::copy(std::span(bytes, to.size()), to.begin());
}

std::vector<std::uint8_t> filtered(const PngStripRows& rows, FilterSet filters) {
    const PngShape& shape = rows.shape;
    const std::size_t bytes = row_bytes_of(shape);
    std::vector<std::uint8_t> out(std::size_t(rows.end - rows.first) * (bytes + 1));
    std::vector<std::uint8_t> row(bytes), above(bytes);
    if (rows.first > 0) pack_row(rows.row(rows.first - 1), shape, above);
    for (int y = rows.first; y < rows.end; ++y) {
        pack_row(rows.row(y), shape, row);
        const auto to = std::span(out).subspan(std::size_t(y - rows.first) * (bytes + 1), bytes + 1);
        filter_row(row, above, pixel_bytes_of(shape), filters, to);
        std::swap(row, above);
    }
    return out;
}

/// Filtered in each of the effort's ways, the one that packs best at a level that is quick.
std::vector<std::uint8_t> best_filtered(const PngStripRows& rows, const Effort& effort) {
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
    if (effort.quick_level > 0) {
        std::vector<std::byte> quick = deflate_quickly(raw, last, effort.quick_level);
        if (quick.size() > raw.size() / 6) return quick;
    }
    std::vector<std::byte> out = deflate_whole(raw, effort.level);
    if (!last) open_end(out, raw.size());
    if (effort.level == 12 && out.size() <= raw.size() / 20) {
        std::vector<std::byte> other = deflate_by_zlib(raw, last);
        if (other.size() < out.size()) return other;
    }
    return out;
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

void make_strip(const PngStripRows& rows, const Effort& effort, PngStrip& strip) {
    const std::vector<std::uint8_t> raw = best_filtered(rows, effort);
    const bool last = rows.end == rows.shape.height;
    std::vector<std::byte> deflated = deflated_strip(std::as_bytes(std::span(raw)), effort, last);
    if (rows.first == 0)
        deflated.insert(deflated.begin(), {std::byte(effort.zlib[0]), std::byte(effort.zlib[1])});
    strip.chunk.reserve(deflated.size() + 12);
    put_chunk(strip.chunk, "IDAT", deflated);
    strip.adler = libdeflate_adler32(1, raw.data(), raw.size());
    strip.filtered = raw.size();
    strip.done = true;
}

}  // namespace

// ---- all strips ----

namespace {

int rows_of_a_strip(const PngShape& shape, Compression compression) {
    return int(std::max<std::size_t>(1, effort_of(compression).strip_bytes / (row_bytes_of(shape) + 1)));
}

}  // namespace

PngRows::PngRows(const PngShape& shape, Compression compression)
    : shape_(shape),
      compression_(compression),
      strip_rows_(rows_of_a_strip(shape, compression)),
      strips_(std::size_t((shape.height + strip_rows_ - 1) / strip_rows_)) {}

PngRows::~PngRows() {
    tasks_.cancel();
    try {
        tasks_.wait();
    } catch (...) {  // of no use to anybody any more
    }
}

void PngRows::add(const PngBand& band) {
    const std::size_t most_under_way = std::max((std::size_t{8} << 20) / effort_of(compression_).strip_bytes,
                                                std::size_t(tbb::info::default_concurrency()));
    assert(rows_ + band.rows <= shape_.height);
    bands_.push_back({band, rows_});
    rows_ += band.rows;
    for (; started_ < strips_.size(); ++started_) {
        const int first = int(started_) * strip_rows_, end = std::min(first + strip_rows_, shape_.height);
        while (bands_.front().top + bands_.front().band.rows < first) bands_.pop_front();
        if (end > rows_) break;
        const PngStripRows rows{shape_, first, end, {bands_.begin(), bands_.end()}};
        PngStrip& strip = strips_[started_];
        // Where the others lag behind, it is done here and now.
        if (under_way_ >= most_under_way) {
            make_strip(rows, effort_of(compression_), strip);
            continue;
        }
        ++under_way_;
        tasks_.run([this, rows, &strip] {
            make_strip(rows, effort_of(compression_), strip);
            --under_way_;
        });
    }
}

FileParts PngRows::take() {
    FileParts chunks;
    for (; taken_ + 1 < strips_.size() && strips_[taken_].done; ++taken_)
        chunks.push_back(chunk_of(strips_[taken_]));
    return chunks;
}

FileParts PngRows::finish() {
    assert(rows_ == shape_.height);
    tasks_.wait();
    FileParts chunks = take();
    const std::vector<std::byte> last = chunk_of(strips_.back());
    std::vector<std::byte> data(last.begin() + 8, last.end() - 4);  // without length, type and CRC
    put_be32(data, adler_);                                         // RFC 1950, section 2.2: behind all data
    put_chunk(chunks.emplace_back(), "IDAT", data);
    return chunks;
}

std::vector<std::byte> PngRows::chunk_of(PngStrip& strip) {
    adler_ = std::uint32_t(adler32_combine(adler_, strip.adler, z_off_t(strip.filtered)));
    return std::move(strip.chunk);
}

// ---- the file ----

namespace {

/// IHDR: section 11.2.1.
void put_header(std::vector<std::byte>& to, const PngShape& shape) {
    constexpr std::array<unsigned, 5> colour_types{0, 0, 4, 2, 6};  // by channels
    std::vector<std::byte> data;
    put_be32(data, std::size_t(shape.width));
    put_be32(data, std::size_t(shape.height));
    data.push_back(std::byte(shape.bits));
    data.push_back(std::byte(colour_types[std::size_t(shape.kept)]));
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

/// What the file says of its colours, in the order of section 5.6; where a profile stands, sRGB may not.
void put_colours(std::vector<std::byte>& to, const Description& said) {
    if (said.cicp) put_chunk(to, "cICP", std::as_bytes(std::span(*said.cicp)));
    put_profile(to, said.icc);
    if (said.srgb_intent && said.icc.empty()) put_chunk(to, "sRGB", std::array{std::byte(*said.srgb_intent)});
    std::vector<std::byte> data;
    if (said.gamma) {
        put_be32(data, *said.gamma);
        put_chunk(to, "gAMA", data);
    }
    if (said.chromaticities) {
        data.clear();
        for (const std::uint32_t xy : *said.chromaticities) put_be32(data, xy);
        put_chunk(to, "cHRM", data);
    }
}

/// unit: 1 for a metre, 0 for one that nobody knows
void put_pixel_size(std::vector<std::byte>& to, const Resolution& pixels, int unit) {
    if (!is_resolution(pixels.x, pixels.y)) return;
    std::vector<std::byte> data;
    put_be32(data, pixels.x);
    put_be32(data, pixels.y);
    data.push_back(std::byte(unit));
    put_chunk(to, "pHYs", data);
}

void put_offset(std::vector<std::byte>& to, const std::array<std::int32_t, 2>& offset) {
    std::vector<std::byte> data;
    for (const std::int32_t pixels : offset) put_be32(data, std::uint32_t(pixels));
    data.push_back(std::byte{0});  // pixels
    put_chunk(to, "oFFs", data);
}

std::vector<std::byte> joined(std::vector<std::byte> all, const FileParts& parts) {
    std::size_t size = all.size();
    for (const auto& part : parts) size += part.size();
    all.reserve(size);
    for (const auto& part : parts) put_bytes(all, part);
    return all;
}

/// All of the samples, which the caller keeps.
PngBand band_of(const std::byte* samples, int rows) {
    return {std::shared_ptr<const std::byte>(std::shared_ptr<void>(), samples), rows};
}

}  // namespace

PngShape png_shape(const Image& image, bool transparent) {
    return {image.width, image.height, image.bits(), 4, transparent ? 4 : 3};
}

std::vector<std::byte> png_beginning(const PngShape& shape, const Description& description) {
    std::vector<std::byte> begin;
    put_text(begin, "\x89PNG\r\n\x1a\n");
    put_header(begin, shape);
    put_colours(begin, description);
    if (description.resolution)
        put_pixel_size(begin, *description.resolution, 1);
    else if (description.aspect)
        put_pixel_size(begin, *description.aspect, 0);
    if (!description.exif.empty()) put_chunk(begin, "eXIf", description.exif);
    if (description.offset) put_offset(begin, *description.offset);
    return begin;
}

FileParts png_rest(PngRows& rows) {
    FileParts parts = rows.finish();
    put_chunk(parts.emplace_back(), "IEND", {});
    return parts;
}

std::vector<std::byte> encode_png(const Image& image, const EncodeOptions& options) {
    const PngShape shape = png_shape(image, has_alpha(image));
    PngRows rows(shape, options.compression);
    rows.add(band_of(pixel_bytes(image).data(), image.height));
    return joined(png_beginning(shape, image.description), png_rest(rows));
}

std::vector<std::byte> encode_png_samples(int width, int height, int channels,
                                          std::span<const std::uint16_t> grey) {
    const PngShape shape{width, height, 16, channels, channels};
    PngRows rows(shape, Compression::standard);
    rows.add(band_of(std::as_bytes(grey).data(), height));
    return joined(png_beginning(shape, {}), png_rest(rows));
}

}  // namespace probewarp
