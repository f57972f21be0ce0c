// The readers and writers that image_file.cpp's table lists, and the words they share. Private to io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/bytes.h"
#include "io/image_file.h"

namespace probewarp {

// Every decoder throws Error with a clause on what is wrong, no file name. None of them trusts a length, an
// offset or a dimension of the file, and none allocates pixels before check_image_size.
Image decode_png(Bytes bytes, const DecodeOptions& options);
Image decode_jpeg(Bytes bytes, const DecodeOptions& options);
Image decode_bmp(Bytes bytes, const DecodeOptions& options);
Image decode_tga(Bytes bytes, const DecodeOptions& options);
Image decode_gif(Bytes bytes, const DecodeOptions& options);  ///< the first frame on its canvas
Image decode_psd(Bytes bytes, const DecodeOptions& options);  ///< the merged picture
Image decode_pnm(Bytes bytes, const DecodeOptions& options);

std::unique_ptr<RowReader> read_png_rows(Bytes bytes, const DecodeOptions& options);
std::unique_ptr<RowReader> read_jpeg_rows(Bytes bytes, const DecodeOptions& options);

std::vector<std::byte> encode_png(const Image& image, const EncodeOptions& options);
/// 16-bit grey (1 channel) or grey with alpha (2). samples: height x width x channels
std::vector<std::byte> encode_png_samples(int width, int height, int channels,
                                          std::span<const std::uint16_t> samples);
std::vector<std::byte> encode_jpeg(const Image& image, const EncodeOptions& options);
std::vector<std::byte> encode_bmp(const Image& image, const EncodeOptions& options);
std::vector<std::byte> encode_tga(const Image& image, const EncodeOptions& options);

bool looks_like_tga(Bytes bytes);  ///< a header that makes sense; TGA has no signature
/// By the footer of the second version, or because the file ends exactly where its pixels do.
bool is_surely_tga(Bytes bytes);

/// The two ways in which most bad files are bad. `label`: "PNG"; `what`: a short noun phrase, plain ASCII.
inline Error truncated(std::string_view label) {
    return Error("is truncated; expected a whole " + std::string(label) + " file");
}
/// Like truncated(), of a file that salvaging opens.
inline IncompleteFile incomplete(std::string_view label) { return IncompleteFile(truncated(label).what()); }
inline Error damaged(std::string_view label, std::string_view what) {
    return Error("is damaged (" + std::string(what) + "); expected a sound " + std::string(label) + " file");
}

/// Whether these pixels per metre can be meant, and fit into the 31 bits that PNG and BMP have for them.
inline bool is_resolution(double x, double y) {
    return x >= 1 && y >= 1 && x <= 2147483647 && y <= 2147483647;
}

/// 16-bit sample to the nearest 8-bit one.
inline std::uint8_t to_8_bits(std::uint16_t v) { return std::uint8_t((v * 255u + 32767u) / 65535u); }

/// A black, fully transparent picture of that size. `bits`: 8 or 16. Throws Error through check_image_size.
Image blank_image(long long width, long long height, int bits);

inline std::vector<std::uint8_t>& samples_8(Image& image) { return std::get<0>(image.rgba); }

}  // namespace probewarp
