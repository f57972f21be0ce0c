// Netpbm's PBM, PGM and PPM, plain and raw (P1 to P6), up to 65535 a sample. Our own reader, because
// stb_image knows only P5 and P6 and takes the end of a file for zeros.
#include <limits>

#include "io/formats.h"

namespace probewarp {

namespace {

/// Where the reader stands in the file.
struct Text {
    Bytes bytes;
    std::size_t at = 0;

    std::uint32_t next() {
        if (at >= bytes.size()) throw truncated("PNM");
        return u8(bytes, at++);
    }
    std::size_t left() const { return bytes.size() - at; }
};

bool is_space(std::uint32_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_digit(std::uint32_t c) { return c >= '0' && c <= '9'; }

/// The next character that is neither white space nor in a comment.
std::uint32_t next_mark(Text& text) {
    for (;;) {
        std::uint32_t c = text.next();
        if (c == '#')
            while (c != '\n' && c != '\r') c = text.next();
        else if (!is_space(c))
            return c;
    }
}

/// A decimal number and the one character after it. That character has to be there, as for Netpbm itself:
/// without it nobody knows whether a digit is missing.
std::uint32_t number(Text& text) {
    std::uint32_t c = next_mark(text), value = 0;
    if (!is_digit(c)) throw damaged("PNM", "a number is missing");
    for (; is_digit(c); c = text.next()) {
        value = value * 10 + (c - '0');
        if (value > 1'000'000) throw damaged("PNM", "a number is too large");
    }
    if (c == '#') --text.at;
    return value;
}

struct Header {
    char kind = 0;  // '1' to '6'
    std::size_t width = 0, height = 0, channels = 1;
    std::uint32_t highest = 1;  // the sample that means full intensity
};

Header read_header(Text& text) {
    Header header;
    text.at = 1;
    header.kind = char(text.next());
    header.width = number(text);
    header.height = number(text);
    if (header.kind == '3' || header.kind == '6') header.channels = 3;
    if (header.kind != '1' && header.kind != '4') header.highest = number(text);
    if (header.highest < 1 || header.highest > 65535)
        throw damaged("PNM", "its highest sample is not 1 to 65535");
    return header;
}

/// Refuses a file that is too short for its pixels before memory is spent on them.
void check_length(const Header& header, const Text& text) {
    const std::size_t per_row = header.width * header.channels;
    const std::size_t least = header.kind == '4'                           ? (header.width + 7) / 8
                              : header.kind == '1'                         ? per_row
                              : header.kind >= '5' && header.highest < 256 ? per_row
                                                                           : per_row * 2;
    if (text.left() < least * header.height) throw truncated("PNM");
}

/// Sample `x` of a row, scaled to 0 .. `full`; black is 1 in bitmaps.
std::uint32_t sample(Text& text, const Header& header, std::size_t x, std::uint32_t& bits,
                     std::uint32_t full) {
    if (header.kind == '4') {
        if (x % 8 == 0) bits = text.next();
        return (bits >> (7 - x % 8) & 1) ? 0 : full;
    }
    if (header.kind == '1') {
        const std::uint32_t c = next_mark(text);
        if (c != '0' && c != '1') throw damaged("PNM", "a bit is neither 0 nor 1");
        return c == '1' ? 0 : full;
    }
    std::uint32_t v = header.kind < '4' ? number(text) : text.next();
    if (header.kind > '4' && header.highest > 255) v = v << 8 | text.next();
    if (v > header.highest) throw damaged("PNM", "a sample is above the highest one");
    return std::uint32_t((std::uint64_t(v) * full + header.highest / 2) / header.highest);
}

template <class Sample>
void read_pixels(Text& text, const Header& header, std::vector<Sample>& rgba) {
    const std::uint32_t full = std::numeric_limits<Sample>::max();
    auto out = rgba.begin();
    for (std::size_t y = 0; y < header.height; ++y) {
        std::uint32_t bits = 0;
        for (std::size_t x = 0; x < header.width; ++x, out += 4) {
            out[0] = out[1] = out[2] = Sample(sample(text, header, x, bits, full));
            if (header.channels == 3) {
                out[1] = Sample(sample(text, header, x, bits, full));
                out[2] = Sample(sample(text, header, x, bits, full));
            }
            out[3] = Sample(full);
        }
    }
}

}  // namespace

Image decode_pnm(Bytes bytes, const DecodeOptions&) {
    Text text{bytes};
    const Header header = read_header(text);
    const int bits = header.highest > 255 ? 16 : 8;
    check_image_size((long long)(header.width), (long long)(header.height), bits);
    check_length(header, text);
    Image image = blank_image((long long)(header.width), (long long)(header.height), bits);
    std::visit([&](auto& rgba) { read_pixels(text, header, rgba); }, image.rgba);
    return image;
}

}  // namespace probewarp
