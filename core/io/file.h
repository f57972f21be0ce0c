// Reading and writing whole files: nothing but regular files in, and nothing half-written out.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "model/error.h"

namespace probewarp {

inline constexpr std::size_t max_file_bytes = std::size_t{256} << 20;

/// The bytes of a regular file. Throws Error, naming the file, where it is missing, unreadable, a folder, a
/// FIFO or a device, empty, or longer than `limit`. Never waits: a FIFO without a writer is refused at once.
std::vector<std::byte> read_file(const std::filesystem::path& path, std::size_t limit = max_file_bytes);

/// Puts `bytes` at `path` so that at every moment, come what may, the old file or the new one stands there
/// whole: writes beside it, fsync, rename, fsync the folder. Keeps the permissions of a file it replaces (and
/// its owner, where the system lets us) and writes through symbolic links, also to a file that does not exist
/// yet. A new file gets what the umask leaves of rw-rw-rw-. Throws Error("cannot save PATH: reason"); the old
/// file is then untouched and no other file is left. Refused: a folder, a FIFO, a device, and a file that the
/// caller may not write, although its folder would allow to replace it. Other hard links to the old file keep
/// the old bytes; access control lists and extended attributes are not carried over. A signal that ends the
/// program leaves the old file and nothing beside it as well; what SIGKILL leaves is removed by the next save
/// of the same file (temporary_file.h).
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// A file's bytes, in parts one after the other.
using FileParts = std::vector<std::vector<std::byte>>;

/// write_file in portions: until finish(), nothing is seen of what was written, and nothing is left of it
/// where it never comes to that. Everything throws as write_file does.
class FileWriter {
  public:
    explicit FileWriter(const std::filesystem::path& path);
    ~FileWriter();
    void write(std::span<const std::byte> bytes);
    /// Begins again with nothing written.
    void restart();
    void finish();

  private:
    struct Saving;
    std::filesystem::path path_;
    std::unique_ptr<Saving> saving_;
};

/// Makes the folder, and those it lies in, where they are missing. Throws Error, naming it, where it cannot.
void make_folder(const std::filesystem::path& path);

}  // namespace probewarp
