// JPEG in through libjpeg-turbo; jpeg_encoder.cpp is the way out. The picture comes upright, in RGB, and
// whole, or else an Error.
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <optional>

#include "io/colours.h"
#include "io/exif.h"
#include "io/foreign_colours.h"
#include "io/formats.h"
#include "io/jpeg_errors.h"
#include "io/row_reader.h"
#include "io/upright.h"

namespace probewarp {

namespace {

// ---- errors ----

/// What was found wrong with a file of which what is there is to be opened.
struct Damage {
    int markers = 0;           ///< that were kept for what they say of the picture
    bool passed_over = false;  ///< whether damage is passed over; else it ends the decoding
    bool found = false;
    /// The first row that the data do not reach.
    std::size_t end_row = std::numeric_limits<std::size_t>::max();

    /// libjpeg looks through all that it has kept for each one more, which takes hours where there are
    /// millions of them. A profile has at most 255, and extended XMP about 16 a mebibyte.
    bool has_too_many_markers(const jpeg_common_struct& codec) {
        const int marker = codec.err->msg_parm.i[0];
        const bool kept = marker == JPEG_APP0 + 1 || marker == JPEG_APP0 + 2;
        return codec.err->msg_code == JTRC_MISC_MARKER && kept && ++markers > 10'000;
    }

    void note(const jpeg_decompress_struct& jpeg) {
        found = true;
        const int code = jpeg.err->msg_code;
        const bool at_end =
            code == JWRN_JPEG_EOF || (code == JWRN_HIT_MARKER && jpeg.unread_marker == JPEG_EOI);
        // Later scans only make finer what the first one brought.
        if (!at_end || jpeg.input_scan_number > 1) return;
        const std::size_t block_rows = std::size_t(jpeg.max_v_samp_factor) * DCTSIZE;
        end_row = std::min(end_row, (std::size_t(jpeg.input_iMCU_row) + 1) * block_rows);
    }
};

/// Level -1 is a warning: mostly the data are bad and libjpeg would go on with made-up pixels. We go on where
/// the pixels are sure to be right, or where one asks for what is there.
void on_message(j_common_ptr codec, int level) {
    auto& damage = *static_cast<Damage*>(codec->client_data);
    if (damage.has_too_many_markers(*codec)) give_up(codec, JpegTrouble::markers, true);
    if (level >= 0) return;
    const int code = codec->err->msg_code;
    switch (code) {
        case JWRN_ADOBE_XFORM:      // an unknown transform: the usual one is meant
        case JWRN_EXTRANEOUS_DATA:  // bytes before a marker
        case JWRN_JFIF_MAJOR:       // a JFIF of the future
        case JWRN_BOGUS_ICC:        // parts of a profile are missing: it is left out
        case JWRN_NOT_SEQUENTIAL:   // odd parameters that a sequential scan does not use
            return;
        default:
            break;
    }
    if (!damage.passed_over)
        give_up(codec, code == JWRN_JPEG_EOF ? JpegTrouble::truncated : JpegTrouble::damaged);
    damage.note(*reinterpret_cast<j_decompress_ptr>(codec));
}

/// salvageable: whether there are rows that can be opened all the same
[[noreturn]] void report(const JpegErrors& errors, bool salvageable) {
    switch (errors.trouble) {
        case JpegTrouble::memory:
            throw Error("needs too much memory while it is read; expected a smaller or a sequential JPEG");
        case JpegTrouble::scans:
            throw Error("has far more scans than its size explains; expected a usual progressive JPEG");
        case JpegTrouble::markers:
            throw Error("has far more application markers than a picture needs; expected a usual JPEG file");
        case JpegTrouble::unusual:
            throw Error("is of an unusual kind (" + std::string(errors.message) +
                        "); expected a baseline or progressive JPEG of 8 bits a sample");
        default:
            break;
    }
    const Error why =
        errors.trouble == JpegTrouble::truncated ? truncated("JPEG") : damaged("JPEG", errors.message);
    if (salvageable) throw IncompleteFile(why.what());
    throw why;
}

// ---- the file ----

/// A progressive file can hold hundreds of scans, each next to no bytes long and each over the whole picture,
/// at some 50 ms for 100 million pixels. Common encoders make about ten; the limit keeps the time below a
/// second or so.
int scan_limit(double pixels) { return int(std::clamp(2e9 / pixels, 20.0, 64.0)); }

void on_progress(j_common_ptr codec) {
    const auto* jpeg = reinterpret_cast<j_decompress_ptr>(codec);
    if (jpeg->input_scan_number > scan_limit(double(jpeg->image_width) * jpeg->image_height))
        give_up(codec, JpegTrouble::scans, true);
}

struct Decoder {
    JpegErrors errors;
    Damage damage;
    jpeg_progress_mgr progress{};
    jpeg_decompress_struct jpeg{};
    unsigned char* icc = nullptr;
    unsigned icc_bytes = 0;
    bool begun = false;  ///< the header has been read

    Decoder() {
        set_up(errors, on_message);
        jpeg.err = &errors.manager;
        jpeg.client_data = &damage;
        if (!protect(errors, [this] { jpeg_create_decompress(&jpeg); })) throw std::bad_alloc();
        progress.progress_monitor = on_progress;
        jpeg.progress = &progress;
    }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;
    ~Decoder() {
        std::free(icc);
        jpeg_destroy_decompress(&jpeg);
    }

    Bytes profile() const { return std::as_bytes(std::span(icc, icc_bytes)); }

    /// Whether there are rows already.
    bool has_rows() const { return jpeg.input_scan_number > 1 || jpeg.input_iMCU_row > 0; }

    template <class Step>
    void run(const Step& step) {
        if (!protect(errors, step)) report(errors, begun && (!errors.fatal || has_rows()));
    }

    /// False where the step cannot be done, and what came before it is to be opened.
    template <class Step>
    bool run_if_sound(const Step& step) {
        if (!damage.passed_over || !has_rows()) return run(step), true;
        if (protect(errors, step)) return true;
        damage.found = true;
        damage.end_row = std::min<std::size_t>(damage.end_row, jpeg.output_scanline);
        return false;
    }
};

void read_header(Decoder& decoder, Bytes bytes, bool salvage) {
    jpeg_decompress_struct& jpeg = decoder.jpeg;
    decoder.run([&] {
        jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
        jpeg_save_markers(&jpeg, JPEG_APP0 + 1, 0xFFFF);  // EXIF
        jpeg_save_markers(&jpeg, JPEG_APP0 + 2, 0xFFFF);  // ICC
        jpeg_read_header(&jpeg, TRUE);
        jpeg_read_icc_profile(&jpeg, &decoder.icc, &decoder.icc_bytes);
    });
    if (jpeg.src->bytes_in_buffer == 0) throw truncated("JPEG");
    check_image_size(jpeg.image_width, jpeg.image_height, 8);
    // A progressive file's coefficients are there beside its bytes and its pixels.
    const std::size_t others = bytes.size() + std::size_t(jpeg.image_width) * jpeg.image_height * 4;
    jpeg.mem->max_memory_to_use = long(max_decoding_bytes - others);
    decoder.begun = true;
    decoder.damage.passed_over = salvage;
}

// ---- what is there of a file ----

/// Where the segment begins of which the file has only a part; its size where there is none.
std::size_t end_of_segments(Bytes file) {
    for (std::size_t at = 2; at < file.size();) {
        const auto rest = file.subspan(at);
        at += std::size_t(std::ranges::find(rest, std::byte{0xFF}) - rest.begin());
        if (file.size() - at < 2) break;
        const unsigned marker = u8(file, at + 1);
        if (marker == JPEG_EOI) break;
        const bool restart = marker >= JPEG_RST0 && marker < JPEG_RST0 + 8;
        if (marker < 0xC0 || marker == 0xFF || restart) {  // amid the pixels' data
            ++at;
            continue;
        }
        const std::size_t end = file.size() - at < 4 ? file.size() + 1 : at + 2 + be16(file, at + 2);
        if (end > file.size()) return at;
        at = end;
    }
    return file.size();
}

/// Of a file in several scans with a segment that cannot be read: what comes before that.
Bytes before_the_bad_segment(const Decoder& decoder, Bytes file) {
    const auto* first = reinterpret_cast<const JOCTET*>(file.data());
    const JOCTET* segment = decoder.jpeg.src->next_input_byte;  // behind its marker of two bytes
    // At the file's end libjpeg has bytes of its own.
    const bool inside =
        std::less_equal<>()(first + 2, segment) && std::less<>()(segment, first + file.size());
    return file.first(inside ? std::size_t(segment - first) - 2 : end_of_segments(file));
}

/// Ready to decode rows. Of a file in several scans it has read all, before the pixels, so that a bad one
/// never takes memory for both. again: whether what comes before a segment that cannot be read is tried by
/// itself
std::unique_ptr<Decoder> begin_decoding(Bytes bytes, bool salvage, bool again = true) {
    auto decoder = std::make_unique<Decoder>();
    read_header(*decoder, bytes, salvage);
    jpeg_decompress_struct& jpeg = decoder->jpeg;
    const bool cmyk = jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK;
    jpeg.out_color_space = cmyk ? JCS_CMYK : JCS_EXT_RGBA;
    if (protect(decoder->errors, [&] { jpeg_start_decompress(&jpeg); })) return decoder;
    if (salvage && again && decoder->errors.trouble == JpegTrouble::damaged && decoder->has_rows())
        return begin_decoding(before_the_bad_segment(*decoder, bytes), salvage, false);
    report(decoder->errors, !decoder->errors.fatal || decoder->has_rows());
}

// ---- what the file says of its colours and itself ----

void describe_by_jfif(const jpeg_decompress_struct& jpeg, Description& said) {
    if (!jpeg.saw_JFIF_marker || jpeg.X_density == 0 || jpeg.Y_density == 0) return;
    if (jpeg.density_unit == 1 || jpeg.density_unit == 2) {
        const double per_metre = jpeg.density_unit == 1 ? 1 / 0.0254 : 100;
        said.resolution = Resolution{std::uint32_t(jpeg.X_density * per_metre + 0.5),
                                     std::uint32_t(jpeg.Y_density * per_metre + 0.5)};
    }
    // 1:1, which most files have, says nothing.
    if (jpeg.density_unit == 0 && jpeg.X_density != jpeg.Y_density)
        said.aspect = Resolution{jpeg.X_density, jpeg.Y_density};
}

Exif read_exif(const jpeg_decompress_struct& jpeg) {
    constexpr char head[] = "Exif\0";  // and one byte more, for which writers use 0 or 255
    for (const jpeg_marker_struct* m = jpeg.marker_list; m; m = m->next) {
        const Bytes data = std::as_bytes(std::span(m->data, m->data_length));
        if (m->marker == JPEG_APP0 + 1 && begins_with(data, head) && data.size() > sizeof head)
            return parse_exif(data.subspan(sizeof head));
    }
    return {};
}

// ---- pixels ----

class JpegReader final : public RowReader {
  public:
    JpegReader(Bytes bytes, const DecodeOptions& options) : decoder_(begin_decoding(bytes, options.salvage)) {
        const jpeg_decompress_struct& jpeg = decoder_->jpeg;
        // Full is no ink with Adobe's marker and, as other readers have it, without.
        if (jpeg.out_color_space == JCS_CMYK) to_srgb_.emplace(ForeignColours::cmyk, decoder_->profile());
        exif_ = read_exif(jpeg);  // before the end of decoding takes the markers away
        walk_ = upright_walk(exif_.orientation, jpeg.output_width, jpeg.output_height);
    }

    Image blank() override {
        const jpeg_decompress_struct& jpeg = decoder_->jpeg;
        Image image = blank_image(jpeg.output_width, jpeg.output_height, 8);
        Description& said = image.description;
        describe_by_jfif(jpeg, said);
        if (!said.resolution && exif_.resolution) {
            said.resolution = exif_.resolution;
            said.aspect.reset();
        }
        said.exif = exif_.block;
        if (!to_srgb_ && decoder_->icc) said.icc = rgb_profile(decoder_->profile());
        if (turned_on_its_side(exif_.orientation)) {
            std::swap(image.width, image.height);
            if (said.resolution) std::swap(said.resolution->x, said.resolution->y);
            if (said.aspect) std::swap(said.aspect->x, said.aspect->y);
        }
        image.opaque = true;
        return image;
    }

    int read(std::span<std::byte> pixels) override {
        jpeg_decompress_struct& jpeg = decoder_->jpeg;
        const std::size_t row_bytes = std::size_t(jpeg.output_width) * 4, first = jpeg.output_scanline;
        const std::size_t rows = std::min<std::size_t>(rows_at_once, jpeg.output_height - first);
        bool sound = false;
        if (exif_.orientation == 1) {
            sound = decode(first, pixels.subspan(first * row_bytes, rows * row_bytes));
        } else {
            stored_.assign(rows * row_bytes, std::byte{0});
            sound = decode(first, stored_);
            put_upright<4>(stored_, jpeg.output_width, first, walk_, pixels);
        }
        const bool done = !sound || jpeg.output_scanline == jpeg.output_height;
        // Reads up to the end marker.
        if (done && sound) decoder_->run_if_sound([&] { jpeg_finish_decompress(&jpeg); });
        if (!done) return exif_.orientation == 1 ? int(first + rows) : 0;
        return int(turned_on_its_side(exif_.orientation) ? jpeg.output_width : jpeg.output_height);
    }

    /// Once all has been read: whether something was wrong, and whether rows are missing.
    bool incomplete() const { return decoder_->damage.found; }
    bool lacks_rows() const { return decoder_->damage.end_row < decoder_->jpeg.output_height; }

  private:
    static constexpr std::size_t rows_at_once = 32;

    /// The next rows, whole ones, as they are stored; those that the data do not reach stay clear. False
    /// where the rest cannot be decoded. first: the first row; rgba: #rows x output_width x 4, clear
    bool decode(std::size_t first, std::span<std::byte> rgba) {
        jpeg_decompress_struct& jpeg = decoder_->jpeg;
        const std::size_t row_bytes = std::size_t(jpeg.output_width) * 4;
        auto* const samples = reinterpret_cast<std::uint8_t*>(rgba.data());
        bool sound = true;
        for (std::size_t at = 0; at < rgba.size() && sound; at += row_bytes) {
            JSAMPROW row = samples + at;
            sound = decoder_->run_if_sound([&] { jpeg_read_scanlines(&jpeg, &row, 1); });
        }
        const std::size_t end =
            std::max(first, std::min<std::size_t>(jpeg.output_scanline, decoder_->damage.end_row));
        const auto reached = rgba.first((end - first) * row_bytes);
        if (to_srgb_) to_srgb_->convert({samples, reached.size()});
        std::ranges::fill(rgba.subspan(reached.size()), std::byte{0});
        return sound;
    }

    std::unique_ptr<Decoder> decoder_;
    std::optional<ToSrgb> to_srgb_;  ///< of a file in printing inks
    Exif exif_;
    Walk walk_{};
    std::vector<std::byte> stored_;  ///< #rows_at_once x output_width x 4, for a picture that is not upright
};

}  // namespace

std::unique_ptr<RowReader> read_jpeg_rows(Bytes bytes, const DecodeOptions& options) {
    return std::make_unique<JpegReader>(bytes, options);
}

Image decode_jpeg(Bytes bytes, const DecodeOptions& options) {
    JpegReader reader(bytes, options);
    Image image = read_whole(reader);
    image.incomplete = reader.incomplete();
    image.opaque = !reader.lacks_rows();
    return image;
}

}  // namespace probewarp
