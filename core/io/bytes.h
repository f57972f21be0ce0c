// Numbers out of a file's bytes and into them, for readers and writers that see to headers themselves.
// Private to io.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace probewarp {

using Bytes = std::span<const std::byte>;

/// All four: `at` and what follows lie inside; the caller has compared with bytes.size().
inline std::uint32_t u8(Bytes bytes, std::size_t at) {
    assert(at < bytes.size());
    return std::to_integer<std::uint32_t>(bytes[at]);
}
inline std::uint32_t le16(Bytes bytes, std::size_t at) { return u8(bytes, at) | u8(bytes, at + 1) << 8; }
inline std::uint32_t le32(Bytes bytes, std::size_t at) { return le16(bytes, at) | le16(bytes, at + 2) << 16; }
inline std::uint32_t be16(Bytes bytes, std::size_t at) { return u8(bytes, at) << 8 | u8(bytes, at + 1); }
inline std::uint32_t be32(Bytes bytes, std::size_t at) { return be16(bytes, at) << 16 | be16(bytes, at + 2); }

/// The low 32 bits of the value.
inline void put_be32(std::vector<std::byte>& to, std::size_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) to.push_back(std::byte(value >> shift & 0xFF));
}

/// Whether `bytes` begins with the characters of `signature`.
template <std::size_t size>
bool begins_with(Bytes bytes, const char (&signature)[size]) {
    if (bytes.size() < size - 1) return false;
    for (std::size_t i = 0; i + 1 < size; ++i)
        if (u8(bytes, i) != static_cast<unsigned char>(signature[i])) return false;
    return true;
}

}  // namespace probewarp
