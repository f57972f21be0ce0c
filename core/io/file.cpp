// Reading and writing whole files by system calls, because what matters here has no portable words: not to
// wait at a FIFO, to create a file only if there is none of that name, and to know that the bytes reached the
// disk.
#include "io/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <string>
#include <system_error>
#include <utility>

#include "io/descriptor.h"
#include "io/printable.h"
#include "io/same_file.h"
#include "io/temporary_file.h"

namespace probewarp {

namespace {

namespace fs = std::filesystem;

std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void refuse(const fs::path& path, const std::string& what) {
    throw Error(printable(path.native()) + ": " + what);
}

/// What a file that is not a regular one is, in words.
std::string kind(mode_t mode) {
    if (S_ISDIR(mode)) return "is a folder";
    if (S_ISFIFO(mode)) return "is a pipe (FIFO)";
    if (S_ISSOCK(mode)) return "is a socket";
    if (S_ISCHR(mode) || S_ISBLK(mode)) return "is a device";
    return "is not a regular file";
}

void check_readable(const fs::path& path, const struct stat& status, std::size_t limit) {
    if (!S_ISREG(status.st_mode)) refuse(path, kind(status.st_mode) + "; expected a file");
    if (std::uintmax_t(status.st_size) > limit)
        refuse(path, "is " + std::to_string(status.st_size) + " bytes long; expected at most " +
                         std::to_string(limit));
}

/// Reads until `bytes` is full or the file ends; returns how many bytes came.
std::size_t read_all(int fd, std::span<std::byte> bytes, const fs::path& path) {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t got = ::read(fd, bytes.data() + done, bytes.size() - done);
        if (got == 0) break;
        if (got > 0) done += std::size_t(got);
        if (got < 0 && errno != EINTR) refuse(path, "cannot be read: " + reason(errno));
    }
    return done;
}

// ---- writing ----

/// The folder to write in, as open() wants it.
fs::path folder_of(const fs::path& path) {
    const fs::path folder = path.parent_path();
    return folder.empty() ? fs::path(".") : folder;
}

/// Owner first, for a change of owner takes permission bits away. Without the right to give a file away we
/// keep our own name on it, as editors do.
void take_over_permissions(int fd, const struct stat& old) {
    struct stat now {};
    if (::fstat(fd, &now) != 0) fail_saving(errno);
    if ((now.st_uid != old.st_uid || now.st_gid != old.st_gid) && ::fchown(fd, old.st_uid, old.st_gid) != 0)
        if (errno != EPERM && errno != EINVAL) fail_saving(errno);
    if (::fchmod(fd, old.st_mode & 07777) != 0) fail_saving(errno);
}

/// Does a step of saving, and says what is the matter with the path where it fails.
template <class Step>
void saving(const fs::path& path, const Step& step) {
    try {
        step();
    } catch (const SaveError& error) {
        wait_if_ending();
        throw Error("cannot save " + printable(path.native()) + ": " + error.why);
    }
}

}  // namespace

/// A save under way: what was found at the path, and the file beside it.
struct FileWriter::Saving {
    fs::path target;
    struct stat old {};
    bool replaces;
    Descriptor folder;
    TemporaryFile temporary;

    explicit Saving(const fs::path& path)
        : target(end_of_links(path)),
          replaces(look(target, old)),
          folder(open_folder(target)),
          // Nobody reads in the temporary file what the old one kept from them.
          temporary(folder.fd, target.filename(), replaces ? 0600 : 0666) {}

    static fs::path end_of_links(const fs::path& path) {
        auto end = follow_links(path);
        if (!end) fail_saving(ELOOP);
        return std::move(*end);
    }

    /// Held while the file is written, so that the target stays the same whoever moves the folder. O_PATH
    /// needs no permission to list it.
    static int open_folder(const fs::path& target) {
        const int fd = ::open(folder_of(target).c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
        if (fd < 0) fail_saving(errno);
        return fd;
    }

    /// Whether there is a file to be replaced, and that it may be.
    static bool look(const fs::path& target, struct stat& old) {
        const bool replaces = ::lstat(target.c_str(), &old) == 0;
        if (!replaces && errno != ENOENT) fail_saving(errno);
        if (replaces && !S_ISREG(old.st_mode)) throw SaveError{"it " + kind(old.st_mode)};
        if (!target.has_filename()) throw SaveError{"it names no file"};
        if (replaces && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) fail_saving(errno);
        return replaces;
    }

    /// The bytes reach the disk before the name does: otherwise a crash could leave an empty file in the old
    /// one's place.
    void finish() {
        if (replaces) take_over_permissions(temporary.descriptor(), old);
        temporary.sync();
        temporary.rename_to_target();
        // The new file stands whole by now, so neither a folder that we may not open nor a file system that
        // cannot sync one is a failure.
        const Descriptor listed(::openat(folder.fd, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
        if (listed.fd >= 0) ::fsync(listed.fd);
    }
};

FileWriter::FileWriter(const fs::path& path) : path_(path) {
    saving(path_, [&] { saving_ = std::make_unique<Saving>(path); });
}

FileWriter::~FileWriter() = default;

void FileWriter::write(std::span<const std::byte> bytes) {
    saving(path_, [&] { saving_->temporary.write(bytes); });
}

void FileWriter::restart() {
    saving(path_, [&] { saving_->temporary.restart(); });
}

void FileWriter::finish() {
    saving(path_, [&] { saving_->finish(); });
}

std::vector<std::byte> read_file(const fs::path& path, std::size_t limit) {
    // Asked before it is opened, since opening is enough to set some devices going; asked again once it is
    // open, since another file may have come into its place.
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) refuse(path, "cannot be opened: " + reason(errno));
    check_readable(path, status, limit);
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (file.fd < 0) refuse(path, "cannot be opened: " + reason(errno));
    if (::fstat(file.fd, &status) != 0) refuse(path, "cannot be opened: " + reason(errno));
    check_readable(path, status, limit);

    std::vector<std::byte> bytes(std::size_t(status.st_size));
    bytes.resize(read_all(file.fd, bytes, path));
    if (bytes.empty()) refuse(path, "is empty; expected a file with something in it");
    return bytes;
}

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
    FileWriter writer(path);
    writer.write(bytes);
    writer.finish();
}

void make_folder(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (!fs::is_directory(path))
        refuse(path,
               "this folder cannot be made: " + (error ? error.message() : "something else has its name"));
}

std::string printable(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = [&](std::size_t k) {
            return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0u;
        };
        const auto follows = [&](std::size_t k) { return (byte(k) & 0xC0u) == 0x80u; };
        const unsigned b = byte(0), second = byte(1);
        std::size_t length = 0;  // of the sequence that starts here; 0: not UTF-8, or a control character
        if (b >= 0x20 && b < 0x7F)
            length = 1;
        else if (b >= 0xC2 && b < 0xE0 && follows(1) && !(b == 0xC2 && second < 0xA0))
            length = 2;
        else if (b >= 0xE0 && b < 0xF0 && follows(1) && follows(2) && !(b == 0xE0 && second < 0xA0) &&
                 !(b == 0xED && second >= 0xA0))
            length = 3;
        else if (b >= 0xF0 && b < 0xF5 && follows(1) && follows(2) && follows(3) &&
                 !(b == 0xF0 && second < 0x90) && !(b == 0xF4 && second >= 0x90))
            length = 4;
        out += length == 0 ? std::string_view("?") : text.substr(i, length);
        i += length == 0 ? 1 : length;
    }
    return out;
}

}  // namespace probewarp
