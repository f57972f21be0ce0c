// A PNG's chunks, looked through before a pixel is decoded: what libspng gets to see of the file, what the
// file says about its colours and itself, and whether it is all there. Private to io.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "io/bytes.h"
#include "io/exif.h"
#include "model/image.h"

namespace probewarp {

/// How a PNG ends.
enum class PngEnd {
    whole,    ///< all of the pixels' chunks are there and sound
    cut,      ///< the file ends within the pixels' data
    damaged,  ///< a chunk of the pixels has a wrong checksum
};

struct PngFile {
    PngFile() = default;
    PngFile(const PngFile&) = delete;  // the parts point into `made`
    PngFile& operator=(const PngFile&) = delete;
    PngFile(PngFile&&) = default;
    PngFile& operator=(PngFile&&) = default;

    /// Signature, IHDR, PLTE, tRNS, IDAT, IEND: sound but for the checksums, which have been looked at.
    std::vector<Bytes> parts;
    std::deque<std::vector<std::byte>> made;  ///< what of the parts does not stand in the file
    std::size_t idat_bytes = 0;
    bool transparent = false;  ///< there is a tRNS
    bool has_end = false;      ///< there is an IEND, whole
    PngEnd end = PngEnd::whole;
    Description description;
    int orientation = 1;  ///< EXIF's, 1 to 8
};

/// Ancillary chunks that are faulty or out of place are left out, and where there are two, the second. The
/// pixels' data go up to the first fault: up to the end of a chunk whose checksum is wrong. Throws Error
/// where there are none of them, or where another critical chunk is faulty.
PngFile survey_png(Bytes file);

}  // namespace probewarp
