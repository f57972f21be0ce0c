// PNG in through libspng; png_encoder.cpp is the way out. The file's chunk list is walked first, so that
// libspng sees only whole files, and of those only the chunks that we use: text and the rest cannot cost
// anything.
#include <spng.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

#include "io/colours.h"
#include "io/formats.h"
#include "io/row_reader.h"

namespace probewarp {

namespace {

constexpr std::size_t signature_bytes = 8;
constexpr std::size_t chunk_overhead = 12;  // length, type, CRC

struct Context {
    spng_ctx* spng;

    explicit Context(int flags) : spng(spng_ctx_new(flags)) {
        if (!spng) throw std::bad_alloc();
    }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    ~Context() { spng_ctx_free(spng); }
};

// ---- reading ----

void check(int error) {
    if (error == SPNG_OK) return;
    if (error == SPNG_EMEM) throw std::bad_alloc();
    throw damaged("PNG", spng_strerror(error));
}

/// The parts of a file that libspng gets to see, one after the other.
struct Parts {
    std::vector<Bytes> spans;
    std::size_t part = 0;  // of spans
    std::size_t at = 0;    // in that part

    void add(Bytes bytes) {
        const bool adjoins = !spans.empty() && spans.back().data() + spans.back().size() == bytes.data();
        if (adjoins)
            spans.back() = Bytes(spans.back().data(), spans.back().size() + bytes.size());
        else
            spans.push_back(bytes);
    }
};

int read_parts(spng_ctx*, void* user, void* out, std::size_t length) {
    Parts& parts = *static_cast<Parts*>(user);
    auto* to = static_cast<std::byte*>(out);
    while (length > 0) {
        if (parts.part == parts.spans.size()) return SPNG_IO_EOF;
        const Bytes rest = parts.spans[parts.part].subspan(parts.at);
        const std::size_t step = std::min(rest.size(), length);
        std::memcpy(to, rest.data(), step);
        to += step;
        length -= step;
        parts.at += step;
        if (step == rest.size()) ++parts.part, parts.at = 0;
    }
    return SPNG_OK;
}

/// Whether the chunk matters to us. One that is critical and unknown goes to libspng, which refuses it.
bool wanted(Bytes type) {
    const bool critical = (u8(type, 0) & 0x20u) == 0;
    return critical || begins_with(type, "tRNS") || begins_with(type, "iCCP") || begins_with(type, "pHYs");
}

struct Survey {
    Parts parts;
    std::size_t idat_bytes = 0;
};

/// `ihdr`: what should be the IHDR chunk. Before libspng sees it, which would only say that some limit is
/// exceeded.
void check_dimensions(Bytes ihdr) {
    if (!begins_with(ihdr.subspan(4), "IHDR") || ihdr.size() != chunk_overhead + 13)
        throw damaged("PNG", "it does not start with IHDR");
    check_image_size(be32(ihdr, 8), be32(ihdr, 12), u8(ihdr, 16) == 16 ? 16 : 8);
}

/// Walks the chunks by their lengths up to IEND. Throws where the file ends before.
Survey survey(Bytes file) {
    Survey found;
    found.parts.add(file.first(signature_bytes));
    for (std::size_t at = signature_bytes;;) {
        if (file.size() - at < chunk_overhead) throw truncated("PNG");
        const std::size_t length = be32(file, at);
        if (length > file.size() - at - chunk_overhead) throw truncated("PNG");
        const Bytes chunk = file.subspan(at, length + chunk_overhead);
        const Bytes type = chunk.subspan(4, 4);
        if (at == signature_bytes) check_dimensions(chunk);
        if (wanted(type)) found.parts.add(chunk);
        if (begins_with(type, "IDAT")) found.idat_bytes += length;
        if (begins_with(type, "IEND")) return found;
        at += chunk.size();
    }
}

/// Bytes of the deflated stream once inflated, at least: the rows without their filter bytes.
std::size_t raw_bytes(const spng_ihdr& ihdr) {
    constexpr std::array<std::size_t, 7> channels{1, 0, 3, 1, 2, 0, 4};  // by colour type
    const std::size_t bits = channels[ihdr.color_type] * ihdr.bit_depth;
    return (std::size_t(ihdr.width) * bits + 7) / 8 * ihdr.height;
}

void check_plausible(const spng_ihdr& ihdr, std::size_t idat_bytes) {
    // Deflate never needs much more than what it packs: such a file hides something behind its pixels.
    if (idat_bytes > raw_bytes(ihdr) + raw_bytes(ihdr) / 8 + 65536)
        throw damaged("PNG", "more data than its pixels need");
    // Deflate cannot pack more than 1032 bytes into one.
    if (raw_bytes(ihdr) / 1032 > idat_bytes)
        throw damaged("PNG", "it holds too little data for " + std::to_string(ihdr.width) + " x " +
                                 std::to_string(ihdr.height) + " pixels");
}

void set_limits(spng_ctx* spng) {
    check(spng_set_crc_action(spng, SPNG_CRC_ERROR, SPNG_CRC_ERROR));
    check(spng_set_image_limits(spng, max_image_side, max_image_side));
    // Of what is kept beside the pixels only a profile can be long, and it comes deflated.
    check(spng_set_chunk_limits(spng, max_icc_bytes, 2 * max_icc_bytes));
}

/// The header, after which libspng is ready to decode. `parts` must outlive the decoding.
spng_ihdr open_stream(spng_ctx* spng, Parts& parts) {
    set_limits(spng);
    if (parts.spans.size() == 1)  // nothing was left out: libspng need not copy it
        check(spng_set_png_buffer(spng, parts.spans[0].data(), parts.spans[0].size()));
    else
        check(spng_set_png_stream(spng, read_parts, &parts));
    spng_ihdr ihdr{};
    check(spng_get_ihdr(spng, &ihdr));
    return ihdr;
}

/// Inflates all rows without keeping a pixel. Putting interlaced pixels into their places takes libspng
/// seconds where there are many, which a file that is bad at its end is not to cost.
void check_rows(Parts parts) {
    const Context context(0);
    const spng_ihdr ihdr = open_stream(context.spng, parts);
    check(spng_decode_image(context.spng, nullptr, 0, SPNG_FMT_RAW, SPNG_DECODE_PROGRESSIVE));
    std::vector<std::byte> row(std::size_t(ihdr.width) * 8);  // 8: RGBA of 16 bits, the longest there is
    int error = SPNG_OK;
    while (error == SPNG_OK) error = spng_decode_scanline(context.spng, row.data(), row.size());
    if (error != SPNG_EOI) check(error);
}

void read_extras(spng_ctx* spng, Image& image) {
    spng_iccp iccp{};
    if (spng_get_iccp(spng, &iccp) == SPNG_OK)
        image.description.icc = rgb_profile(std::as_bytes(std::span(iccp.profile, iccp.profile_len)));
    spng_phys phys{};
    if (spng_get_phys(spng, &phys) == SPNG_OK && phys.unit_specifier == 1 &&
        is_resolution(phys.ppu_x, phys.ppu_y))
        image.description.resolution = Resolution{phys.ppu_x, phys.ppu_y};
}

/// Whether the file has no alpha to say.
bool has_no_alpha(spng_ctx* spng, const spng_ihdr& ihdr) {
    const bool alpha_channel = (ihdr.color_type & 4u) != 0;
    spng_trns trns{};
    return !alpha_channel && spng_get_trns(spng, &trns) == SPNG_ECHUNKAVAIL;
}

class PngReader final : public RowReader {
  public:
    explicit PngReader(Bytes bytes)
        : found_(survey(bytes)), context_(0), ihdr_(open_stream(context_.spng, found_.parts)) {
        check_plausible(ihdr_, found_.idat_bytes);
        if (ihdr_.interlace_method && std::uint64_t(ihdr_.width) * ihdr_.height > 4'000'000)
            check_rows(survey(bytes).parts);
    }

    Image blank() override {
        const bool deep = ihdr_.bit_depth == 16;
        Image image = blank_image(ihdr_.width, ihdr_.height, deep ? 16 : 8);
        check(spng_decode_image(context_.spng, nullptr, 0, deep ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8,
                                SPNG_DECODE_TRNS | SPNG_DECODE_PROGRESSIVE));
        read_extras(context_.spng, image);
        image.opaque = has_no_alpha(context_.spng, ihdr_);
        return image;
    }

    int read(std::span<std::byte> pixels) override {
        constexpr int rows_at_once = 32;
        const std::size_t row_bytes = pixels.size() / ihdr_.height;
        spng_row_info row{};
        for (int i = 0; i < rows_at_once; ++i) {
            check(spng_get_row_info(context_.spng, &row));
            const auto to = pixels.subspan(row.row_num * row_bytes, row_bytes);
            const int error = spng_decode_row(context_.spng, to.data(), to.size());
            if (error == SPNG_EOI) {
                check(spng_decode_chunks(context_.spng));
                return int(ihdr_.height);
            }
            check(error);
        }
        return ihdr_.interlace_method ? 0 : int(row.row_num) + 1;
    }

  private:
    Survey found_;
    Context context_;
    spng_ihdr ihdr_;
};

}  // namespace

std::unique_ptr<RowReader> read_png_rows(Bytes bytes, const DecodeOptions&) {
    return std::make_unique<PngReader>(bytes);
}

Image decode_png(Bytes bytes, const DecodeOptions&) {
    PngReader reader(bytes);
    return read_whole(reader);
}

}  // namespace probewarp
