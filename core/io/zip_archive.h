// ZIP archives as lists of members in memory, read with suspicion and written the same every time.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "model/error.h"

namespace probewarp {

struct ZipMember {
    std::string name;
    std::vector<std::byte> bytes;
    bool stored = false;  ///< written without compression
};

inline constexpr std::size_t max_zip_members = 4096;

/// Whether the bytes begin as a ZIP archive with a member does.
bool is_zip(std::span<const std::byte> bytes);

/// Clears the size that some archivers put before a member whose sizes stand behind it, where checksum and
/// packed size are left out: libzip takes it for a contradiction. Changes nothing else.
void settle_streamed_members(std::span<std::byte> archive);

/// The names that read_zip gives, whatever the members hold. Throws Error (a clause, no file name) where the
/// archive is damaged or truncated or has more than max_zip_members members.
std::vector<std::string> zip_names(std::span<const std::byte> bytes);

/// All members in the archive's order, without folders and without what desktops put into archives:
/// "__MACOSX/", ".DS_Store", "Thumbs.db". Names have slashes and no "./" before them, whatever the archiver
/// wrote. Throws Error (a clause, no file name) where the archive is damaged or truncated, where a name
/// stands twice or points out of the archive, where a member is encrypted or packed by anything but deflate,
/// or where the members are more than max_zip_members or larger than `limit` bytes together.
std::vector<ZipMember> read_zip(std::span<const std::byte> bytes, std::size_t limit);

/// The archive of `members` in their order. The same members give the same bytes: the times in it are fixed.
std::vector<std::byte> write_zip(std::span<const ZipMember> members);

}  // namespace probewarp
