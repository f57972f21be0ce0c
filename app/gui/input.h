// The hand's events, on their way from GLFW to the editor and the toolkit. GLFW tells of several at once, and
// the toolkit looks at keys and buttons once a frame: they wait in a queue, so that what was typed is taken
// in its order, by the field or the canvas that the events before it have led to.
#pragma once

#include <GLFW/glfw3.h>

#include <array>
#include <bitset>
#include <deque>
#include <string>

#include "editor/clicks.h"
#include "editor/keys.h"
#include "gui/clipboard.h"

namespace probewarp {

struct App;

struct InputEvent {
    enum class Kind { move, button, scroll, key, character, focus } kind = Kind::move;
    int code = 0;  ///< GLFW's button or key, a code point, or whether the window has the keyboard
    int scancode = 0, action = 0, mods = 0;
    glm::dvec2 at{0};   ///< move: window pixels; scroll: steps
    LayoutKey key{};    ///< key: on the layout of that moment
    bool held = false;  ///< key: it repeats, or another arrow is down
    EventTime time{};
};

struct Input {
    std::deque<InputEvent> events;  ///< those that wait, the oldest first
    // As of the last event that was handed on:
    std::array<bool, 3> buttons{};                ///< down; left, right, middle
    std::bitset<GLFW_KEY_LAST + 1> held;          ///< keys that are down
    int mods = 0;                                 ///< GLFW's, of the last key
    LayoutKey key;                                ///< the last key that was pressed
    std::array<int, GLFW_KEY_LAST + 1> handed{};  ///< the toolkit's name of each key that it believes down; 0
    ClickCounter clicks;
    Clipboard clipboard;
    std::string pasted;  ///< what the clipboard last held, as the field was given it
    int frames_to_settle =
        0;  ///< before keys go on: a field takes the keyboard a frame after it was asked to
    bool enter_to_release = false;       ///< the toolkit was told so, to end a text
    bool left = false;                   ///< typing was ended for the event that waits
    double waits_since = 0, polled = 0;  ///< seconds of GLFW's clock: when the window last began and ended to
                                         ///< ask for events
};

/// Sets GLFW's callbacks for mouse and keys.
void set_input_callbacks(GLFWwindow* window);

/// The toolkit's own settings for clicks, and its clipboard. Call once its backends are there.
void set_up_toolkit_input(App& app);

/// Call before and after GLFW is asked for events: tells when they happened.
void begin_polling(App& app);
void end_polling(App& app);

/// Hands on what waits, as far as the next frame can take it.
void hand_on_input(App& app);

/// Call between the toolkit's backend and the toolkit's frame: the mouse is where the events that were handed
/// on have led to, wherever it has got to since.
void place_mouse(const App& app);

}  // namespace probewarp
