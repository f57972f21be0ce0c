// A file that is written beside the one it is to replace, and does not outlast the program: not where writing
// fails, and not where a signal ends the program. What only SIGKILL or a crash can leave is known again and
// removed by the next save of the same file.
//
// The name is ".NAME.0.probewarp-tmp", or 1 to 15 where several programs save the same file at once. While it
// is written its file is locked (flock), and the lock goes with the program, however that ends. So a file of
// such a name is a left-over if nobody holds its lock; and only a regular file with one name, which belongs
// to the user who saves, is taken for one. O_TMPFILE would need no name until the end, but no call puts a
// nameless file in the place of one that is there.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <span>
#include <string>

namespace probewarp {

/// Why a step of saving failed: the end of a sentence that names the file.
struct SaveError {
    std::string why;
};

/// Throws SaveError with the system's words for the error number.
[[noreturn]] void fail_saving(int error);

/// Makes the signals that ask a program to end (SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU) remove every
/// temporary file first; the program still ends by the signal. One that is ignored stays so. To be called
/// once, before the first temporary file is made. exit() removes them as well.
void remove_temporary_files_on_signals();

/// Where the program is about to end by a signal, waits for that: a failure that comes of it is not to be
/// told.
void wait_if_ending();

/// What the handler of those signals knows of a temporary file.
struct TemporaryEntry;

class TemporaryFile {
  public:
    /// Makes the file in the folder, which has to stay open, for the target of that name in it. Removes what
    /// an earlier program left of the same target. Everything here throws SaveError.
    TemporaryFile(int folder, const std::string& target, mode_t mode);
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    /// Removes the file unless it was renamed.
    ~TemporaryFile();

    int descriptor() const { return fd_; }
    void write(std::span<const std::byte> bytes) const;
    /// Begins again with nothing written.
    void restart() const;
    /// Brings the bytes to the disk.
    void sync() const;
    /// Puts it in the target's place. Nothing else may be called afterwards.
    void rename_to_target();

  private:
    void make(const std::string& name, mode_t mode);

    TemporaryEntry* entry_;  ///< null once the file is renamed
    int folder_, fd_ = -1;
    std::string target_, name_;
};

}  // namespace probewarp
