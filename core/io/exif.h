// What we want of a file's EXIF: which way is up, the resolution, and what is said of the picture itself,
// such as its date and its author, to be handed on. Private to io.
#pragma once

#include <optional>
#include <vector>

#include "io/bytes.h"
#include "model/image.h"

namespace probewarp {

/// What fits into a JPEG's APP1 marker beside the marker's length and name.
inline constexpr std::size_t max_exif_bytes = 65533 - 6;

/// No more is looked at: a PNG may hold any length.
inline constexpr std::size_t max_exif_source_bytes = std::size_t{1} << 20;

struct Exif {
    int orientation = 1;  ///< 1 to 8
    std::optional<Resolution> resolution;
    /// To be handed on: a TIFF block that is upright and leaves out the thumbnail, the maker's notes, and
    /// what describes how the pixels were stored: sizes, resolution, layout. Empty where nothing else is
    /// said.
    std::vector<std::byte> block;
};

/// tiff: from the byte order on. What cannot be read is as if it were not there.
Exif parse_exif(Bytes tiff);

}  // namespace probewarp
