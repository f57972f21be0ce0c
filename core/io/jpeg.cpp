// JPEG in and out through libjpeg-turbo: the picture upright, in RGB, and whole, or an Error. libjpeg reports
// errors by a jump, so every call that may jump happens inside protect(), where no C++ object can be jumped
// over.
#include <csetjmp>
#include <cstddef>
#include <cstdio>  // jpeglib.h needs it and does not say so
#include <cstdlib>

#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <optional>

#include "io/colours.h"
#include "io/exif.h"
#include "io/foreign_colours.h"
#include "io/formats.h"
#include "io/jpeg_encoder.h"
#include "io/row_reader.h"

namespace probewarp {

namespace {

// ---- errors ----

enum class Trouble { none, truncated, damaged, memory, scans };

/// libjpeg's error manager (first member, so that its address is ours) and where it jumps to.
struct Errors {
    jpeg_error_mgr manager;
    std::jmp_buf jump;
    Trouble trouble;
    char message[JMSG_LENGTH_MAX];
};

[[noreturn]] void give_up(j_common_ptr codec, Trouble trouble) {
    auto* errors = reinterpret_cast<Errors*>(codec->err);
    errors->trouble = trouble;
    errors->manager.format_message(codec, errors->message);
    std::longjmp(errors->jump, 1);
}

void on_error(j_common_ptr codec) {
    const int code = codec->err->msg_code;
    const bool memory = code == JERR_OUT_OF_MEMORY || code == JERR_NO_BACKING_STORE;
    give_up(codec, memory ? Trouble::memory : Trouble::damaged);
}

/// Level -1 is a warning: the data are bad and libjpeg would go on with made-up pixels. We go on only where
/// the pixels are sure to be right.
void on_message(j_common_ptr codec, int level) {
    if (level >= 0) return;
    switch (codec->err->msg_code) {
        case JWRN_EXTRANEOUS_DATA:  // bytes before a marker
        case JWRN_JFIF_MAJOR:       // a JFIF of the future
        case JWRN_BOGUS_ICC:        // parts of a profile are missing: it is left out
        case JWRN_NOT_SEQUENTIAL:   // odd parameters that a sequential scan does not use
            return;
        case JWRN_JPEG_EOF:
            give_up(codec, Trouble::truncated);
        default:
            give_up(codec, Trouble::damaged);
    }
}

void set_up(Errors& errors) {
    jpeg_std_error(&errors.manager);
    errors.manager.error_exit = on_error;
    errors.manager.emit_message = on_message;
    errors.manager.output_message = [](j_common_ptr) {};
    errors.trouble = Trouble::none;
    errors.message[0] = 0;
}

/// Runs `step`, which calls libjpeg and creates nothing that has a destructor. False where it jumped out.
template <class Step>
[[gnu::noinline]] bool protect(Errors& errors, const Step& step) {
    if (setjmp(errors.jump) != 0) return false;
    step();
    return true;
}

[[noreturn]] void report(const Errors& errors) {
    if (errors.trouble == Trouble::truncated) throw truncated("JPEG");
    if (errors.trouble == Trouble::memory)
        throw Error("needs too much memory while it is read; expected a smaller or a sequential JPEG");
    if (errors.trouble == Trouble::scans)
        throw Error("has far more scans than its size explains; expected a usual progressive JPEG");
    throw damaged("JPEG", errors.message);
}

// ---- reading ----

/// A progressive file can hold hundreds of scans, each next to no bytes long and each over the whole picture,
/// at some 50 ms for 100 million pixels. Common encoders make about ten; the limit keeps the time below a
/// second or so.
int scan_limit(double pixels) { return int(std::clamp(2e9 / pixels, 20.0, 64.0)); }

void on_progress(j_common_ptr codec) {
    const auto* jpeg = reinterpret_cast<j_decompress_ptr>(codec);
    if (jpeg->input_scan_number > scan_limit(double(jpeg->image_width) * jpeg->image_height))
        give_up(codec, Trouble::scans);
}

struct Decoder {
    Errors errors;
    jpeg_progress_mgr progress{};
    jpeg_decompress_struct jpeg{};
    unsigned char* icc = nullptr;
    unsigned icc_bytes = 0;

    Decoder() {
        set_up(errors);
        jpeg.err = &errors.manager;
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

    template <class Step>
    void run(const Step& step) {
        if (!protect(errors, step)) report(errors);
    }
};

void read_header(Decoder& decoder, Bytes bytes) {
    decoder.run([&] {
        jpeg_mem_src(&decoder.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
        jpeg_save_markers(&decoder.jpeg, JPEG_APP0 + 1, 0xFFFF);  // EXIF
        jpeg_save_markers(&decoder.jpeg, JPEG_APP0 + 2, 0xFFFF);  // ICC
        jpeg_read_header(&decoder.jpeg, TRUE);
        jpeg_read_icc_profile(&decoder.jpeg, &decoder.icc, &decoder.icc_bytes);
    });
    check_image_size(decoder.jpeg.image_width, decoder.jpeg.image_height, 8);
    // A progressive file's coefficients are there beside its bytes and its pixels.
    const std::size_t others =
        bytes.size() + std::size_t(decoder.jpeg.image_width) * decoder.jpeg.image_height * 4;
    decoder.jpeg.mem->max_memory_to_use = long(max_decoding_bytes - others);
    // The arithmetic decoder makes up zeros without end from no bytes at all, and nobody writes such files.
    if (decoder.jpeg.arith_code) throw Error("is arithmetic-coded; expected a Huffman-coded JPEG file");
}

std::optional<Resolution> jfif_resolution(const jpeg_decompress_struct& jpeg) {
    if (!jpeg.saw_JFIF_marker || jpeg.X_density == 0 || jpeg.Y_density == 0) return {};
    if (jpeg.density_unit != 1 && jpeg.density_unit != 2) return {};
    const double per_metre = jpeg.density_unit == 1 ? 1 / 0.0254 : 100;
    return Resolution{std::uint32_t(jpeg.X_density * per_metre + 0.5),
                      std::uint32_t(jpeg.Y_density * per_metre + 0.5)};
}

Exif read_exif(const jpeg_decompress_struct& jpeg) {
    for (const jpeg_marker_struct* m = jpeg.marker_list; m; m = m->next) {
        const Bytes data = std::as_bytes(std::span(m->data, m->data_length));
        if (m->marker == JPEG_APP0 + 1 && begins_with(data, "Exif\0")) return parse_exif(data);
    }
    return {};
}

/// Where the upright picture has what was stored: its top-left pixel, and how far in the upright pixels one
/// step right and one step down go.
struct Walk {
    std::ptrdiff_t start, right, down;
};

bool turned_on_its_side(int orientation) { return orientation >= 5; }

/// orientation: EXIF's, 1 to 8; w, h: as stored
Walk upright_walk(int orientation, std::ptrdiff_t w, std::ptrdiff_t h) {
    const std::array<Walk, 8> walks{{{0, 1, w},
                                     {w - 1, -1, w},
                                     {w * h - 1, -1, -w},
                                     {w * (h - 1), 1, -w},
                                     {0, h, 1},
                                     {h - 1, h, -1},
                                     {w * h - 1, -h, -1},
                                     {h * (w - 1), -h, 1}}};
    return walks[std::size_t(orientation - 1)];
}

class JpegReader final : public RowReader {
  public:
    explicit JpegReader(Bytes bytes) {
        read_header(decoder_, bytes);
        jpeg_decompress_struct& jpeg = decoder_.jpeg;
        const bool cmyk = jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK;
        if (cmyk)
            to_srgb_.emplace(jpeg.saw_Adobe_marker ? ForeignColours::cmyk_inverted : ForeignColours::cmyk,
                             std::as_bytes(std::span(decoder_.icc, decoder_.icc_bytes)));
        jpeg.out_color_space = cmyk ? JCS_CMYK : JCS_EXT_RGBA;
        // Reads the whole of a progressive file: before the pixels, so that a bad one never takes memory for
        // both.
        decoder_.run([&] { jpeg_start_decompress(&jpeg); });
        exif_ = read_exif(jpeg);  // before the end of decoding takes the markers away
        walk_ = upright_walk(exif_.orientation, jpeg.output_width, jpeg.output_height);
    }

    Image blank() override {
        const jpeg_decompress_struct& jpeg = decoder_.jpeg;
        Image image = blank_image(jpeg.output_width, jpeg.output_height, 8);
        std::optional<Resolution>& resolution = image.description.resolution;
        resolution = jfif_resolution(jpeg);
        if (!resolution) resolution = exif_.resolution;
        if (!to_srgb_ && decoder_.icc)
            image.description.icc = rgb_profile(std::as_bytes(std::span(decoder_.icc, decoder_.icc_bytes)));
        if (turned_on_its_side(exif_.orientation)) {
            std::swap(image.width, image.height);
            if (resolution) std::swap(resolution->x, resolution->y);
        }
        image.opaque = true;
        return image;
    }

    int read(std::span<std::byte> pixels) override {
        jpeg_decompress_struct& jpeg = decoder_.jpeg;
        const std::size_t row_bytes = std::size_t(jpeg.output_width) * 4, first = jpeg.output_scanline;
        const std::size_t rows = std::min<std::size_t>(rows_at_once, jpeg.output_height - first);
        if (exif_.orientation == 1) {
            decode(pixels.subspan(first * row_bytes, rows * row_bytes));
        } else {
            stored_.resize(rows * row_bytes);
            decode(stored_);
            turn(first, rows, pixels);
        }
        const bool done = jpeg.output_scanline == jpeg.output_height;
        if (done) decoder_.run([&] { jpeg_finish_decompress(&jpeg); });  // reads up to the end marker
        if (exif_.orientation == 1) return int(first + rows);
        return !done ? 0
                     : int(turned_on_its_side(exif_.orientation) ? jpeg.output_width : jpeg.output_height);
    }

  private:
    static constexpr std::size_t rows_at_once = 32;

    /// The next rows, whole ones, as they are stored. rgba: #rows x output_width x 4
    void decode(std::span<std::byte> rgba) {
        jpeg_decompress_struct& jpeg = decoder_.jpeg;
        const std::size_t row_bytes = std::size_t(jpeg.output_width) * 4;
        auto* const samples = reinterpret_cast<std::uint8_t*>(rgba.data());
        for (std::size_t at = 0; at < rgba.size(); at += row_bytes) {
            JSAMPROW row = samples + at;
            decoder_.run([&] { jpeg_read_scanlines(&jpeg, &row, 1); });
        }
        if (to_srgb_) to_srgb_->convert({samples, rgba.size()});
    }

    /// Puts stored_ where it belongs in the upright picture.
    void turn(std::size_t first, std::size_t rows, std::span<std::byte> upright) const {
        const std::size_t width = decoder_.jpeg.output_width;
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t y = 0; y < rows; ++y) {
                const std::ptrdiff_t to =
                    walk_.start + std::ptrdiff_t(x) * walk_.right + std::ptrdiff_t(first + y) * walk_.down;
                std::memcpy(&upright[std::size_t(to) * 4], &stored_[(y * width + x) * 4], 4);
            }
    }

    Decoder decoder_;
    std::optional<ToSrgb> to_srgb_;  ///< of a file in printing inks
    Exif exif_;
    Walk walk_{};
    std::vector<std::byte> stored_;  ///< #rows_at_once x output_width x 4, for a picture that is not upright
};

}  // namespace

std::unique_ptr<RowReader> read_jpeg_rows(Bytes bytes, const DecodeOptions&) {
    return std::make_unique<JpegReader>(bytes);
}

Image decode_jpeg(Bytes bytes, const DecodeOptions&) {
    JpegReader reader(bytes);
    return read_whole(reader);
}

// ---- writing ----

struct JpegRows::Encoder {
    Errors errors;
    jpeg_compress_struct jpeg{};
    unsigned char* out = nullptr;
    unsigned long out_bytes = 0;

    Encoder() {
        set_up(errors);
        jpeg.err = &errors.manager;
        if (!protect(errors, [this] { jpeg_create_compress(&jpeg); })) throw std::bad_alloc();
    }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
    ~Encoder() {
        // `out` is only then where the bytes are: they move as they become more.
        if (jpeg.dest) jpeg.dest->term_destination(&jpeg);
        jpeg_destroy_compress(&jpeg);
        std::free(out);
    }

    template <class Step>
    void run(const Step& step) {
        if (protect(errors, step)) return;
        if (errors.trouble == Trouble::memory) throw std::bad_alloc();
        throw Error(std::string("cannot be written as JPEG: ") + errors.message);
    }
};

namespace {

/// Dots per inch or per centimetre, whichever gives the pixels per metre back; else inches, the finer of the
/// two. None where neither fits into JFIF's 16 bits.
void set_density(jpeg_compress_struct& jpeg, const Resolution& resolution) {
    constexpr double inch = 1 / 0.0254, centimetre = 100;  // dots per metre
    const auto dots = [](std::uint32_t per_metre, double unit) { return std::lround(per_metre / unit); };
    const auto fits = [&](std::uint32_t per_metre, double unit) {
        return dots(per_metre, unit) >= 1 && dots(per_metre, unit) <= 65535;
    };
    const auto both_fit = [&](double unit) { return fits(resolution.x, unit) && fits(resolution.y, unit); };
    const bool centimetres_exact = resolution.x % 100 == 0 && resolution.y % 100 == 0 && both_fit(centimetre);
    const double unit = !centimetres_exact && both_fit(inch) ? inch : centimetre;
    if (!both_fit(unit)) return;
    jpeg.density_unit = unit == inch ? 1 : 2;
    jpeg.X_density = UINT16(dots(resolution.x, unit));
    jpeg.Y_density = UINT16(dots(resolution.y, unit));
}

void set_parameters(jpeg_compress_struct& jpeg, const Image& image, int quality) {
    jpeg.image_width = JDIMENSION(image.width);
    jpeg.image_height = JDIMENSION(image.height);
    jpeg.input_components = 4;
    jpeg.in_color_space = JCS_EXT_RGBX;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, std::clamp(quality, 1, 100), TRUE);
    // Colours at full size (4:4:4): a deformed picture is worked on further, and edges of colour must not
    // blur.
    for (int i = 0; i < jpeg.num_components; ++i)
        jpeg.comp_info[i].h_samp_factor = jpeg.comp_info[i].v_samp_factor = 1;
    if (image.description.resolution) set_density(jpeg, *image.description.resolution);
}

/// One row over the background, as 8-bit RGB and a byte of no meaning. Exact: one division, rounded to the
/// nearest. rgba, rgbx: width x 4
template <class Sample>
void flatten(const Sample* rgba, std::span<std::uint8_t> rgbx, Colour background) {
    constexpr std::uint64_t full = std::numeric_limits<Sample>::max();
    constexpr std::uint64_t scale = full / 255;  // of a sample against an 8-bit one
    const std::array<std::uint64_t, 3> under{background.r * scale, background.g * scale,
                                             background.b * scale};
    for (std::size_t i = 0; i < rgbx.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            rgbx[i + c] = std::uint8_t((rgba[i + c] * std::uint64_t(rgba[i + 3]) +
                                        under[c] * (full - rgba[i + 3]) + full * scale / 2) /
                                       (full * scale));
}

/// The row as libjpeg takes it: an opaque one of 8 bits as it is, others flattened in `room`. Both: width x 4
const std::uint8_t* rgbx_row(std::span<const std::uint8_t> rgba, std::span<std::uint8_t> room,
                             Colour background) {
    if (is_opaque(rgba)) return rgba.data();
    flatten(rgba.data(), room, background);
    return room.data();
}

const std::uint8_t* rgbx_row(std::span<const std::uint16_t> rgba, std::span<std::uint8_t> room,
                             Colour background) {
    flatten(rgba.data(), room, background);
    return room.data();
}

}  // namespace

JpegRows::JpegRows(const Image& like, const EncodeOptions& options)
    : encoder_(std::make_unique<Encoder>()), background_(options.background) {
    Encoder& encoder = *encoder_;
    encoder.run([&] {
        jpeg_mem_dest(&encoder.jpeg, &encoder.out, &encoder.out_bytes);
        set_parameters(encoder.jpeg, like, options.quality);
        jpeg_start_compress(&encoder.jpeg, TRUE);
        if (!like.description.icc.empty() && like.description.icc.size() <= max_icc_bytes)
            jpeg_write_icc_profile(&encoder.jpeg,
                                   reinterpret_cast<const JOCTET*>(like.description.icc.data()),
                                   unsigned(like.description.icc.size()));
    });
}

JpegRows::~JpegRows() = default;

void JpegRows::add(const Image& band) {
    const std::size_t row_samples = std::size_t(band.width) * 4;
    std::vector<std::uint8_t> room(row_samples);
    std::visit(
        [&](const auto& rgba) {
            for (int y = 0; y < band.height; ++y) {
                const auto row = std::span(rgba).subspan(std::size_t(y) * row_samples, row_samples);
                auto* rgbx =
                    const_cast<std::uint8_t*>(rgbx_row(row, room, background_));  // libjpeg knows no const
                encoder_->run([&] { jpeg_write_scanlines(&encoder_->jpeg, &rgbx, 1); });
            }
        },
        band.rgba);
}

std::vector<std::byte> JpegRows::finish() {
    encoder_->run([&] { jpeg_finish_compress(&encoder_->jpeg); });
    const auto* first = reinterpret_cast<const std::byte*>(encoder_->out);
    return {first, first + encoder_->out_bytes};
}

std::vector<std::byte> encode_jpeg(const Image& image, const EncodeOptions& options) {
    JpegRows rows(image, options);
    rows.add(image);
    return rows.finish();
}

}  // namespace probewarp
