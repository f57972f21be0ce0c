// Fuzzes the reading of pictures in all formats. The first byte says how: bit 0 names the file as a TGA
// (which has no signature), bit 1 puts a PNG's checksums right, without which hardly any change would get
// past them, bit 2 has the rows decoded beside, and bit 3 opens what is there of a bad file.
#include <zlib.h>

#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "io/image_file.h"

namespace {

/// The CRC of every whole chunk.
void repair_png(std::vector<std::byte>& bytes) {
    const auto big_endian = [&](std::size_t at) {
        std::size_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::size_t>(bytes[at + i]);
        return value;
    };
    for (std::size_t at = 8; at + 12 <= bytes.size();) {
        const std::size_t length = big_endian(at);
        if (length > bytes.size() - at - 12) return;
        const auto* start = reinterpret_cast<const Bytef*>(bytes.data() + at + 4);
        const uLong crc = crc32(0, start, uInt(length + 4));
        for (std::size_t i = 0; i < 4; ++i) bytes[at + 8 + length + i] = std::byte(crc >> (24 - 8 * i) & 255);
        at += 12 + length;
    }
}

/// What every reader promises about a picture that it returns; looks at every byte besides.
void check(const probewarp::Image& image) {
    const std::size_t size =
        std::size_t(image.width) * std::size_t(image.height) * 4 * std::size_t(image.bits() / 8);
    const auto bytes = probewarp::pixel_bytes(image);
    unsigned sum = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) sum += std::to_integer<unsigned>(bytes[i]);
    volatile unsigned keep = sum;
    static_cast<void>(keep);
    if (image.width < 1 || image.height < 1 || bytes.size() != size) std::abort();
}

/// By the reader itself: what decode_picture does besides, writing the picture anew, would take most of the
/// time.
void salvage(const std::vector<std::byte>& bytes) {
    for (const probewarp::ImageFormat& format : probewarp::image_formats())
        if (format.recognise(bytes)) return check(format.decode(bytes, {.salvage = true}));
}

/// A message is a line for a person.
void check(const probewarp::Error& error) {
    for (const char* c = error.what(); *c; ++c)
        if (static_cast<unsigned char>(*c) < 0x20 || *c == 0x7f) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const auto* first = reinterpret_cast<const std::byte*>(data);
    std::vector<std::byte> bytes(first + 1, first + size);
    if (data[0] & 2) repair_png(bytes);
    try {
        if (data[0] & 8) return salvage(bytes), 0;
        const auto pixels = data[0] & 4 ? probewarp::Pixels::arriving : probewarp::Pixels::whole;
        const auto picture =
            probewarp::decode_picture(std::move(bytes), data[0] & 1 ? "fuzz.tga" : "fuzz", pixels);
        probewarp::wait_for_rows(picture, picture.image.height);
        check(picture.image);
        if (picture.original.empty()) std::abort();
    } catch (const probewarp::Error& error) {
        check(error);
    } catch (const std::bad_alloc&) {  // decode_picture says so in words
        if (!(data[0] & 8)) std::abort();
    }
    return 0;
}
