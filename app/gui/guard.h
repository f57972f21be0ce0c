// What goes wrong in an event or in a frame is said and loses nothing: the document is what it was before the
// gesture or the step that failed. GLFW, which calls for the events, is C: no exception may pass through it.
#pragma once

#include <GLFW/glfw3.h>

#include <array>
#include <exception>
#include <string>

namespace probewarp {

struct App;

/// What went wrong and is not said yet. Of a fixed size, since it may be memory that is short.
struct Trouble {
    std::array<char, 500> reason{};  ///< a sentence that ends with 0; empty: none
    bool restores = false;           ///< the document is to be taken back to the last step
};

/// The sentence on an exception.
std::string failure_text(const std::exception_ptr& failure);

/// Keeps the exception that is being handled to be said, and takes back a gesture that is under way.
/// Allocates nothing.
void recover(App& app) noexcept;

/// Does what recover left to be done, as far as there is the memory for it: restores the document, says what
/// went wrong.
void settle_trouble(App& app) noexcept;

/// Runs the step. Returns whether it came to its end.
template <class Step>
bool guarded(App& app, const Step& step) noexcept {
    try {
        step();
        return true;
    } catch (...) {
        recover(app);
        return false;
    }
}

/// The window's App.
App& app_of(GLFWwindow* window);

/// What GLFW calls for an event, with no exception on the way back.
template <auto callback, class... Values>
void on(GLFWwindow* window, Values... values) {
    guarded(app_of(window), [&] { callback(window, values...); });
}

}  // namespace probewarp
