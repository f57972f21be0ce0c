#include "io/jpeg_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <numeric>

#include "io/colours.h"
#include "io/exif.h"
#include "io/formats.h"
#include "io/jpeg_errors.h"

namespace probewarp {

struct JpegRows::Encoder {
    JpegErrors errors;
    jpeg_compress_struct jpeg{};
    unsigned char* out = nullptr;
    unsigned long out_bytes = 0;

    Encoder() {
        set_up(errors, [](j_common_ptr, int) {});
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
        if (errors.trouble == JpegTrouble::memory) throw std::bad_alloc();
        throw Error(std::string("cannot be written as JPEG: ") + errors.message);
    }
};

namespace {

constexpr std::uint32_t most_density = 65535;  // JFIF's 16 bits

/// Dots per inch or per centimetre, whichever gives the pixels per metre back; else inches, the finer of the
/// two. None where neither fits.
void set_density(jpeg_compress_struct& jpeg, const Resolution& resolution) {
    constexpr double inch = 1 / 0.0254, centimetre = 100;  // dots per metre
    const auto dots = [](std::uint32_t per_metre, double unit) { return std::lround(per_metre / unit); };
    const auto fits = [&](std::uint32_t per_metre, double unit) {
        return dots(per_metre, unit) >= 1 && dots(per_metre, unit) <= long(most_density);
    };
    const auto both_fit = [&](double unit) { return fits(resolution.x, unit) && fits(resolution.y, unit); };
    const bool centimetres_exact = resolution.x % 100 == 0 && resolution.y % 100 == 0 && both_fit(centimetre);
    const double unit = !centimetres_exact && both_fit(inch) ? inch : centimetre;
    if (!both_fit(unit)) return;
    jpeg.density_unit = unit == inch ? 1 : 2;
    jpeg.X_density = UINT16(dots(resolution.x, unit));
    jpeg.Y_density = UINT16(dots(resolution.y, unit));
}

/// The ratio in its lowest terms, or the nearest one that fits.
void set_aspect(jpeg_compress_struct& jpeg, const Resolution& aspect) {
    if (aspect.x == 0 || aspect.y == 0) return;
    const std::uint32_t common = std::gcd(aspect.x, aspect.y);
    const double scale = std::max(1.0, double(std::max(aspect.x, aspect.y) / common) / most_density) * common;
    const auto term = [&](std::uint32_t v) { return UINT16(std::max(1L, std::lround(v / scale))); };
    jpeg.density_unit = 0;
    jpeg.X_density = term(aspect.x);
    jpeg.Y_density = term(aspect.y);
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
    if (image.description.resolution)
        set_density(jpeg, *image.description.resolution);
    else if (image.description.aspect)
        set_aspect(jpeg, *image.description.aspect);
}

/// An APP1 marker, which stands right behind JFIF's.
std::vector<std::byte> exif_marker(Bytes block) {
    if (block.empty() || block.size() > max_exif_bytes) return {};
    std::vector<std::byte> data;
    for (const char c : {'E', 'x', 'i', 'f', '\0', '\0'}) data.push_back(std::byte(c));
    data.insert(data.end(), block.begin(), block.end());
    return data;
}

const JOCTET* octets(Bytes bytes) { return reinterpret_cast<const JOCTET*>(bytes.data()); }

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
    const std::vector<std::byte> icc = profile_of(like.description),
                                 exif = exif_marker(like.description.exif);
    encoder.run([&] {
        jpeg_mem_dest(&encoder.jpeg, &encoder.out, &encoder.out_bytes);
        set_parameters(encoder.jpeg, like, options.quality);
        jpeg_start_compress(&encoder.jpeg, TRUE);
        if (!exif.empty())
            jpeg_write_marker(&encoder.jpeg, JPEG_APP0 + 1, octets(exif), unsigned(exif.size()));
        if (!icc.empty() && icc.size() <= max_icc_bytes)
            jpeg_write_icc_profile(&encoder.jpeg, octets(icc), unsigned(icc.size()));
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
