#include "gui/clipboard.h"

#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3native.h>
#include <X11/Xatom.h>
#include <poll.h>

#include <chrono>
#include <memory>

namespace probewarp {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto patience = std::chrono::milliseconds(500);
constexpr long most_words =
    256 * 1024;  // of four bytes each; who pastes more into a field means something else

struct CloseDisplay {
    void operator()(Display* display) const { XCloseDisplay(display); }
};

/// A connection of its own to the X server, so that the owner's answer meets no other event.
class Asker {
  public:
    explicit Asker(Display* display)
        : display_(display),
          window_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)),
          text_(XInternAtom(display, "UTF8_STRING", False)),
          answer_(XInternAtom(display, "PROBEWARP_CLIPBOARD", False)) {
        XConvertSelection(display, XInternAtom(display, "CLIPBOARD", False), text_, answer_, window_,
                          CurrentTime);
        XFlush(display);
    }

    std::string text() const {
        XEvent event;
        if (!wait(event) || event.xselection.property == None) return {};
        Atom type = None;
        int bits = 0;
        unsigned long items = 0, left = 0;
        unsigned char* data = nullptr;
        if (XGetWindowProperty(display_, window_, answer_, 0, most_words, True, text_, &type, &bits, &items,
                               &left, &data) != Success)
            return {};
        std::string text;
        if (data && type == text_ && bits == 8) text.assign(reinterpret_cast<const char*>(data), items);
        if (data) XFree(data);
        return text;
    }

  private:
    /// For the owner's answer. Returns whether it came in time.
    bool wait(XEvent& event) const {
        const auto until = Clock::now() + patience;
        while (!XCheckTypedWindowEvent(display_, window_, SelectionNotify, &event)) {
            const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
            if (left.count() <= 0) return false;
            pollfd connection{ConnectionNumber(display_), POLLIN, 0};
            ::poll(&connection, 1, int(left.count()));
        }
        return true;
    }

    Display* display_;
    Window window_;  // goes with the connection
    Atom text_, answer_;
};

Window owner_of_clipboard(Display* display) {
    return XGetSelectionOwner(display, XInternAtom(display, "CLIPBOARD", False));
}

}  // namespace

void Clipboard::copy(GLFWwindow* window, const char* copied) {
    glfwSetClipboardString(window, copied);
    own = owner_of_clipboard(glfwGetX11Display());
}

std::string Clipboard::text(GLFWwindow* window) const {
    Display* const shown = glfwGetX11Display();
    // What was copied here is GLFW's to tell: asked by another connection it could not answer meanwhile.
    if (own != 0 && owner_of_clipboard(shown) == own) {
        const char* copied = glfwGetClipboardString(window);
        return copied ? copied : "";
    }
    const std::unique_ptr<Display, CloseDisplay> display(XOpenDisplay(DisplayString(shown)));
    return display ? Asker(display.get()).text() : "";
}

}  // namespace probewarp
