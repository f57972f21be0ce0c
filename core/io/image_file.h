// Image files, in and out: one reader or writer a format, in one ordered table.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/incomplete_file.h"
#include "model/error.h"
#include "model/image.h"
#include "model/probe.h"

namespace probewarp {

/// What a PNG is to be, quickly there or small. The pixels are the same.
enum class Compression { fast, standard, small };

struct CompressionName {
    std::string_view name;   ///< "fast": what --compression calls it
    std::string_view label;  ///< "Fast": what a person reads
    Compression compression;
};

/// From the fastest to the smallest.
std::span<const CompressionName> compressions();

struct EncodeOptions {
    Colour background{255, 255, 255};  ///< under a picture with alpha, where the format has none
    int quality = 95;                  ///< of JPEG, 1 to 100
    Compression compression = Compression::standard;  ///< of PNG
};

struct DecodeOptions {
    /// Opens what is there of a file that ends too soon or is damaged at its end, rather than refusing it.
    bool salvage = false;
};

class RowReader;

struct ImageFormat {
    std::string_view name;   ///< "png": what --format and the project file call it
    std::string_view label;  ///< "PNG": what a person reads
    /// Lower case with the dot, the usual one first; never empty.
    std::span<const std::string_view> extensions;
    /// By the first bytes. For TGA, which has no signature, only whether a TGA header would make sense.
    bool (*recognise)(std::span<const std::byte> bytes);
    /// Throws Error: a clause on what is wrong and what is expected, no file name; IncompleteFile where
    /// salvaging would open it. Grey and palettes become RGBA; 16 bits a sample stay, all else is 8.
    /// docs/formats.md says what is read of each format.
    Image (*decode)(std::span<const std::byte> bytes, const DecodeOptions& options);
    /// decode in portions; null where it decodes all at once. The bytes must outlive it.
    std::unique_ptr<RowReader> (*read_rows)(std::span<const std::byte> bytes, const DecodeOptions& options);
    /// Null where the format is only read. Throws Error. The same image and options give the same bytes. PNG
    /// keeps everything; BMP and TGA round 16 bits to 8, and TGA drops the profile; JPEG has the background
    /// under it besides.
    std::vector<std::byte> (*encode)(const Image& image, const EncodeOptions& options);
};

/// In the order in which they are tried.
std::span<const ImageFormat> image_formats();

/// The format of that name ("png") or null.
const ImageFormat* find_image_format(std::string_view name);

/// The format that the path's ending names, in any case, or null.
const ImageFormat* image_format_of(const std::filesystem::path& path);

/// How much of a picture is there when it is handed over.
enum class Pixels {
    whole,
    arriving,  ///< rows may still be decoded beside, as Picture::arriving says
};

/// Decodes the bytes of an image file, whatever its ending says; `name` is what errors call it, and its
/// ending is asked only for a TGA that is not surely one, since TGA has no signature. Throws Error, or
/// IncompleteFile where salvaging would open it: "NAME: what is wrong; what is expected". What is salvaged is
/// whole when it is handed over, and its original is a PNG made of it, so that a project with it opens again.
Picture decode_picture(std::vector<std::byte> bytes, const std::string& name, Pixels pixels = Pixels::whole,
                       const DecodeOptions& options = {});

/// read_file and decode_picture.
Picture read_picture(const std::filesystem::path& path, Pixels pixels = Pixels::whole,
                     const DecodeOptions& options = {});

/// Throws Error unless width, height and depth (8 or 16) are within max_image_side and max_image_bytes, and
/// within max_decoding_bytes together with the file that decode_picture is at. Readers call it with the
/// header's numbers, before anything is allocated.
void check_image_size(long long width, long long height, int bits);

}  // namespace probewarp
