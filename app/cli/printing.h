// The one place where the command line prints. A stream that cannot be written ends nothing: what was lost is
// remembered, and tells in the exit code.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace probewarp {

/// To standard output. What cannot be written is lost, and finish_printing tells.
void print_plain(std::string_view text);

template <class... Values>
void print(fmt::format_string<Values...> format, Values&&... values) {
    print_plain(fmt::format(format, std::forward<Values>(values)...));
}

/// To standard error, at once. Returns whether it could be written; what could not is lost.
bool print_aside(std::string_view text);

/// Brings what was printed to where it goes. Returns the program's exit code: `code`, but 1 where that is 0
/// and something that was meant for standard output is lost, which is said then.
int finish_printing(int code);

}  // namespace probewarp
