// Where the time of a render goes, for --timings.
#pragma once

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <string>
#include <string_view>

namespace probewarp {

enum class Stage { decode, weights, draw, encode, write };
inline constexpr std::array<std::string_view, 5> stage_names{"decode", "weights", "draw", "encode", "write"};

/// Seconds of each stage, of all pictures together. Any thread may add.
class Timings {
  public:
    /// Runs `work` and counts it to the stage.
    template <class Work>
    auto measure(Stage stage, const Work& work) {
        const Watch watch{*this, stage};
        return work();
    }

    void add(Stage stage, double seconds) {
        const std::lock_guard lock(mutex_);
        seconds_[std::size_t(stage)] += seconds;
    }

    /// A line for each stage and one for all, which is less where stages overlapped; and the most memory that
    /// was held, where the system tells.
    std::string text() const {
        std::string lines;
        const auto add_line = [&lines](std::string_view name, double seconds) {
            lines += fmt::format("timings: {} {:.3f} s\n", name, seconds);
        };
        for (std::size_t i = 0; i < stage_names.size(); ++i) add_line(stage_names[i], seconds_[i]);
        add_line("in all", seconds_since(start_));
        if (const double mib = peak_memory(); mib > 0)
            lines += fmt::format("timings: memory {:.1f} MiB\n", mib);
        return lines;
    }

  private:
    using Clock = std::chrono::steady_clock;
    static double seconds_since(Clock::time_point start) {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }

    /// MiB; 0 where it is not known.
    static double peak_memory() {
        std::ifstream status("/proc/self/status");
        double kib = 0;
        for (std::string line; std::getline(status, line);)
            if (std::sscanf(line.c_str(), "VmHWM: %lf kB", &kib) == 1) break;
        return kib / 1024;
    }

    struct Watch {
        Timings& timings;
        Stage stage;
        Clock::time_point start = Clock::now();

        ~Watch() { timings.add(stage, seconds_since(start)); }
    };

    Clock::time_point start_ = Clock::now();
    std::mutex mutex_;
    std::array<double, stage_names.size()> seconds_{};
};

}  // namespace probewarp
