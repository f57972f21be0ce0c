// Whether two paths lead to one file, by whatever names, so that a file that is read is never one that is
// written.
#pragma once

#include <sys/types.h>

#include <compare>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace probewarp {

/// What a path leads to when all links are followed, also where nothing stands there yet.
struct FileIdentity {
    dev_t device = 0;
    ino_t inode = 0;    ///< of the file, or else of the deepest folder on its way that there is
    std::string below;  ///< the way on from that folder; empty for a file that is there
    friend auto operator<=>(const FileIdentity&, const FileIdentity&) = default;
};
FileIdentity identity_of(const std::filesystem::path& path);

/// Hard links to one file are the same file too.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Where `path` leads when every symbolic link at its end is followed, also to a file that is not there yet.
/// Empty where they lead round in a circle.
std::optional<std::filesystem::path> follow_links(std::filesystem::path path);

/// A file that is read or written, and the words for it in a message.
struct UsedFile {
    std::string name;  ///< of one that is read: "the input itself"; of one that is written: "-o out.png"
    std::filesystem::path path;
};

/// The sentence on the first file that would be written over one that is read, or twice; empty where none
/// would.
std::string why_not_written(std::span<const UsedFile> read, std::span<const UsedFile> written);

/// The first of `files` that the open descriptor writes to or reads from; null where it is none of them, and
/// where the descriptor is no regular file.
const UsedFile* find_open_file(std::span<const UsedFile> files, int descriptor);

}  // namespace probewarp
