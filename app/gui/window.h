// The window: GLFW's events in, frames out.
#pragma once

#include <string>

namespace probewarp {

/// Opens the window, on `path` where it is not empty, and runs until it is closed. Returns the exit code.
/// Throws Error where there is no display or no OpenGL 3.3.
int run_window(const std::string& path);

}  // namespace probewarp
