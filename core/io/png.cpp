// PNG in through libspng; png_encoder.cpp is the way out. The file's chunks are looked through first, so that
// libspng sees only sound ones, and of those only what the pixels need: the rest cannot cost anything.
#include <spng.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <new>

#include "io/formats.h"
#include "io/png_chunks.h"
#include "io/row_reader.h"
#include "io/upright.h"

namespace probewarp {

namespace {

struct Context {
    spng_ctx* spng;

    explicit Context(int flags) : spng(spng_ctx_new(flags)) {
        if (!spng) throw std::bad_alloc();
    }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    ~Context() { spng_ctx_free(spng); }
};

void check(int error) {
    if (error == SPNG_OK) return;
    if (error == SPNG_EMEM) throw std::bad_alloc();
    throw damaged("PNG", spng_strerror(error));
}

/// What libspng gets to see, and how much of it it has seen. The file must outlive it.
struct Source {
    const std::vector<Bytes>& parts;
    std::size_t part = 0;  // of parts
    std::size_t at = 0;    // in that part
};

int read_source(spng_ctx*, void* user, void* out, std::size_t length) {
    Source& source = *static_cast<Source*>(user);
    auto* to = static_cast<std::byte*>(out);
    while (length > 0) {
        if (source.part == source.parts.size()) return SPNG_IO_EOF;
        const Bytes rest = source.parts[source.part].subspan(source.at);
        const std::size_t step = std::min(rest.size(), length);
        std::memcpy(to, rest.data(), step);
        to += step;
        length -= step;
        source.at += step;
        if (step == rest.size()) ++source.part, source.at = 0;
    }
    return SPNG_OK;
}

/// The header, after which libspng is ready to decode. `source` must outlive the decoding.
spng_ihdr open_stream(spng_ctx* spng, Source& source) {
    // The checksums have been looked at, and some are made up.
    check(spng_set_crc_action(spng, SPNG_CRC_USE, SPNG_CRC_USE));
    check(spng_set_image_limits(spng, max_image_side, max_image_side));
    if (source.parts.size() == 1)  // nothing was left out: libspng need not copy it
        check(spng_set_png_buffer(spng, source.parts[0].data(), source.parts[0].size()));
    else
        check(spng_set_png_stream(spng, read_source, &source));
    spng_ihdr ihdr{};
    check(spng_get_ihdr(spng, &ihdr));
    return ihdr;
}

// ---- files that are not whole ----

/// Why decoding stopped. rows: that came before, of an interlaced picture those of its passes
[[noreturn]] void fail(int error, const PngFile& file, std::size_t rows) {
    if (error == SPNG_EMEM) throw std::bad_alloc();
    const bool cut = error == SPNG_EIDAT_TOO_SHORT && !file.has_end;
    const Error why = cut ? truncated("PNG") : damaged("PNG", spng_strerror(error));
    if (rows > 0) throw IncompleteFile(why.what());
    throw why;
}

struct Trial {
    int error = SPNG_OK;  ///< SPNG_EOI where all rows came
    std::size_t rows = 0;
};

/// Inflates up to so many rows without keeping a pixel.
Trial try_rows(const PngFile& file, std::size_t most) {
    const Context context(0);
    Source source{file.parts};
    const spng_ihdr ihdr = open_stream(context.spng, source);
    Trial trial;
    trial.error = spng_decode_image(context.spng, nullptr, 0, SPNG_FMT_RAW, SPNG_DECODE_PROGRESSIVE);
    std::vector<std::byte> row(std::size_t(ihdr.width) * 8);  // 8: RGBA of 16 bits, the longest there is
    while (trial.error == SPNG_OK && trial.rows < most) {
        trial.error = spng_decode_scanline(context.spng, row.data(), row.size());
        if (trial.error == SPNG_OK || trial.error == SPNG_EOI) ++trial.rows;
    }
    return trial;
}

/// Throws `why`, as IncompleteFile where there is a row to be salvaged.
[[noreturn]] void refuse(const Error& why, const PngFile& file) {
    if (try_rows(file, 1).rows > 0) throw IncompleteFile(why.what());
    throw why;
}

void refuse_if_not_whole(const PngFile& file) {
    if (file.end == PngEnd::cut) refuse(truncated("PNG"), file);
    if (file.end == PngEnd::damaged) refuse(damaged("PNG", spng_strerror(SPNG_ECHUNK_CRC)), file);
}

/// Bytes of the deflated stream once inflated, at least: the rows without their filter bytes.
std::size_t raw_bytes(const spng_ihdr& ihdr) {
    constexpr std::array<std::size_t, 7> channels{1, 0, 3, 1, 2, 0, 4};  // by colour type
    const std::size_t bits = channels[ihdr.color_type] * ihdr.bit_depth;
    return (std::size_t(ihdr.width) * bits + 7) / 8 * ihdr.height;
}

void check_plausible(const PngFile& file, const spng_ihdr& ihdr, bool salvage) {
    // Deflate never needs much more than what it packs: such a file hides something behind its pixels.
    if (file.idat_bytes > raw_bytes(ihdr) + raw_bytes(ihdr) / 8 + 65536)
        throw damaged("PNG", "more data than its pixels need");
    // Deflate cannot pack more than 1032 bytes into one.
    if (raw_bytes(ihdr) / 1032 <= file.idat_bytes) return;
    if (file.end == PngEnd::whole && file.has_end)
        throw damaged("PNG", "it holds too little data for " + std::to_string(ihdr.width) + " x " +
                                 std::to_string(ihdr.height) + " pixels");
    if (!salvage) refuse(truncated("PNG"), file);
}

// ---- pixels ----

/// A pass of an interlaced picture, section 8.2: its first pixel, the steps to the next ones, and the pixels
/// for which each of its own stands until later passes come.
struct Pass {
    std::size_t left, top, right, down, width, height;
};
constexpr std::array<Pass, 7> passes{{{0, 0, 8, 8, 8, 8},
                                      {4, 0, 8, 8, 4, 8},
                                      {0, 4, 4, 8, 4, 4},
                                      {2, 0, 4, 4, 2, 4},
                                      {0, 2, 2, 4, 2, 2},
                                      {1, 0, 2, 2, 1, 2},
                                      {0, 1, 1, 2, 1, 1}}};

class PngReader final : public RowReader {
  public:
    PngReader(Bytes bytes, const DecodeOptions& options)
        : salvage_(options.salvage), file_(survey_png(bytes)), ihdr_(open_stream(context_.spng, source_)) {
        if (!salvage_) refuse_if_not_whole(file_);
        check_plausible(file_, ihdr_, salvage_);
        // Putting interlaced pixels into their places takes seconds where there are many, which a file that
        // is bad at its end is not to cost.
        if (!salvage_ && interlaced() && std::uint64_t(ihdr_.width) * ihdr_.height > 4'000'000) {
            const Trial trial = try_rows(file_, std::numeric_limits<std::size_t>::max());
            if (trial.error != SPNG_EOI) fail(trial.error, file_, trial.rows);
        }
        walk_ = upright_walk(file_.orientation, ihdr_.width, ihdr_.height);
    }

    Image blank() override {
        Image image = blank_image(ihdr_.width, ihdr_.height, deep() ? 16 : 8);
        if (turned_on_its_side(file_.orientation)) std::swap(image.width, image.height);
        const int error =
            spng_decode_image(context_.spng, nullptr, 0, deep() ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8,
                              SPNG_DECODE_TRNS | SPNG_DECODE_PROGRESSIVE);
        if (error != SPNG_OK) fail(error, file_, 0);
        image.description = file_.description;
        image.opaque = (ihdr_.color_type & 4u) == 0 && !file_.transparent;
        return image;
    }

    int read(std::span<std::byte> pixels) override {
        constexpr std::size_t rows_at_once = 32;
        stored_.clear();
        const std::size_t first = rows_;
        int error = SPNG_OK;
        for (std::size_t i = 0; i < rows_at_once && error == SPNG_OK; ++i) {
            error = read_row(pixels);
            if (error == SPNG_OK || error == SPNG_EOI) ++rows_;
        }
        if (!interlaced() && !is_upright()) turn(first, pixels);
        if (error == SPNG_OK) return interlaced() || !is_upright() ? 0 : int(rows_);
        if (error != SPNG_EOI && (!salvage_ || rows_ == 0)) fail(error, file_, rows_);
        incomplete_ = error != SPNG_EOI || file_.end != PngEnd::whole;
        return int(turned_on_its_side(file_.orientation) ? ihdr_.width : ihdr_.height);
    }

    /// Whether something was missing, once all has been read.
    bool incomplete() const { return incomplete_; }

  private:
    bool deep() const { return ihdr_.bit_depth == 16; }
    bool interlaced() const { return ihdr_.interlace_method != 0; }
    bool is_upright() const { return file_.orientation == 1; }
    std::size_t pixel_bytes() const { return deep() ? 8 : 4; }

    /// The next row of the file, of an interlaced one that of a pass. libspng's error
    int read_row(std::span<std::byte> pixels) {
        const std::size_t row_bytes = ihdr_.width * pixel_bytes();
        if (!interlaced() && is_upright())
            return spng_decode_row(context_.spng, &pixels[rows_ * row_bytes], row_bytes);
        spng_row_info row{};
        check(spng_get_row_info(context_.spng, &row));
        const std::size_t at = interlaced() ? 0 : stored_.size();
        stored_.resize(at + row_bytes);
        const int error = spng_decode_scanline(context_.spng, &stored_[at], row_bytes);
        if (error != SPNG_OK && error != SPNG_EOI)
            stored_.resize(at);
        else if (interlaced())
            deep() ? scatter<8>(row, pixels) : scatter<4>(row, pixels);
        return error;
    }

    /// Puts stored_, a pass's row, where it belongs in the upright picture. What is salvaged shows each pixel
    /// in the places of those that may never come, too.
    template <std::size_t bytes>
    void scatter(const spng_row_info& row, std::span<std::byte> pixels) const {
        const Pass& pass = passes[std::size_t(row.pass)];
        const std::size_t bottom =
            std::min<std::size_t>(row.row_num + (salvage_ ? pass.height : 1), ihdr_.height);
        for (std::size_t x = pass.left, k = 0; x < ihdr_.width; x += pass.right, ++k) {
            const std::size_t end = std::min<std::size_t>(x + (salvage_ ? pass.width : 1), ihdr_.width);
            for (std::size_t y = row.row_num; y < bottom; ++y)
                for (std::size_t to = x; to < end; ++to)
                    std::memcpy(&pixels[std::size_t(walk_.at(std::ptrdiff_t(to), std::ptrdiff_t(y))) * bytes],
                                &stored_[k * bytes], bytes);
        }
    }

    /// Puts stored_, whole rows, where they belong in the upright picture.
    void turn(std::size_t first, std::span<std::byte> pixels) const {
        if (deep())
            put_upright<8>(stored_, ihdr_.width, first, walk_, pixels);
        else
            put_upright<4>(stored_, ihdr_.width, first, walk_, pixels);
    }

    bool salvage_, incomplete_ = false;
    PngFile file_;
    Source source_{file_.parts};
    Context context_{0};
    spng_ihdr ihdr_;
    Walk walk_{};
    std::size_t rows_ = 0;           ///< that came, of an interlaced picture those of its passes
    std::vector<std::byte> stored_;  ///< rows on their way to their places in the upright picture
};

}  // namespace

std::unique_ptr<RowReader> read_png_rows(Bytes bytes, const DecodeOptions& options) {
    return std::make_unique<PngReader>(bytes, options);
}

Image decode_png(Bytes bytes, const DecodeOptions& options) {
    PngReader reader(bytes, options);
    Image image = read_whole(reader);
    if (reader.incomplete()) {
        image.incomplete = true;
        image.opaque = false;
    }
    return image;
}

}  // namespace probewarp
