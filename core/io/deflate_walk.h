// A walk over a deflate stream that unpacks nothing: to find its blocks. Private to io.
#pragma once

#include <cstddef>

#include "io/bytes.h"

namespace probewarp {

/// A block's place, bits from the stream's begin; in a byte from the lowest on.
struct DeflateBlock {
    std::size_t first = 0;  ///< its first bit, which says whether it is the last one
    std::size_t end = 0;    ///< behind its last bit
};

/// The last block of a whole deflate stream (RFC 1951). Throws Error where the stream is not sound.
DeflateBlock last_block(Bytes stream);

}  // namespace probewarp
