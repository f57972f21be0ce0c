// PSD's merged picture, by hand: stb_image's 16-bit run lengths are wrong, and its removal of a white matte
// overflows.
#include <algorithm>
#include <array>
#include <limits>

#include "io/formats.h"

namespace probewarp {

// By hand, because stb_image reads 16-bit run-length encoded files wrongly and computes beyond what its
// numbers can hold where colours and alpha contradict each other.

namespace {

struct Psd {
    std::size_t channels = 0, width = 0, height = 0;
    std::size_t sample_bytes = 1;
    std::size_t colours = 3;  // 1: grey
    bool packed = false;      // each row by PackBits
    Bytes lengths;            // of the packed rows: channels x height, 16-bit big-endian each
    Bytes data;               // rows, channel by channel

    std::size_t row_bytes() const { return width * sample_bytes; }
};

/// Past the three sections before the merged picture, to the two bytes that say how it is packed.
std::size_t skip_psd_sections(Bytes bytes) {
    std::size_t at = 26;
    for (int section = 0; section < 3; ++section) {
        if (bytes.size() - at < 4) throw truncated("PSD");
        const std::size_t length = be32(bytes, at);
        if (length > bytes.size() - at - 4) throw truncated("PSD");
        at += 4 + length;
    }
    if (bytes.size() - at < 2) throw truncated("PSD");
    return at;
}

Psd read_psd_header(Bytes bytes) {
    if (bytes.size() < 26) throw truncated("PSD");
    if (be16(bytes, 4) != 1) throw Error("is a PSD of a version that cannot be read; expected version 1");
    Psd psd;
    psd.channels = be16(bytes, 12);
    psd.height = be32(bytes, 14);
    psd.width = be32(bytes, 18);
    const std::uint32_t bits = be16(bytes, 22), mode = be16(bytes, 24);
    if (bits != 8 && bits != 16)
        throw Error("has " + std::to_string(bits) + " bits a channel; expected a PSD with 8 or 16");
    if (mode != 1 && mode != 3) throw Error("is neither RGB nor grey; expected a PSD in one of these modes");
    check_image_size((long long)(psd.width), (long long)(psd.height), int(bits));
    psd.sample_bytes = bits / 8;
    psd.colours = mode == 1 ? 1 : 3;
    if (psd.channels < psd.colours || psd.channels > 56)
        throw damaged("PSD", "it has too few or too many channels");
    return psd;
}

/// Where the rows are, after a check that all of them are there.
void find_psd_rows(Psd& psd, Bytes bytes) {
    const std::size_t at = skip_psd_sections(bytes), rows = psd.channels * psd.height;
    const std::uint32_t compression = be16(bytes, at);
    if (compression > 1)
        throw Error("is packed in an unusual way; expected a PSD whose merged picture is RLE or raw");
    psd.packed = compression == 1;
    psd.data = bytes.subspan(at + 2);
    std::size_t needed = rows * psd.row_bytes();
    if (psd.packed) {
        if (psd.data.size() < rows * 2) throw truncated("PSD");
        psd.lengths = psd.data.first(rows * 2);
        psd.data = psd.data.subspan(rows * 2);
        needed = 0;
        for (std::size_t row = 0; row < rows; ++row) needed += be16(psd.lengths, row * 2);
    }
    if (psd.data.size() < needed) throw truncated("PSD");
}

/// PackBits: 0 to 127: that many bytes and one more follow; 129 to 255: the next byte 257 minus that many
/// times.
void unpack_bits(Bytes from, std::span<std::byte> to) {
    while (!to.empty()) {
        if (from.size() < 2) throw damaged("PSD", "a row is too short");
        const std::size_t code = u8(from, 0);
        if (code == 128) {
            from = from.subspan(1);
            continue;
        }
        const std::size_t count = code < 128 ? code + 1 : 257 - code, stored = code < 128 ? count : 1;
        if (count > to.size() || stored > from.size() - 1) throw damaged("PSD", "a row has the wrong length");
        for (std::size_t i = 0; i < count; ++i) to[i] = from[stored == 1 ? 1 : 1 + i];
        from = from.subspan(1 + stored);
        to = to.subspan(count);
    }
}

/// One channel into the samples from `out` on, four apart.
template <class Sample>
void read_psd_channel(Psd& psd, std::size_t channel, Sample* out) {
    std::vector<std::byte> row(psd.row_bytes());
    for (std::size_t y = 0; y < psd.height; ++y) {
        const std::size_t stored =
            psd.packed ? be16(psd.lengths, (channel * psd.height + y) * 2) : row.size();
        if (psd.packed)
            unpack_bits(psd.data.first(stored), row);
        else
            std::copy_n(psd.data.begin(), stored, row.begin());
        psd.data = psd.data.subspan(stored);
        for (std::size_t x = 0; x < psd.width; ++x, out += 4)
            *out = Sample(sizeof(Sample) == 2 ? be16(row, x * 2) : u8(row, x));
    }
}

/// Whether the colours can have been merged onto white, as Photoshop does with what is partly transparent:
/// then none is darker than its alpha lets white shine through. Other programs write them unmixed, and
/// nothing in the file says so.
template <class Sample>
bool on_white(const std::vector<Sample>& rgba) {
    constexpr int full = std::numeric_limits<Sample>::max(), rounding = full / 128;
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3 && rgba[i - i % 4 + 3] != 0 && rgba[i] + rgba[i - i % 4 + 3] < full - rounding)
            return false;
    return true;
}

/// Takes the white out again.
template <class Sample>
void remove_white(std::vector<Sample>& rgba) {
    constexpr std::int64_t full = std::numeric_limits<Sample>::max();
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        const std::int64_t alpha = rgba[i + 3];
        if (alpha == 0 || alpha == full) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::int64_t above = std::max<std::int64_t>(rgba[i + c] - (full - alpha), 0);
            rgba[i + c] = Sample((above * full + alpha / 2) / alpha);
        }
    }
}

template <class Sample>
void read_psd_pixels(Psd& psd, std::vector<Sample>& rgba) {
    for (std::size_t c = 0; c < psd.colours; ++c) read_psd_channel(psd, c, rgba.data() + c);
    for (std::size_t i = 0; psd.colours == 1 && i < rgba.size(); i += 4) rgba[i + 1] = rgba[i + 2] = rgba[i];
    if (psd.channels > psd.colours) {
        read_psd_channel(psd, psd.colours, rgba.data() + 3);
        if (on_white(rgba)) remove_white(rgba);
    } else {
        for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = std::numeric_limits<Sample>::max();
    }
}

}  // namespace

Image decode_psd(Bytes bytes, const DecodeOptions&) {
    Psd psd = read_psd_header(bytes);
    find_psd_rows(psd, bytes);
    Image image = blank_image((long long)(psd.width), (long long)(psd.height), int(psd.sample_bytes * 8));
    std::visit([&](auto& rgba) { read_psd_pixels(psd, rgba); }, image.rgba);
    return image;
}

}  // namespace probewarp
