// Which picture formats there are, and the way from a file's bytes to a Picture: the signature decides,
// because endings lie; only for a TGA without its footer, which has none, does the ending count.
#include "io/image_file.h"

#include <algorithm>
#include <array>

#include "io/file.h"
#include "io/formats.h"
#include "io/lower_case.h"
#include "io/naming_errors.h"
#include "io/printable.h"
#include "io/row_reader.h"
#include "io/unread_formats.h"

namespace probewarp {

namespace {

using std::string_view;

constexpr std::array png_endings{string_view(".png")};
constexpr std::array jpeg_endings{string_view(".jpg"), string_view(".jpeg"), string_view(".jpe"),
                                  string_view(".jfif")};
constexpr std::array bmp_endings{string_view(".bmp"), string_view(".dib")};
constexpr std::array gif_endings{string_view(".gif")};
constexpr std::array psd_endings{string_view(".psd"), string_view(".psb")};
constexpr std::array pnm_endings{string_view(".ppm"), string_view(".pgm"), string_view(".pbm"),
                                 string_view(".pnm"), string_view(".pam"), string_view(".pfm")};
constexpr std::array tga_endings{string_view(".tga"), string_view(".vda"), string_view(".icb"),
                                 string_view(".vst")};

bool is_png(Bytes bytes) { return begins_with(bytes, "\x89PNG\r\n\x1a\n"); }
bool is_jpeg(Bytes bytes) { return begins_with(bytes, "\xff\xd8\xff"); }
bool is_bmp(Bytes bytes) {
    const bool of_os2 = begins_with(bytes, "BA") && bytes.size() >= 16;  // an array of bitmaps
    return begins_with(bytes, "BM") || (of_os2 && begins_with(bytes.subspan(14), "BM"));
}
bool is_gif(Bytes bytes) { return begins_with(bytes, "GIF87a") || begins_with(bytes, "GIF89a"); }
bool is_psd(Bytes bytes) { return begins_with(bytes, "8BPS"); }
bool is_pnm(Bytes bytes) {
    if (bytes.size() < 3 || u8(bytes, 0) != 'P') return false;
    return string_view("1234567Ff").find(char(u8(bytes, 1))) != string_view::npos &&
           string_view(" \t\r\n\v\f#").find(char(u8(bytes, 2))) != string_view::npos;
}

// TGA stands last: it has no signature, so it is tried only for a file that nothing else claims. Where the
// file's name does not say so, the whole of it has to be a TGA's.
constexpr std::array<ImageFormat, 7> formats{{
    {"png", "PNG", png_endings, is_png, decode_png, read_png_rows, encode_png},
    {"jpeg", "JPEG", jpeg_endings, is_jpeg, decode_jpeg, read_jpeg_rows, encode_jpeg},
    {"bmp", "BMP", bmp_endings, is_bmp, decode_bmp, nullptr, encode_bmp},
    {"gif", "GIF", gif_endings, is_gif, decode_gif, nullptr, nullptr},
    {"psd", "PSD", psd_endings, is_psd, decode_psd, nullptr, nullptr},
    {"pnm", "PNM", pnm_endings, is_pnm, decode_pnm, nullptr, nullptr},
    {"tga", "TGA", tga_endings, looks_like_tga, decode_tga, nullptr, encode_tga},
}};

constexpr std::array<CompressionName, 3> compression_names{{{"fast", "Fast", Compression::fast},
                                                            {"default", "Default", Compression::standard},
                                                            {"small", "Small", Compression::small}}};

const ImageFormat* recognised_format(Bytes bytes, const std::string& name) {
    const auto fits = [&](const ImageFormat& format) {
        if (format.name != "tga") return format.recognise(bytes);
        return image_format_of(name) == &format ? format.recognise(bytes) : is_surely_tga(bytes);
    };
    const auto found = std::find_if(formats.begin(), formats.end(), fits);
    return found == formats.end() ? nullptr : &*found;
}

std::string name_without_folder(const std::string& name) {
    const std::string file = std::filesystem::path(name).filename().string();
    return file.empty() ? name : file;
}

}  // namespace

std::span<const ImageFormat> image_formats() { return formats; }

std::span<const CompressionName> compressions() { return compression_names; }

const ImageFormat* find_image_format(string_view name) {
    const auto found =
        std::find_if(formats.begin(), formats.end(), [&](const auto& f) { return f.name == name; });
    return found == formats.end() ? nullptr : &*found;
}

const ImageFormat* image_format_of(const std::filesystem::path& path) {
    const std::string ending = lower_ending(path);
    for (const ImageFormat& format : formats)
        if (std::find(format.extensions.begin(), format.extensions.end(), ending) != format.extensions.end())
            return &format;
    return nullptr;
}

namespace {

/// The bytes of the file that this thread decodes: they and the pixels are there at once.
thread_local std::size_t source_bytes = 0;

struct SourceBytes {
    explicit SourceBytes(std::size_t bytes) { source_bytes = bytes; }
    ~SourceBytes() { source_bytes = 0; }
    SourceBytes(const SourceBytes&) = delete;
    SourceBytes& operator=(const SourceBytes&) = delete;
};

}  // namespace

namespace {

/// What was salvaged becomes a sound file, since a project keeps the original and opens only sound ones.
void keep_as_png(Picture& picture) {
    picture.original = encode_png(picture.image, {});
    picture.format = "png";
}

}  // namespace

Picture decode_picture(std::vector<std::byte> bytes, const std::string& name, Pixels pixels,
                       const DecodeOptions& options) {
    const SourceBytes counted(bytes.size());
    const std::string called = printable(name);
    const ImageFormat* format = recognised_format(bytes, name);
    if (!format)
        throw Error(called + ": " +
                    unread_format(bytes).value_or("is not a picture that can be read; expected " +
                                                  std::string(readable_formats)));
    Picture picture{{}, name_without_folder(name), std::string(format->name), std::move(bytes), nullptr};
    naming_errors(name, [&] {
        if (pixels == Pixels::whole || !format->read_rows || options.salvage) {
            picture.image = format->decode(picture.original, options);
            if (picture.image.incomplete) keep_as_png(picture);
            return;
        }
        auto reader = format->read_rows(picture.original, options);
        picture.image = reader->blank();
        if (picture.image.opaque)
            picture.arriving = read_beside(std::move(reader), picture.image, name);
        else
            read_all(*reader, picture.image);
    });
    return picture;
}

Picture read_picture(const std::filesystem::path& path, Pixels pixels, const DecodeOptions& options) {
    return decode_picture(read_file(path), path.string(), pixels, options);
}

void check_image_size(long long width, long long height, int bits) {
    const long long sample_bytes = bits / 8;
    const bool sides = width >= 1 && height >= 1 && width <= max_image_side && height <= max_image_side;
    const std::size_t needed = sides ? std::size_t(width * height * 4 * sample_bytes) : 0;
    if (sides && needed <= max_image_bytes) {
        if (needed + source_bytes <= max_decoding_bytes) return;
        throw Error("needs " + std::to_string((needed + source_bytes) >> 20) +
                    " MiB, the file and its pixels; expected at most " +
                    std::to_string(max_decoding_bytes >> 20));
    }
    throw Error("is " + std::to_string(width) + " x " + std::to_string(height) + " pixels; expected 1 to " +
                std::to_string(max_image_side) + " pixels a side and at most " +
                std::to_string(max_image_bytes / 4 / std::size_t(sample_bytes) / 1000000) +
                " million pixels");
}

Image blank_image(long long width, long long height, int bits) {
    check_image_size(width, height, bits);
    Image image;
    image.width = int(width);
    image.height = int(height);
    const std::size_t samples = std::size_t(width) * std::size_t(height) * 4;
    if (bits == 16)
        image.rgba = std::vector<std::uint16_t>(samples);
    else
        image.rgba = std::vector<std::uint8_t>(samples);
    return image;
}

}  // namespace probewarp
