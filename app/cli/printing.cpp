#include "cli/printing.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "cli/commands.h"

namespace probewarp {

namespace {

int output_error = 0;  // the first; 0 while all is well

}  // namespace

void print_plain(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() && output_error == 0)
        output_error = errno;
}

bool print_aside(std::string_view text) {
    const bool whole = std::fwrite(text.data(), 1, text.size(), stderr) == text.size();
    return std::fflush(stderr) == 0 && whole;
}

int finish_printing(int code) {
    if (std::fflush(stdout) != 0 && output_error == 0) output_error = errno;
    if (output_error == 0 || code != 0) return code;
    print_failure("cannot write to standard output: " + std::generic_category().message(output_error));
    return 1;
}

}  // namespace probewarp
