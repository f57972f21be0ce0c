// Photoshop files and the profiles in them, put together byte by byte.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "image_files.h"

namespace probewarp::testing {

inline File be_float(float v) { return be(4, std::bit_cast<std::uint32_t>(v)); }

struct PsdSpec {
    int mode = 3;
    int bits = 8;
    int channels = 3;
    int width = 1;
    int height = 1;
    File rows{};  ///< of the merged picture, packed or not
    int compression = 0;
    bool large = false;  ///< PSB
    File palette{};
    File resources{};
    File layers{};  ///< the section's content
};

inline File make_psd(const PsdSpec& spec) {
    const auto number = [](std::size_t bytes, int v) { return be(bytes, std::uint64_t(v)); };
    const auto section = [](std::size_t bytes, const File& content) {
        return join({be(bytes, content.size()), content});
    };
    return join({bytes_of("8BPS"), be(2, spec.large ? 2 : 1), be(6, 0), number(2, spec.channels),
                 number(4, spec.height), number(4, spec.width), number(2, spec.bits), number(2, spec.mode),
                 section(4, spec.palette), section(4, spec.resources),
                 section(spec.large ? 8 : 4, spec.layers), number(2, spec.compression), spec.rows});
}

/// name: any that the resource has
inline File psd_resource(int id, const File& data, std::string_view name = "") {
    const File length = be(1, name.size());
    return join({bytes_of("8BIM"), be(2, std::uint64_t(id)), length, bytes_of(name),
                 File(1 - name.size() % 2), be(4, data.size()), data, File(data.size() % 2)});
}

/// unit: in which Photoshop shows it, 1 or 2
inline File psd_resolution(double x, double y, int unit) {
    const auto fixed = [](double v) { return be(4, std::uint64_t(std::lround(v * 65536))); };
    return psd_resource(1005, join({fixed(x), be(2, std::uint64_t(unit)), be(2, 1), fixed(y),
                                    be(2, std::uint64_t(unit)), be(2, 1)}));
}

/// A layers' section that says how many there are, and nothing else of them.
inline File psd_layer_count(int count, bool large = false) {
    return join({be(large ? 8 : 4, 4), be(2, std::uint16_t(count)), be(2, 0), be(4, 0)});
}

/// The same in a block, as files of 16 and 32 bits have it, behind others.
inline File psd_layer_count_in_block(std::string_view key, int count, bool large) {
    const std::size_t wide = large ? 8 : 4;
    return join({be(wide, 0), be(4, 2), be(2, 7), bytes_of("8BIM"), bytes_of("Patt"), be(4, 5), File(5),
                 File(3), bytes_of("8BIM"), bytes_of("FMsk"), be(wide, 2), be(2, 9),
                 bytes_of(large ? "8B64" : "8BIM"), bytes_of(key), be(wide, 2), be(2, std::uint16_t(count))});
}

// ---- ICC profiles ----

struct IccTag {
    std::string_view name;
    File data;
};

inline File make_icc(std::string_view device, std::string_view colours, std::string_view connection,
                     const std::vector<IccTag>& tags) {
    File table = be(4, tags.size()), data;
    for (const IccTag& tag : tags) {
        table += join(
            {bytes_of(tag.name), be(4, 128 + 4 + 12 * tags.size() + data.size()), be(4, tag.data.size())});
        data += join({tag.data, File((4 - tag.data.size() % 4) % 4)});
    }
    const File head =
        join({be(4, 0), be(4, 0x02400000), bytes_of(device), bytes_of(colours), bytes_of(connection),
              File(12), bytes_of("acsp"), File(28), be(4, 0xF6D6), be(4, 0x10000), be(4, 0xD32D), File(48)});
    return join({be(4, 128 + table.size() + data.size()), head, table, data});
}

/// With the primaries of Adobe RGB (1998) and curves of the given exponent.
inline File wide_rgb_icc(double exponent) {
    const auto xyz = [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return join({bytes_of("XYZ "), be(4, 0), be(4, x), be(4, y), be(4, z)});
    };
    const File curve = join({bytes_of("curv"), be(4, 0), be(4, 1), be(2, std::uint64_t(exponent * 256))});
    return make_icc("mntr", "RGB ", "XYZ ",
                    {{"rXYZ", xyz(0x9C18, 0x4FA5, 0x04FC)},
                     {"gXYZ", xyz(0x348D, 0xA02C, 0x0F95)},
                     {"bXYZ", xyz(0x2631, 0x102F, 0xBE9C)},
                     {"rTRC", curve},
                     {"gTRC", curve},
                     {"bTRC", curve}});
}

inline File grey_icc() {
    return make_icc("mntr", "GRAY", "XYZ ",
                    {{"kTRC", join({bytes_of("curv"), be(4, 0), be(4, 1), be(2, 0x0200)})}});
}

/// Of inks of which none gives white, cyan alone Lab 60, -30, -40, and any with magenta, yellow or black
/// gives black.
inline File cmyk_icc() {
    const auto lab = [](int l, int a, int b) {
        return join({be(2, std::uint64_t(l * 65280 / 100)), be(2, std::uint64_t((a + 128) * 256)),
                     be(2, std::uint64_t((b + 128) * 256))});
    };
    const File straight = bytes({0, 0, 255, 255});
    File lut = join({bytes_of("mft2"), be(4, 0), bytes({4, 3, 2, 0})});
    for (int i = 0; i < 9; ++i) lut += be(4, i % 4 == 0 ? 0x10000 : 0);
    lut += join({be(2, 2), be(2, 2), straight, straight, straight, straight});
    for (int node = 0; node < 16; ++node)  // black varies fastest, cyan slowest
        lut += node == 0 ? lab(100, 0, 0) : node == 8 ? lab(60, -30, -40) : lab(0, 0, 0);
    lut += join({straight, straight, straight});
    return make_icc("prtr", "CMYK", "Lab ", {{"A2B0", lut}});
}

}  // namespace probewarp::testing
