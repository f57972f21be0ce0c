// The window: GLFW's events in, frames out.
#pragma once

#include <string>

#include "model/deform_by.h"

namespace probewarp {

/// Opens the window, on `path` where it is not empty, and runs until it is closed. `deform_by` is what it
/// begins with. Returns the exit code. Throws Error where there is no display or no OpenGL 3.3.
int run_window(const std::string& path, DeformBy deform_by);

}  // namespace probewarp
