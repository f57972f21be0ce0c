// Reading and writing whole files by system calls, because what matters here has no portable words: not to
// wait at a FIFO, to create a file only if there is none of that name, and to know that the bytes reached the
// disk.
#include "io/file.h"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "io/printable.h"

namespace probewarp {

namespace {

namespace fs = std::filesystem;

/// A descriptor that closes itself.
struct Descriptor {
    int fd = -1;

    explicit Descriptor(int number) : fd(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (fd >= 0) ::close(fd);
    }
};

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

/// Thrown between the steps of saving; write_file makes the sentence of it.
struct SaveError {
    std::string why;
};

[[noreturn]] void fail(int error) { throw SaveError{reason(error)}; }

/// Where `path` leads when every symbolic link at its end is followed, also to a file that is not there yet.
fs::path follow_links(fs::path path) {
    for (int hops = 0; hops < 40; ++hops) {  // 40: as many as Linux follows
        std::error_code no_link;
        const fs::path target = fs::read_symlink(path, no_link);
        if (no_link) return path;
        path = target.is_absolute() ? target : path.parent_path() / target;
    }
    fail(ELOOP);
}

/// The folder to write in, as open() wants it.
fs::path folder_of(const fs::path& path) {
    const fs::path folder = path.parent_path();
    return folder.empty() ? fs::path(".") : folder;
}

/// A file beside the target that nobody else has, removed again unless it was renamed to the target.
struct Temporary {
    fs::path path;
    int fd = -1;

    Temporary(const fs::path& target, mode_t mode) {
        // 200 bytes: with the dots and the random part the name stays within the 255 that file systems allow.
        std::string stem(".");
        stem.append(target.filename().native(), 0, 200).append(".");
        for (int tries = 0; tries < 100 && fd < 0; ++tries) {
            path = folder_of(target) / (stem + random_suffix());
            fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode);
            if (fd < 0 && errno != EEXIST && errno != EINTR) fail(errno);
        }
        if (fd < 0) fail(EEXIST);
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    ~Temporary() {
        if (fd >= 0) ::close(fd);
        if (!path.empty()) ::unlink(path.c_str());
    }

    static std::string random_suffix() {
        std::uint64_t number = 0;
        if (::getrandom(&number, sizeof number, 0) != ssize_t(sizeof number)) fail(errno);
        char digits[17];
        std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(number));
        return digits;
    }

    void write(std::span<const std::byte> bytes) const {
        while (!bytes.empty()) {
            const ssize_t put = ::write(fd, bytes.data(), bytes.size());
            if (put >= 0) bytes = bytes.subspan(std::size_t(put));
            if (put < 0 && errno != EINTR) fail(errno);
        }
    }

    void restart() const {
        if (::ftruncate(fd, 0) != 0 || ::lseek(fd, 0, SEEK_SET) != 0) fail(errno);
    }

    /// The bytes reach the disk before the name does: otherwise a crash could leave an empty file in the old
    /// one's place.
    void finish() {
        if (::fsync(fd) != 0) fail(errno);
        const int closing = std::exchange(fd, -1);
        if (::close(closing) != 0) fail(errno);
    }

    void rename_to(const fs::path& target) {
        if (::rename(path.c_str(), target.c_str()) != 0) fail(errno);
        path.clear();
    }
};

/// Owner first, for a change of owner takes permission bits away. Without the right to give a file away we
/// keep our own name on it, as editors do.
void take_over_permissions(int fd, const struct stat& old) {
    struct stat now {};
    if (::fstat(fd, &now) != 0) fail(errno);
    if ((now.st_uid != old.st_uid || now.st_gid != old.st_gid) && ::fchown(fd, old.st_uid, old.st_gid) != 0)
        if (errno != EPERM && errno != EINVAL) fail(errno);
    if (::fchmod(fd, old.st_mode & 07777) != 0) fail(errno);
}

/// Does a step of saving, and says what is the matter with the path where it fails.
template <class Step>
void saving(const fs::path& path, const Step& step) {
    try {
        step();
    } catch (const SaveError& error) {
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
    Temporary temporary;

    explicit Saving(const fs::path& path)
        : target(follow_links(path)),
          replaces(look(target, old)),
          folder(::open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)),
          // Nobody reads in the temporary file what the old one kept from them.
          temporary(target, replaces ? old.st_mode & 0600 : 0666) {
        if (replaces) take_over_permissions(temporary.fd, old);
    }

    /// Whether there is a file to be replaced, and that it may be.
    static bool look(const fs::path& target, struct stat& old) {
        const bool replaces = ::lstat(target.c_str(), &old) == 0;
        if (!replaces && errno != ENOENT) fail(errno);
        if (replaces && !S_ISREG(old.st_mode)) throw SaveError{"it " + kind(old.st_mode)};
        if (!target.has_filename()) throw SaveError{"it names no file"};
        if (replaces && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) fail(errno);
        return replaces;
    }

    void finish() {
        temporary.finish();
        temporary.rename_to(target);
        // The new file stands whole by now, so neither a folder that we may not open nor a file system that
        // cannot sync one is a failure.
        if (folder.fd >= 0) ::fsync(folder.fd);
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
