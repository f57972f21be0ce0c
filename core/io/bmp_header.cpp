#include "io/bmp_header.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include "io/colours.h"
#include "io/formats.h"

namespace probewarp {

namespace {

/// The information header, which starts behind the 14 bytes of the file's. Short ones leave fields out.
struct Information {
    Bytes bytes;  // from its first byte to the end of the file
    std::size_t size = 0;

    std::uint32_t field(std::size_t at, std::uint32_t otherwise = 0) const {
        return at + 4 <= size ? le32(bytes, at) : otherwise;
    }
    /// OS/2's second version may end after any field from the depth on, and means other things by some.
    bool is_os2() const { return size != 40 && size != 52 && size != 56 && size <= 64; }
};

Information read_information(Bytes head) {
    if (head.size() < 26) throw truncated("BMP");
    const Information info{head.subspan(14), le32(head, 14)};
    if (info.size != 12 && (info.size < 16 || info.size > 64) && info.size != 108 && info.size != 124)
        throw damaged("BMP", "its header has an unknown length");
    if (info.bytes.size() < info.size) throw truncated("BMP");
    return info;
}

// ---- how the pixels are stored ----

enum class Packing { none, run_length, masks, masks_with_alpha };

Packing read_packing(const Information& info, std::uint32_t bits) {
    const std::uint32_t compression = info.field(16);
    const auto other = [](const char* what) {
        return Error(std::string("holds its pixels as ") + what +
                     "; expected an uncompressed or a run-length encoded BMP file");
    };
    if (compression == 0) return Packing::none;
    if ((compression == 1 && bits == 8) || (compression == 2 && bits == 4)) return Packing::run_length;
    if (info.is_os2() && compression == 3) throw other("Huffman codes");
    if (info.is_os2() && compression == 4) throw other("runs of 24 bits");
    if (compression == 3 && bits >= 16) return Packing::masks;
    if (compression == 4) throw other("a JPEG picture");
    if (compression == 5) throw other("a PNG picture");
    if (compression == 6 && bits >= 16) return Packing::masks_with_alpha;
    if (compression >= 11 && compression <= 13) throw other("CMYK inks");
    throw damaged("BMP", "its compression does not go with " + std::to_string(bits) + " bits a pixel");
}

void read_masks(const Information& info, Packing packing, BmpHeader& header) {
    header.masks = {0xFF0000, 0xFF00, 0xFF, 0};
    if (header.bits == 16) header.masks = {0x7C00, 0x3E0, 0x1F, 0};
    if (packing == Packing::none) return;
    // Either the header is long enough for the masks, or they follow it: in both cases they stand here.
    const std::size_t count = packing == Packing::masks_with_alpha || info.size >= 56 ? 4 : 3;
    if (info.bytes.size() < 40 + 4 * count) throw truncated("BMP");
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t mask = header.masks[i] = le32(info.bytes, 40 + 4 * i);
        const std::uint32_t lowest = mask & (~mask + 1);
        if (((mask + lowest) & mask) != 0) throw damaged("BMP", "the bits of a colour do not stand together");
    }
    if ((header.masks[0] | header.masks[1] | header.masks[2]) == 0)
        throw damaged("BMP", "no bits are given to its colours");
}

/// The bytes between the header and the pixels that the header speaks of: masks and palette. offset_is_given:
/// the file says that the pixels follow the header at once, rather than nothing
std::size_t bytes_between(const Information& info, Packing packing, const BmpHeader& header,
                          bool offset_is_given) {
    std::size_t masks = packing == Packing::masks ? 12 : packing == Packing::masks_with_alpha ? 16 : 0;
    if (info.size > 40) masks = 0;
    // Above 8 bits a palette is only a hint for screens with few colours, and may be counted without being
    // there: where the offset says that nothing stands between, it is not.
    std::size_t colours = header.bits > 8 && offset_is_given ? 0 : info.field(32);
    if (colours == 0 && header.bits <= 8) colours = std::size_t{1} << header.bits;
    return masks + colours * header.palette_entry;
}

/// room: the bytes between the header and the pixels
void read_palette(const Information& info, std::size_t room, BmpHeader& header) {
    std::size_t count = std::size_t{1} << header.bits;
    count = std::min(count, room / header.palette_entry);
    if (info.field(32) > 0) count = std::min<std::size_t>(count, info.field(32));
    if (count == 0) throw damaged("BMP", "it has no palette");
    header.palette = info.bytes.subspan(info.size, count * header.palette_entry);
}

// ---- colours and resolution ----

/// Gamma of a logical colour space: where all three colours have the same, and it can be meant. Some writers
/// give the exponent to linear light, others the one from it, which is below 1.
std::optional<std::uint32_t> read_gamma(const Information& info) {
    const std::uint32_t fixed = info.field(96);
    if (info.field(100) != fixed || info.field(104) != fixed) return {};
    const double exponent = fixed / 65536.0;
    if (exponent < 0.1 || exponent > 10) return {};
    return std::uint32_t(std::lround(100000 * (exponent < 1 ? exponent : 1 / exponent)));
}

/// The endpoints are CIE XYZ of red, green and blue, of which white is the sum. Some writers put
/// chromaticities there, whose parts sum to 1: those say nothing of white, which is taken for D65.
std::optional<Chromaticities> read_endpoints(const Information& info) {
    std::array<std::array<double, 3>, 4> xyz{};  // white, red, green, blue
    bool unscaled = true;
    for (std::size_t colour = 1; colour < 4; ++colour) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double v = info.field(60 + (colour - 1) * 12 + k * 4) / 1073741824.0;  // 2.30
            xyz[colour][k] = v;
            xyz[0][k] += v;
            sum += v;
        }
        unscaled = unscaled && std::abs(sum - 1) < 0.001;
    }
    if (unscaled) xyz[0] = {0.3127, 0.3290, 0.3583};
    Chromaticities found{};
    for (std::size_t i = 0; i < 4; ++i) {
        const double sum = xyz[i][0] + xyz[i][1] + xyz[i][2];
        if (xyz[i][1] < 0.001) return {};
        for (std::size_t k = 0; k < 2; ++k)
            found[i * 2 + k] = std::uint32_t(std::lround(xyz[i][k] / sum * 100000));
    }
    return found;
}

/// ICC's number for the rendering intent, which BMP gives as one of four bits.
std::uint8_t icc_intent(std::uint32_t intent) {
    switch (intent) {
        case 1:
            return 2;  // saturation
        case 2:
            return 1;  // relative colorimetric
        case 8:
            return 3;  // absolute colorimetric
        default:
            return 0;  // perceptual
    }
}

/// A linked profile is another file, which nobody opens for us; Windows' own colour space is sRGB, as is
/// that of a file which says nothing.
void read_colours(const Information& info, Description& description) {
    constexpr std::uint32_t calibrated = 0, srgb = 0x73524742, embedded = 0x4D424544;
    if (info.size < 108) return;
    const std::uint32_t kind = info.field(56);
    if (kind == calibrated) {
        description.gamma = read_gamma(info);
        if (description.gamma) description.chromaticities = read_endpoints(info);
    }
    if (kind == srgb) description.srgb_intent = icc_intent(info.field(108));
    if (kind == embedded) {
        const std::size_t start = info.field(112), size = info.field(116);
        if (start <= info.bytes.size() && size <= info.bytes.size() - start)
            description.icc = rgb_profile(info.bytes.subspan(start, size));
    }
}

void read_description(const Information& info, Description& description) {
    const Resolution resolution{info.field(24), info.field(28)};
    if (is_resolution(resolution.x, resolution.y)) description.resolution = resolution;
    read_colours(info, description);
}

// ---- all together ----

void read_size(const Information& info, BmpHeader& header) {
    std::int64_t height = 0;
    if (info.size == 12) {
        header.width = le16(info.bytes, 4);
        height = le16(info.bytes, 6);
        header.bits = le16(info.bytes, 10);
        header.palette_entry = 3;
    } else {
        header.width = std::int32_t(info.field(4));
        height = std::int32_t(info.field(8));
        header.bits = le16(info.bytes, 14);
    }
    header.top_down = height < 0;
    header.height = std::abs(height);
    check_image_size(header.width, header.height, 8);
}

/// The packing, after a check that it goes with the depth.
Packing read_depth(const Information& info, const BmpHeader& header) {
    // First of all, because what is packed as JPEG or PNG has no depth of its own.
    const Packing packing = read_packing(info, header.bits);
    constexpr std::array<std::uint32_t, 7> depths{1, 2, 4, 8, 16, 24, 32};
    if (header.bits == 64) throw Error("has 64 bits a pixel; expected a BMP file with at most 32");
    if (std::find(depths.begin(), depths.end(), header.bits) == depths.end())
        throw damaged("BMP", "it has " + std::to_string(header.bits) + " bits a pixel");
    return packing;
}

}  // namespace

BmpHeader read_bmp_header(Bytes file) {
    // OS/2 puts one more header of 14 bytes before a choice of bitmaps, of which the first is taken.
    // Offsets count from the start of the file all the same.
    const std::size_t before = begins_with(file, "BA") ? 14 : 0;
    if (file.size() < before) throw truncated("BMP");
    const Bytes head = file.subspan(before);
    const Information info = read_information(head);
    BmpHeader header;
    read_size(info, header);
    const Packing packing = read_depth(info, header);
    header.run_length = packing == Packing::run_length;
    if (header.bits > 8) read_masks(info, packing, header);

    // Some writers leave the offset of the pixels at 0, or forget the palette before them: then they follow
    // what the header speaks of.
    const std::size_t header_end = before + 14 + info.size;
    std::size_t start = le32(head, 10);
    if (start == 0 || start == header_end)
        start = header_end + bytes_between(info, packing, header, start != 0);
    if (start < header_end) throw damaged("BMP", "its pixels start inside its header");
    if (start > file.size()) throw truncated("BMP");
    if (header.bits <= 8) read_palette(info, start - header_end, header);
    header.pixels = file.subspan(start);
    read_description(info, header.description);
    return header;
}

}  // namespace probewarp
