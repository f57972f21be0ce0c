// Netpbm's PBM, PGM, PPM and PAM (P1 to P7), up to 65535 a sample, and PFM with its floating-point samples.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "io/formats.h"
#include "io/printable.h"

namespace probewarp {

namespace {

/// Where the reader stands in the file.
struct Text {
    Bytes bytes;
    std::size_t at = 0;
    bool in_raster = false;  // past the header: a file that ends here can be salvaged

    std::uint32_t next() {
        if (at >= bytes.size()) {
            if (in_raster) throw incomplete("PNM");
            throw truncated("PNM");
        }
        return u8(bytes, at++);
    }
    std::size_t left() const { return bytes.size() - at; }
};

bool is_space(std::uint32_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_digit(std::uint32_t c) { return c >= '0' && c <= '9'; }

/// The next character, or, of a comment, the line break that ends it.
std::uint32_t next_outside_comments(Text& text) {
    std::uint32_t c = text.next();
    if (c == '#')
        while (c != '\n' && c != '\r') c = text.next();
    return c;
}

std::uint32_t next_mark(Text& text) {
    for (;;)
        if (const std::uint32_t c = next_outside_comments(text); !is_space(c)) return c;
}

/// A decimal number and the white space after it. That has to be there, as for Netpbm itself: without it
/// nobody knows whether a digit is missing.
std::uint32_t number(Text& text) {
    std::uint32_t c = next_mark(text), value = 0;
    if (!is_digit(c)) throw damaged("PNM", "a number is missing");
    for (; is_digit(c); c = next_outside_comments(text)) {
        value = value * 10 + (c - '0');
        if (value > 1'000'000) throw damaged("PNM", "a number is too large");
    }
    if (!is_space(c)) throw damaged("PNM", "a number ends in something else");
    return value;
}

/// The characters up to white space, and the first of that.
std::string word(Text& text) {
    std::string word;
    for (std::uint32_t c = next_mark(text); !is_space(c); c = next_outside_comments(text)) {
        if (word.size() == 64) throw damaged("PNM", "a word of its header is too long");
        word.push_back(char(c));
    }
    return word;
}

struct Header {
    char kind = 0;  // '1' to '7', 'F' and 'f'
    std::size_t width = 0, height = 0;
    std::size_t channels = 1;   // 1 grey, 2 with alpha, 3 RGB, 4 with alpha
    std::size_t planes = 1;     // the samples of a pixel, of which the first are the channels
    std::uint32_t highest = 1;  // the sample that means full intensity
    float scale = 1;            // of PFM; negative: little-endian

    bool is_float() const { return kind == 'F' || kind == 'f'; }
    bool is_raw() const { return kind >= '4'; }
    int bits() const { return is_float() || highest > 255 ? 16 : 8; }
};

// ---- headers ----

/// What PAM's TUPLTYPE means, in channels; 0: something else.
std::size_t tuple_channels(const std::string& type) {
    constexpr std::array<std::pair<std::string_view, std::size_t>, 6> types{{{"BLACKANDWHITE", 1},
                                                                             {"GRAYSCALE", 1},
                                                                             {"BLACKANDWHITE_ALPHA", 2},
                                                                             {"GRAYSCALE_ALPHA", 2},
                                                                             {"RGB", 3},
                                                                             {"RGB_ALPHA", 4}}};
    for (const auto& [name, channels] : types)
        if (name == type) return channels;
    return 0;
}

/// Lines of a word and a value, in any order.
void read_pam_header(Text& text, Header& header) {
    header.planes = 0;
    header.highest = 0;
    std::string type;
    for (std::string field = word(text); field != "ENDHDR"; field = word(text)) {
        if (field == "WIDTH")
            header.width = number(text);
        else if (field == "HEIGHT")
            header.height = number(text);
        else if (field == "DEPTH")
            header.planes = number(text);
        else if (field == "MAXVAL")
            header.highest = number(text);
        else if (field == "TUPLTYPE")
            type = word(text);
        else
            throw damaged("PNM", "its header has the unknown field " + printable(field));
    }
    if (!type.empty() && tuple_channels(type) == 0)
        throw Error("has tuples of the type " + printable(type) +
                    "; expected a PAM file of BLACKANDWHITE, GRAYSCALE or RGB, with or without _ALPHA");
    header.channels = type.empty() ? std::min<std::size_t>(header.planes, 4) : tuple_channels(type);
    if (header.planes < std::max<std::size_t>(header.channels, 1))
        throw damaged("PNM", "its depth does not go with its type");
}

void read_pfm_header(Text& text, Header& header) {
    header.channels = header.planes = header.kind == 'F' ? 3 : 1;
    header.width = number(text);
    header.height = number(text);
    const std::string scale = word(text);
    const char* const first = scale.data() + (scale.front() == '+' ? 1 : 0);
    const char* const last = scale.data() + scale.size();
    const auto [end, error] = std::from_chars(first, last, header.scale);
    if (error != std::errc() || end != last || header.scale == 0 || !std::isfinite(header.scale))
        throw damaged("PNM", "its scale is no number");
}

Header read_header(Text& text) {
    Header header;
    text.at = 1;
    header.kind = char(text.next());
    if (header.is_float()) {
        read_pfm_header(text, header);
    } else if (header.kind == '7') {
        read_pam_header(text, header);
    } else {
        header.width = number(text);
        header.height = number(text);
        if (header.kind == '3' || header.kind == '6') header.channels = header.planes = 3;
        if (header.kind != '1' && header.kind != '4') header.highest = number(text);
    }
    if (header.highest < 1 || header.highest > 65535)
        throw damaged("PNM", "its highest sample is not 1 to 65535");
    text.in_raster = true;
    return header;
}

// ---- pixels ----

/// Refuses a file that is too short for its pixels before memory is spent on them.
void check_length(const Header& header, const Text& text) {
    const std::size_t per_row = header.width * header.planes;
    const std::size_t least = header.kind == '4'                        ? (header.width + 7) / 8
                              : header.kind == '1'                      ? per_row
                              : header.is_float()                       ? per_row * 4
                              : header.is_raw() && header.highest < 256 ? per_row
                                                                        : per_row * 2;
    if (text.left() < least * header.height) throw incomplete("PNM");
}

/// From 0 to 1 times the scale; what lies beyond, or is no number, is cut off.
std::uint32_t float_sample(Text& text, const Header& header, std::uint32_t full) {
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i)
        bits = header.scale < 0 ? bits >> 8 | text.next() << 24 : bits << 8 | text.next();
    const float value = std::bit_cast<float>(bits) * std::abs(header.scale);
    if (!(value > 0)) return 0;
    return value >= 1 ? full : std::uint32_t(std::lround(value * float(full)));
}

/// Sample `x` of a row, scaled to 0 .. `full`; black is 1 in bitmaps.
std::uint32_t sample(Text& text, const Header& header, std::size_t x, std::uint32_t& bits,
                     std::uint32_t full) {
    if (header.is_float()) return float_sample(text, header, full);
    if (header.kind == '4') {
        if (x % 8 == 0) bits = text.next();
        return (bits >> (7 - x % 8) & 1) ? 0 : full;
    }
    if (header.kind == '1') {
        const std::uint32_t c = next_mark(text);
        if (c != '0' && c != '1') throw damaged("PNM", "a bit is neither 0 nor 1");
        return c == '1' ? 0 : full;
    }
    std::uint32_t v = header.is_raw() ? text.next() : number(text);
    if (header.is_raw() && header.highest > 255) v = v << 8 | text.next();
    v = std::min(v, header.highest);  // some writers' samples go beyond it by mistake
    return std::uint32_t((std::uint64_t(v) * full + header.highest / 2) / header.highest);
}

template <class Sample>
void read_pixels(Text& text, const Header& header, std::vector<Sample>& rgba) {
    const std::uint32_t full = std::numeric_limits<Sample>::max();
    const std::size_t colours = header.channels < 3 ? 1 : 3;
    for (std::size_t y = 0; y < header.height; ++y) {
        // PFM alone stores its rows from the bottom up.
        const std::size_t row = header.is_float() ? header.height - 1 - y : y;
        auto out = rgba.begin() + std::ptrdiff_t(row * header.width * 4);
        std::uint32_t bits = 0;
        for (std::size_t x = 0; x < header.width; ++x, out += 4) {
            std::array<std::uint32_t, 4> samples{};
            for (std::size_t c = 0; c < header.channels; ++c)
                samples[c] = sample(text, header, x, bits, full);
            for (std::size_t c = header.channels; c < header.planes; ++c) sample(text, header, x, bits, full);
            for (std::size_t c = 0; c < 3; ++c) out[std::ptrdiff_t(c)] = Sample(samples[c % colours]);
            out[3] = Sample(header.channels > colours ? samples[colours] : full);
        }
    }
}

}  // namespace

Image decode_pnm(Bytes bytes, const DecodeOptions& options) {
    Text text{bytes};
    const Header header = read_header(text);
    check_image_size((long long)(header.width), (long long)(header.height), header.bits());
    if (text.left() == 0) throw truncated("PNM");
    if (!options.salvage) check_length(header, text);
    Image image = blank_image((long long)(header.width), (long long)(header.height), header.bits());
    try {
        std::visit([&](auto& rgba) { read_pixels(text, header, rgba); }, image.rgba);
    } catch (const IncompleteFile&) {
        if (!options.salvage) throw;
        image.incomplete = true;
    }
    return image;
}

}  // namespace probewarp
