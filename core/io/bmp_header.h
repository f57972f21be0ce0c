// What BMP's headers say, in all their versions from 12 to 124 bytes. Private to io.
#pragma once

#include <array>
#include <cstdint>

#include "io/bytes.h"
#include "model/image.h"

namespace probewarp {

struct BmpHeader {
    std::int64_t width = 0, height = 0;  // pixels, both checked
    bool top_down = false;
    std::uint32_t bits = 0;                // a pixel: 1, 2, 4 or 8 with a palette, 16, 24 or 32 with masks
    bool run_length = false;               // RLE8 or RLE4, as bits says
    std::array<std::uint32_t, 4> masks{};  // red, green, blue, alpha; alpha 0: opaque
    Bytes palette;                         // blue, green, red, and a fourth byte where palette_entry is 4
    std::size_t palette_entry = 4;
    Bytes pixels;  // from the first row's first byte to the end of the file
    Description description;
};

/// Throws Error.
BmpHeader read_bmp_header(Bytes file);

}  // namespace probewarp
