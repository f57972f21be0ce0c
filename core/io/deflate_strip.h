// Deflating a long stream in strips that know nothing of each other, so that many threads may do it. Private
// to io.
#pragma once

#include <vector>

#include "io/bytes.h"

namespace probewarp {

/// How large libdeflate makes `raw` at this level (1 to 12), with nothing else known. Throws std::bad_alloc.
std::vector<std::byte> deflate_whole(Bytes raw, int level);

/// Turns what deflate_whole made into a strip: the strips of a stream one after the other, and a whole one
/// behind them, are one deflate stream (RFC 1951) of all their bytes.
void open_end(std::vector<std::byte>& deflated);

/// A strip, or where `whole` a whole stream, by ISA-L: on photographs as small as deflate_whole at its
/// quickest in less than half the time, on drawings larger. Throws std::bad_alloc.
std::vector<std::byte> deflate_quickly(Bytes raw, bool whole);

/// Likewise by zlib at its best: of what is the same over and over it makes less than libdeflate does.
std::vector<std::byte> deflate_by_zlib(Bytes raw, bool whole);

}  // namespace probewarp
