// The clipboard's text, asked of whoever owns it with a limit on the wait: GLFW waits for ever for an owner
// that hangs or has just ended, and the window with it.
#pragma once

#include <GLFW/glfw3.h>

#include <string>

namespace probewarp {

struct Clipboard {
    unsigned long own = 0;  ///< the X window that owns what was copied here; 0: nothing was

    void copy(GLFWwindow* window, const char* text);
    /// UTF-8; empty where there is no text, or where the owner has not answered within half a second.
    std::string text(GLFWwindow* window) const;
};

}  // namespace probewarp
