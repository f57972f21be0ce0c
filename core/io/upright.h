// A picture that is stored turned or mirrored, as EXIF's orientation says, put upright. Private to io.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <span>

namespace probewarp {

/// Where the upright picture has what was stored: its top-left pixel, and how far in the upright pixels one
/// step right and one step down go.
struct Walk {
    std::ptrdiff_t start, right, down;

    std::ptrdiff_t at(std::ptrdiff_t x, std::ptrdiff_t y) const { return start + x * right + y * down; }
};

inline bool turned_on_its_side(int orientation) { return orientation >= 5; }

/// orientation: EXIF's, 1 to 8; w, h: as stored
inline Walk upright_walk(int orientation, std::ptrdiff_t w, std::ptrdiff_t h) {
    const std::array<Walk, 8> walks{{{0, 1, w},
                                     {w - 1, -1, w},
                                     {w * h - 1, -1, -w},
                                     {w * (h - 1), 1, -w},
                                     {0, h, 1},
                                     {h - 1, h, -1},
                                     {w * h - 1, -h, -1},
                                     {h * (w - 1), -h, 1}}};
    return walks[std::size_t(orientation - 1)];
}

/// Puts stored rows where they belong in the upright picture. rows: #rows x width pixels, the first of them
/// row `top` of what is stored.
template <std::size_t pixel_bytes>
void put_upright(std::span<const std::byte> rows, std::size_t width, std::size_t top, const Walk& walk,
                 std::span<std::byte> upright) {
    const std::size_t count = rows.size() / (width * pixel_bytes);
    // Column by column: of a picture on its side these are the upright rows.
    for (std::size_t x = 0; x < width; ++x)
        for (std::size_t y = 0; y < count; ++y) {
            const auto to = std::size_t(walk.at(std::ptrdiff_t(x), std::ptrdiff_t(top + y)));
            std::memcpy(&upright[to * pixel_bytes], &rows[(y * width + x) * pixel_bytes], pixel_bytes);
        }
}

}  // namespace probewarp
