#include "io/temporary_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <system_error>

#include "io/descriptor.h"

namespace probewarp {

struct TemporaryEntry {
    enum State : int {
        free,
        changing,  ///< on its way from or to free: whether the file is there is about to be decided
        standing,  ///< the file is there, under a name that is ours
        removed    ///< the signal handler has removed the file, or is about to
    };
    std::atomic<int> state = free;
    int folder = 0;
    char name[NAME_MAX + 1] = {};
};

namespace {

constexpr int ending_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU};
/// So many temporary files of one target have a number in their names, the others a random one.
constexpr int most_numbered_names = 16;
constexpr std::string_view ending = ".probewarp-tmp";

std::atomic<bool> is_ending = false;

/// While it lives, no ending signal is handled on this thread: the handler waits for entries that are being
/// changed, and would wait for ever for the thread that it interrupted.
class EndingSignalsBlocked {
  public:
    EndingSignalsBlocked() {
        sigset_t signals;
        ::sigemptyset(&signals);
        for (const int number : ending_signals) ::sigaddset(&signals, number);
        ::pthread_sigmask(SIG_BLOCK, &signals, &before_);
    }
    EndingSignalsBlocked(const EndingSignalsBlocked&) = delete;
    EndingSignalsBlocked& operator=(const EndingSignalsBlocked&) = delete;
    ~EndingSignalsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

  private:
    sigset_t before_;
};

/// Whether the name in the folder is that of the open file.
bool names(int folder, const char* name, const struct stat& file) {
    struct stat now {};
    return ::fstatat(folder, name, &now, AT_SYMLINK_NOFOLLOW) == 0 && now.st_dev == file.st_dev &&
           now.st_ino == file.st_ino;
}

bool could_be_ours(const struct stat& file) {
    return S_ISREG(file.st_mode) && file.st_nlink == 1 && file.st_uid == ::geteuid();
}

/// Removes the file of that name where it is surely a left-over of ours.
void remove_left_over(int folder, const char* name) {
    struct stat status {};
    if (::fstatat(folder, name, &status, AT_SYMLINK_NOFOLLOW) != 0 || !could_be_ours(status)) return;
    // For writing, since some file systems lock nothing else; nothing is written.
    const Descriptor file(::openat(folder, name, O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (file.fd < 0 || ::flock(file.fd, LOCK_EX | LOCK_NB) != 0) return;
    if (::fstat(file.fd, &status) == 0 && could_be_ours(status) && names(folder, name, status))
        ::unlinkat(folder, name, 0);
}

std::string hexadecimal(std::uint64_t number) {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(number));
    return digits;
}

std::uint64_t random_number() {
    std::uint64_t number = 0;
    if (::getrandom(&number, sizeof number, 0) != ssize_t(sizeof number)) fail_saving(errno);
    return number;
}

/// FNV-1a
std::uint64_t hash_of(const std::string& text) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return hash;
}

/// The target's name, or where the temporary one would grow too long by it its beginning and what tells it
/// from others that begin alike.
std::string stem_of(int folder, const std::string& target) {
    constexpr std::size_t around = 1 + 1 + 16 + ending.size();  // the dots, and the longest number
    constexpr std::size_t hash = 1 + 16;
    const long limit = ::fpathconf(folder, _PC_NAME_MAX);
    const std::size_t longest = limit > 0 ? std::min<std::size_t>(std::size_t(limit), NAME_MAX) : NAME_MAX;
    if (target.size() + around <= longest) return target;
    std::size_t length = longest > around + hash ? longest - around - hash : 0;
    while (length > 0 && (static_cast<unsigned char>(target[length]) & 0xC0u) == 0x80u) --length;  // UTF-8
    return target.substr(0, length) + "~" + hexadecimal(hash_of(target));
}

std::array<TemporaryEntry, 1024> entries;

/// Removes every temporary file. Only calls that a signal handler may make.
void remove_all() {
    is_ending = true;
    for (TemporaryEntry& entry : entries) {
        // What another thread does in the middle of a change takes microseconds; a file system that hangs is
        // not waited for.
        for (int wait = 0; entry.state == TemporaryEntry::changing && wait < 2000; ++wait) {
            const timespec millisecond{0, 1'000'000};
            ::nanosleep(&millisecond, nullptr);
        }
        // Only one of all that could remove it does: once it is gone, the name may be another program's.
        int expected = TemporaryEntry::standing;
        if (entry.state.compare_exchange_strong(expected, TemporaryEntry::removed))
            ::unlinkat(entry.folder, entry.name, 0);
    }
}

void end_by_signal(int number) {
    remove_all();
    struct sigaction usual {};
    usual.sa_handler = SIG_DFL;
    ::sigaction(number, &usual, nullptr);
    ::raise(number);
    sigset_t one;
    ::sigemptyset(&one);
    ::sigaddset(&one, number);
    ::pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
    ::_exit(128 + number);
}

/// An entry for a file that is about to be made.
TemporaryEntry& take_entry() {
    for (TemporaryEntry& entry : entries) {
        int expected = TemporaryEntry::free;
        if (!entry.state.compare_exchange_strong(expected, TemporaryEntry::changing)) continue;
        // Either the handler sees the entry being changed and waits, or it is seen here that it runs.
        if (is_ending) entry.state = TemporaryEntry::free;
        wait_if_ending();
        return entry;
    }
    throw SaveError{"too many files are being written at once"};
}

/// Takes the entry of a file that stands, to remove the file or its name, with the ending signals blocked.
/// False where the signal handler was faster.
bool begin_change(TemporaryEntry& entry) {
    int expected = TemporaryEntry::standing;
    return entry.state.compare_exchange_strong(expected, TemporaryEntry::changing);
}

}  // namespace

void fail_saving(int error) { throw SaveError{std::generic_category().message(error)}; }

void wait_if_ending() {
    while (is_ending) ::pause();
}

void remove_temporary_files_on_signals() {
    struct sigaction action {};
    action.sa_handler = &end_by_signal;
    ::sigemptyset(&action.sa_mask);
    for (const int number : ending_signals) ::sigaddset(&action.sa_mask, number);
    for (const int number : ending_signals) {
        struct sigaction before {};
        const bool ignored = ::sigaction(number, nullptr, &before) == 0 && before.sa_handler == SIG_IGN;
        if (!ignored) ::sigaction(number, &action, nullptr);
    }
    std::atexit(&remove_all);  // a lost display ends the program so, whatever the other threads are at
}

TemporaryFile::TemporaryFile(int folder, const std::string& target, mode_t mode)
    : folder_(folder), target_(target) {
    const std::string stem = "." + stem_of(folder, target) + ".";
    const auto numbered_name = [&](int number) { return stem + std::to_string(number).append(ending); };
    for (int number = 0; number < most_numbered_names; ++number)
        remove_left_over(folder, numbered_name(number).c_str());
    const EndingSignalsBlocked blocked;
    entry_ = &take_entry();
    try {
        for (int number = 0; number < most_numbered_names && fd_ < 0; ++number)
            make(numbered_name(number), mode);
        for (int tries = 0; tries < 100 && fd_ < 0; ++tries)
            make((stem + hexadecimal(random_number())).append(ending), mode);
        if (fd_ < 0) fail_saving(EEXIST);
    } catch (...) {
        entry_->state = TemporaryEntry::free;
        throw;
    }
    entry_->folder = folder;
    std::strcpy(entry_->name, name_.c_str());
    entry_->state = TemporaryEntry::standing;
}

/// Makes and locks the file; leaves fd_ alone where the name is taken.
void TemporaryFile::make(const std::string& name, mode_t mode) {
    name_ = name;
    const int fd =
        ::openat(folder_, name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode);
    if (fd < 0 && errno != EEXIST && errno != EINTR) fail_saving(errno);
    if (fd < 0) return;
    // Before it was locked another program may have taken it for a left-over. Without locks none does.
    struct stat status {};
    const bool taken = ::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (taken || ::fstat(fd, &status) != 0 || !names(folder_, name.c_str(), status)) {
        ::close(fd);
        return;
    }
    fd_ = fd;
}

TemporaryFile::~TemporaryFile() {
    const EndingSignalsBlocked blocked;
    if (entry_ && begin_change(*entry_)) {
        ::unlinkat(folder_, name_.c_str(), 0);
        entry_->state = TemporaryEntry::free;
    }
    ::close(fd_);
}

void TemporaryFile::write(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t put = ::write(fd_, bytes.data(), bytes.size());
        if (put >= 0) bytes = bytes.subspan(std::size_t(put));
        if (put < 0 && errno != EINTR) fail_saving(errno);
    }
}

void TemporaryFile::restart() const {
    if (::ftruncate(fd_, 0) != 0 || ::lseek(fd_, 0, SEEK_SET) != 0) fail_saving(errno);
}

void TemporaryFile::sync() const {
    if (::fsync(fd_) != 0) fail_saving(errno);
    // Some file systems tell what failed only when a descriptor is closed. The file's own keeps the lock.
    const int copy = ::fcntl(fd_, F_DUPFD_CLOEXEC, 0);
    if (copy < 0 || ::close(copy) != 0) fail_saving(errno);
}

void TemporaryFile::rename_to_target() {
    {
        // In one step with the renaming, after which the temporary name may be another program's.
        const EndingSignalsBlocked blocked;
        if (begin_change(*entry_)) {
            const bool renamed = ::renameat(folder_, name_.c_str(), folder_, target_.c_str()) == 0;
            const int error = errno;
            entry_->state = renamed ? TemporaryEntry::free : TemporaryEntry::standing;
            if (!renamed) fail_saving(error);
            entry_ = nullptr;
            return;
        }
    }
    wait_if_ending();
}

}  // namespace probewarp
