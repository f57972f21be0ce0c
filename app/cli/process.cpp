#include "cli/process.h"

#include <fcntl.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <latch>
#include <thread>
#include <vector>

#include "io/temporary_file.h"

namespace probewarp {

namespace {

void open_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
        // The lowest free number is this one. It is open the wrong way round: what is written is not lost
        // without anybody noticing.
        if (::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
    }
}

/// Whether so many threads can run at once.
bool can_start(std::size_t count) {
    std::latch end(1);
    std::vector<std::jthread> threads;
    bool all = true;
    try {
        threads.reserve(count);
        while (threads.size() < count) threads.emplace_back([&end] { end.wait(); });
    } catch (const std::exception&) {
        all = false;
    }
    end.count_down();
    return all;
}

}  // namespace

void prepare_process() {
    open_standard_streams();
    for (const int number : {SIGPIPE, SIGXFSZ}) std::signal(number, SIG_IGN);
    remove_temporary_files_on_signals();
}

void limit_threads_to_what_starts() {
    if (can_start(std::size_t(tbb::info::default_concurrency() - 1))) return;
    // Never destroyed: lifting the limit would start threads.
    [[maybe_unused]] static auto* const limit =
        new tbb::global_control(tbb::global_control::max_allowed_parallelism, 1);
}

}  // namespace probewarp
