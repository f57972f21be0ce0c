// Deflating a long stream in strips that know nothing of each other, so that many threads may do it. Private
// to io.
#pragma once

#include <vector>

#include "io/bytes.h"

namespace probewarp {

/// How large libdeflate makes `raw` at this level (1 to 12), with nothing else known. Throws std::bad_alloc.
std::vector<std::byte> deflate_whole(Bytes raw, int level);

/// Turns what deflate_whole made of `raw_bytes` bytes into a strip: the strips of a stream one after the
/// other, and a whole one behind them, are one deflate stream (RFC 1951) of all their bytes. Throws
/// std::bad_alloc, and Error where the stream is not sound.
void open_end(std::vector<std::byte>& deflated, std::size_t raw_bytes);

/// A strip, or where `whole` a whole stream, by ISA-L at a level of 1 to 3: on photographs as small as
/// deflate_whole at its quickest in less than half the time, on drawings larger. Throws std::bad_alloc, and
/// Error where ISA-L fails.
std::vector<std::byte> deflate_quickly(Bytes raw, bool whole, int level);

/// A strip, or where `whole` a whole stream, by zlib at its best, which makes less of what is the same over
/// and over than libdeflate does. Throws std::bad_alloc, and Error where zlib fails.
std::vector<std::byte> deflate_by_zlib(Bytes raw, bool whole);

}  // namespace probewarp
