// The command line: reads the arguments and runs what they ask for.
#pragma once

#include <string>

#include "model/deform_by.h"

namespace probewarp {

/// Runs the program. `open_window` is called for `probewarp [FILE] [--deform ...]`, with an empty path for
/// none. Returns the exit code: 0, 1 where something failed, 2 where the arguments are wrong.
int run_command_line(int argc, char** argv, int (*open_window)(const std::string& path, DeformBy deform_by));

}  // namespace probewarp
