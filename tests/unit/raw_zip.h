// ZIP archives made byte by byte, with lies where a test wants them. The writer under test has no part in it.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace probewarp::testing {

using Bytes = std::vector<std::byte>;

inline Bytes to_bytes(std::string_view text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return {first, first + text.size()};
}

struct RawMember {
    std::string name;
    Bytes bytes;                 ///< as they are in the archive: deflated where method is 8
    unsigned flags = 1u << 11;   ///< the name is UTF-8; bit 0: encrypted
    unsigned method = 0;         ///< 0 stored, 8 deflated
    std::uint32_t size = 0;      ///< said to be this long; 0: as long as `bytes`
    std::uint32_t checksum = 0;  ///< CRC-32; 0: of `bytes`
    /// As Info-ZIP writes into a pipe: checksum and packed size stand behind the member only.
    bool streamed = false;
};

/// A member that inflates to `content`, and says so unless told to lie.
inline RawMember deflated(const std::string& name, const Bytes& content, std::uint32_t size) {
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY);
    Bytes packed(deflateBound(&stream, uLong(content.size())));
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(content.data()));
    stream.avail_in = uInt(content.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(content.data()), uInt(content.size()));
    return {name, packed, 1u << 11, 8, size, std::uint32_t(checksum)};
}

inline void put(Bytes& out, int count, std::uint64_t value) {
    for (int i = 0; i < count; ++i) out.push_back(std::byte(value >> (8 * i) & 255));
}

inline Bytes raw_zip(const std::vector<RawMember>& members) {
    const auto put_text = [](Bytes& out, std::string_view text) {
        for (const char c : text) out.push_back(std::byte(c));
    };
    Bytes archive, directory;
    for (const RawMember& m : members) {
        const std::size_t offset = archive.size();
        const auto crc = m.checksum
                             ? m.checksum
                             : crc32(0, reinterpret_cast<const Bytef*>(m.bytes.data()), uInt(m.bytes.size()));
        const auto put_common = [&](Bytes& out, bool behind) {
            put(out, 2, m.flags | (m.streamed ? 8u : 0u));
            put(out, 2, m.method);
            put(out, 4, 0x00210000);  // midnight, the first of 1980
            put(out, 4, behind ? 0 : crc);
            put(out, 4, behind ? 0 : m.bytes.size());
            put(out, 4, m.size ? m.size : m.bytes.size());
            put(out, 2, m.name.size());
            put(out, 2, 0);  // no extra field
        };
        put(archive, 4, 0x04034b50);
        put(archive, 2, 20);
        put_common(archive, m.streamed);
        put_text(archive, m.name);
        archive.insert(archive.end(), m.bytes.begin(), m.bytes.end());
        if (m.streamed) {
            put(archive, 4, 0x08074b50);
            put(archive, 4, crc);
            put(archive, 4, m.bytes.size());
            put(archive, 4, m.size ? m.size : m.bytes.size());
        }
        put(directory, 4, 0x02014b50);
        put(directory, 4, 20 | 20 << 16);
        put_common(directory, false);
        put(directory, 6, 0);  // no comment, disk 0, no internal attributes
        put(directory, 4, 0);  // no external ones
        put(directory, 4, offset);
        put_text(directory, m.name);
    }
    const std::size_t start = archive.size();
    archive.insert(archive.end(), directory.begin(), directory.end());
    put(archive, 4, 0x06054b50);
    put(archive, 4, 0);
    put(archive, 2, members.size());
    put(archive, 2, members.size());
    put(archive, 4, directory.size());
    put(archive, 4, start);
    put(archive, 2, 0);
    return archive;
}

/// The archive, which has no comment, with a Zip64 end before its own, as archivers write that do not know
/// beforehand how much there will be. members: said to be in it; shift: of where it says that its end is
inline Bytes with_zip64_end(Bytes archive, std::uint64_t members, std::uint64_t shift) {
    const Bytes end(archive.end() - 22, archive.end());
    archive.resize(archive.size() - 22);
    const auto at = [&](std::size_t place) { return std::to_integer<std::uint64_t>(end[place]); };
    const std::size_t here = archive.size(), start = at(16) | at(17) << 8 | at(18) << 16;
    put(archive, 4, 0x06064b50);
    put(archive, 8, 44);  // of what follows
    put(archive, 4, 45 | 45 << 16);
    put(archive, 8, 0);  // disks
    put(archive, 8, members);
    put(archive, 8, members);
    put(archive, 8, here - start);
    put(archive, 8, start);
    put(archive, 4, 0x07064b50);
    put(archive, 4, 0);
    put(archive, 8, here + shift);
    put(archive, 4, 1);
    archive.insert(archive.end(), end.begin(), end.end());
    return archive;
}

}  // namespace probewarp::testing
