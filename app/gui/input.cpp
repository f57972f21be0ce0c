#include "gui/input.h"

#include <backends/imgui_impl_glfw.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "gui/actions.h"
#include "gui/app.h"
#include "gui/guard.h"

namespace probewarp {

namespace {

int editor_key(int key) {
    switch (key) {
        case GLFW_KEY_ESCAPE:
            return key_escape;
        case GLFW_KEY_DELETE:
            return key_delete;
        case GLFW_KEY_BACKSPACE:
            return key_backspace;
        case GLFW_KEY_LEFT:
            return key_left;
        case GLFW_KEY_RIGHT:
            return key_right;
        case GLFW_KEY_UP:
            return key_up;
        case GLFW_KEY_DOWN:
            return key_down;
        default:
            return key > 0 && key < 127 ? key : 0;
    }
}

/// What the layout writes with a key; 0 for keys that write nothing.
char32_t label_of(int key, int scancode) {
    const char* name = glfwGetKeyName(key, scancode);
    unsigned point = 0;
    if (name) ImTextCharFromUtf8(&point, name, nullptr);
    return point;
}

LayoutKey layout_key(int key, int scancode) {
    std::array<char32_t, 26> labels{};
    for (int i = 0; i < 26; ++i) labels[std::size_t(i)] = label_of(GLFW_KEY_A + i, 0);
    return {editor_key(key), label_of(key, scancode), writes_latin(labels)};
}

bool is_keypad(int key) { return key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_EQUAL; }

bool is_modifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

/// Whether a key without Ctrl and Alt comes as a character.
bool writes(const InputEvent& event) {
    if ((event.mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0) return false;
    return (event.code >= GLFW_KEY_SPACE && event.code <= GLFW_KEY_WORLD_2) ||
           (is_keypad(event.code) && event.code != GLFW_KEY_KP_ENTER);
}

void push(App& app, InputEvent event) {
    const Input& input = app.input;
    const double now = glfwGetTime();
    // What was there as soon as the window asked came while it was busy: at any time since it asked last.
    const bool waited = now - input.waits_since > 0.002;
    event.time = {waited ? now : input.polled, now};
    app.input.events.push_back(event);
    app.wake();
}

void on_move(GLFWwindow* window, double x, double y) {
    push(app_of(window), {.kind = InputEvent::Kind::move, .at = {x, y}});
}

void on_button(GLFWwindow* window, int which, int action, int mods) {
    if (which > GLFW_MOUSE_BUTTON_MIDDLE) return;
    push(app_of(window), {.kind = InputEvent::Kind::button, .code = which, .action = action, .mods = mods});
}

void on_scroll(GLFWwindow* window, double across, double steps) {
    push(app_of(window), {.kind = InputEvent::Kind::scroll, .at = {across, steps}});
}

void on_key(GLFWwindow* window, int key, int scancode, int action, int mods) {
    if (key < 0 || key > GLFW_KEY_LAST) return;
    bool held = action == GLFW_REPEAT;
    for (const int arrow : {GLFW_KEY_LEFT, GLFW_KEY_RIGHT, GLFW_KEY_UP, GLFW_KEY_DOWN})
        held = held || (arrow != key && glfwGetKey(window, arrow) == GLFW_PRESS);
    push(app_of(window), {.kind = InputEvent::Kind::key,
                          .code = key,
                          .scancode = scancode,
                          .action = action,
                          .mods = mods,
                          .key = layout_key(key, scancode),
                          .held = held});
}

void on_character(GLFWwindow* window, unsigned character) {
    push(app_of(window), {.kind = InputEvent::Kind::character, .code = int(character)});
}

void on_enter(GLFWwindow* window, int entered) {
    ImGui_ImplGlfw_CursorEnterCallback(window, entered);
    App& app = app_of(window);
    app.wake();
    if (!entered) app.editor.pointer.reset();
}

void on_focus(GLFWwindow* window, int focused) {
    push(app_of(window), {.kind = InputEvent::Kind::focus, .code = focused});
}

/// The pointer in canvas pixels, with the keys that are held. AltGr is no Alt: which of them the right key
/// is, GLFW says only in an event's `mods`.
PointerEvent pointer_event(const App& app, Button button = Button::left, int mods = 0) {
    const auto& held = app.input.held;
    PointerEvent event;
    event.at = app.cursor - glm::dvec2(canvas_corner(app).x, canvas_corner(app).y);
    event.button = button;
    event.shift = held[GLFW_KEY_LEFT_SHIFT] || held[GLFW_KEY_RIGHT_SHIFT];
    event.ctrl = held[GLFW_KEY_LEFT_CONTROL] || held[GLFW_KEY_RIGHT_CONTROL];
    event.alt = held[GLFW_KEY_LEFT_ALT] || (mods & GLFW_MOD_ALT) != 0;
    event.space = held[GLFW_KEY_SPACE];
    return event;
}

/// Whether a press there is the canvas's: inside it, with nothing above it.
bool on_canvas(const App& app, glm::dvec2 at) {
    if (app.modal || at.x < 0 || at.y < 0 || at.x >= app.editor.canvas_size.x ||
        at.y >= app.editor.canvas_size.y)
        return false;
    const ImVec2 p{float(at.x) + canvas_corner(app).x, float(at.y) + canvas_corner(app).y};
    return std::none_of(app.overlays.begin(), app.overlays.end(), [p](const auto& box) {
        return p.x >= box.first.x && p.y >= box.first.y && p.x < box.second.x && p.y < box.second.y;
    });
}

bool is_field_gesture(const App& app) {
    return app.editor.gesture && app.editor.gesture->kind == Gesture::Kind::field;
}

/// What became of an event. `typed` and `looked_at` are handed to the toolkit, which looks once a frame:
/// behind `typed` more may be typed, behind `looked_at` nothing more in this frame. `later` means that the
/// event is to come again in the next one.
enum class Outcome { done, typed, looked_at, later };

/// Hands a key to the toolkit, under the name that the toolkit's own shortcuts want: by the label with Ctrl.
bool hand_to_toolkit(App& app, const InputEvent& event) {
    int& handed = app.input.handed[std::size_t(event.code)];
    const bool release = event.action == GLFW_RELEASE;
    if (release ? handed == 0 : event.action == GLFW_REPEAT) return false;  // it repeats keys by itself
    if (!release) {
        const int label = shortcut_of_key(event.key, true, false).key;
        const bool letter = (event.mods & GLFW_MOD_CONTROL) != 0 && label >= 'A' && label <= 'Z';
        handed = letter ? label : event.code == GLFW_KEY_KP_ENTER ? GLFW_KEY_ENTER : event.code;
    }
    ImGui_ImplGlfw_KeyCallback(app.window, handed, event.scancode, event.action, event.mods);
    if (release) handed = 0;
    return true;
}

/// Ends typing as a click elsewhere does. Returns whether anything was typed in: it ends in the next frame.
bool leave_typing(App& app) {
    if (app.input.left || !is_typing(app)) return false;
    app.input.left = true;
    app.number.wanted = 0;
    if (app.number.id != 0) {
        app.number.key = FieldKey::leave;
    } else {
        ImGui::GetIO().KeysDown[GLFW_KEY_ENTER] = true;
        app.input.enter_to_release = true;
    }
    return true;
}

Outcome take_move(App& app, const InputEvent& event) {
    app.cursor = event.at;
    const PointerEvent pointer = pointer_event(app);
    const bool drags = app.editor.gesture && !is_field_gesture(app);
    if (drags || on_canvas(app, pointer.at))
        move(app.editor, pointer);
    else {
        app.editor.pointer.reset();
        app.editor.hover = {};
    }
    return Outcome::done;
}

Outcome take_button(App& app, const InputEvent& event) {
    const Button button = event.code == GLFW_MOUSE_BUTTON_LEFT     ? Button::left
                          : event.code == GLFW_MOUSE_BUTTON_MIDDLE ? Button::middle
                                                                   : Button::right;
    const PointerEvent pointer = pointer_event(app, button, event.mods);
    const bool pressed = event.action == GLFW_PRESS, canvas = on_canvas(app, pointer.at);
    if (pressed && canvas && leave_typing(app)) return Outcome::later;
    app.input.buttons[std::size_t(event.code)] = pressed;
    app.number.last = 0;
    if (!pressed) {
        release(app.editor, pointer);
        if (!canvas) app.input.frames_to_settle = 2;
    } else if (!canvas) {
        app.input.clicks = {};
    } else {
        if (is_field_gesture(app)) end_gesture(app);
        if (is_double_click(app.input.clicks, pointer, event.time, double(app.scale)))
            double_click(app.editor, pointer);
        else
            press(app.editor, pointer);
    }
    return Outcome::looked_at;
}

Outcome take_scroll(App& app, const InputEvent& event) {
    ImGui_ImplGlfw_ScrollCallback(app.window, event.at.x, event.at.y);
    const PointerEvent pointer = pointer_event(app);
    if (on_canvas(app, pointer.at)) scroll(app.editor, pointer, event.at.y);
    return Outcome::done;
}

/// What a key means to the field that is typed in or dragged.
FieldKey field_key(const App& app, const InputEvent& event) {
    const bool plain = (event.mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) == 0;
    if (!plain || (app.number.id == 0 && app.number.pressed == 0)) return FieldKey::none;
    if (event.code == GLFW_KEY_ESCAPE) return FieldKey::take_back;
    if (app.number.id == 0) return FieldKey::none;
    if (event.code == GLFW_KEY_ENTER || event.code == GLFW_KEY_KP_ENTER) return FieldKey::take;
    if (event.code != GLFW_KEY_TAB) return FieldKey::none;
    return (event.mods & GLFW_MOD_SHIFT) != 0 ? FieldKey::previous : FieldKey::next;
}

/// Tab, where it goes from field to field. Return, Tab and Escape settle before more is typed.
bool take_field_key(App& app, const InputEvent& event) {
    const FieldKey key = field_key(app, event);
    const bool back = (event.mods & GLFW_MOD_SHIFT) != 0;
    const bool tab = event.code == GLFW_KEY_TAB && (event.mods & GLFW_MOD_CONTROL) == 0;
    if (key != FieldKey::none)
        app.number.key = key;
    else if (tab && is_at_tab_stop(app))
        tab_from_field(app, back);
    else if (!tab || is_typing(app) || !tab_into_field(app, back))
        return false;
    app.input.frames_to_settle = 2;
    return true;
}

/// While something is typed, only the commands for files are keys; they take the number as it stands.
bool is_for_files(const Shortcut& key) {
    return key.ctrl && key.key < 127 &&
           std::string_view("SEONQ").find(char(key.key)) != std::string_view::npos;
}

Outcome take_pressed_key(App& app, const InputEvent& event) {
    app.input.key = event.key;
    const bool shift = (event.mods & GLFW_MOD_SHIFT) != 0, ctrl = (event.mods & GLFW_MOD_CONTROL) != 0;
    if (writes(event)) {  // the character comes of itself; in a dialog Space is also a key
        if (event.code == GLFW_KEY_SPACE && app.modal && !is_typing(app) && hand_to_toolkit(app, event))
            return Outcome::looked_at;
        return Outcome::done;
    }
    if (event.action == GLFW_PRESS && take_field_key(app, event)) return Outcome::looked_at;
    const Shortcut shortcut = shortcut_of_key(event.key, ctrl, shift);
    const bool files = is_for_files(shortcut) && (event.mods & (GLFW_MOD_ALT | GLFW_MOD_SUPER)) == 0;
    if (!app.modal && files && leave_typing(app)) return Outcome::later;
    if (app.modal || is_typing(app)) {
        if (!hand_to_toolkit(app, event)) return Outcome::done;
        app.input.frames_to_settle = 1;
        return Outcome::looked_at;
    }
    if ((event.mods & (GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0) return Outcome::done;
    if (is_field_gesture(app) && !files) return Outcome::done;
    if (is_field_gesture(app)) end_gesture(app);
    app.number.last = 0;
    if (shortcut.key == key_escape && !app.editor.gesture && close_error(app)) return Outcome::done;
    if (shortcut.key != 0) press_key(app.editor, shortcut, event.held);
    return Outcome::done;
}

Outcome take_key(App& app, const InputEvent& event) {
    app.input.held[std::size_t(event.code)] = event.action != GLFW_RELEASE;
    app.input.mods = event.mods;
    if (is_modifier(event.code)) {
        // The right Alt key is AltGr on most layouts: to the toolkit it is none.
        if (event.code != GLFW_KEY_RIGHT_ALT) hand_to_toolkit(app, event);
        return Outcome::done;
    }
    if (event.action == GLFW_RELEASE) return hand_to_toolkit(app, event) ? Outcome::looked_at : Outcome::done;
    return take_pressed_key(app, event);
}

Outcome take_character(App& app, const InputEvent& event) {
    if (app.modal || is_typing(app)) {
        ImGui_ImplGlfw_CharCallback(app.window, unsigned(event.code));
        return Outcome::typed;
    }
    if (is_field_gesture(app) || (app.input.mods & GLFW_MOD_SUPER) != 0) return Outcome::done;
    const bool shift = (app.input.mods & GLFW_MOD_SHIFT) != 0;
    const Shortcut shortcut = shortcut_of_character(char32_t(event.code), app.input.key, shift);
    app.number.last = 0;
    if (shortcut.key != 0) press_key(app.editor, shortcut);
    return Outcome::done;
}

Outcome take_focus(App& app, const InputEvent& event) {
    ImGui_ImplGlfw_WindowFocusCallback(app.window, event.code);
    if (event.code == 0 && app.number.id == 0) end_gesture(app);
    return Outcome::done;
}

Outcome take(App& app, const InputEvent& event) {
    switch (event.kind) {
        case InputEvent::Kind::move:
            return take_move(app, event);
        case InputEvent::Kind::button:
            return take_button(app, event);
        case InputEvent::Kind::scroll:
            return take_scroll(app, event);
        case InputEvent::Kind::key:
            return take_key(app, event);
        case InputEvent::Kind::character:
            return take_character(app, event);
        case InputEvent::Kind::focus:
            return take_focus(app, event);
    }
    return Outcome::done;
}

/// Whether the event has to wait for a frame, after what has been handed on for it.
bool waits(const App& app, const InputEvent& event, Outcome before) {
    const bool character = event.kind == InputEvent::Kind::character;
    const bool key = event.kind == InputEvent::Kind::key && !is_modifier(event.code);
    const bool settles = app.input.frames_to_settle > 0 || app.number.wanted != 0 || app.number.starts;
    if ((character || key) && settles) return true;
    if (before == Outcome::looked_at) return true;
    if (before != Outcome::typed || character || event.kind == InputEvent::Kind::move) return false;
    if (event.kind != InputEvent::Kind::key) return true;
    // The keys that write, and Shift, are of no account to the toolkit.
    const bool shift = event.code == GLFW_KEY_LEFT_SHIFT || event.code == GLFW_KEY_RIGHT_SHIFT;
    return !shift && !writes(event);
}

}  // namespace

void set_input_callbacks(GLFWwindow* window) {
    glfwSetCursorPosCallback(window, &on<&on_move>);
    glfwSetMouseButtonCallback(window, &on<&on_button>);
    glfwSetScrollCallback(window, &on<&on_scroll>);
    glfwSetKeyCallback(window, &on<&on_key>);
    glfwSetCharCallback(window, &on<&on_character>);
    glfwSetCursorEnterCallback(window, &on<&on_enter>);
    glfwSetWindowFocusCallback(window, &on<&on_focus>);
}

void set_up_toolkit_input(App& app) {
    ImGuiIO& io = ImGui::GetIO();
    io.MouseDoubleClickTime = float(double_click_seconds);
    io.MouseDoubleClickMaxDist = app.px(double_click_slack);
    io.ConfigDragClickToInputText = true;
    io.ClipboardUserData = &app;
    io.SetClipboardTextFn = [](void* user, const char* text) {
        App& a = *static_cast<App*>(user);
        a.input.clipboard.copy(a.window, text);
    };
    io.GetClipboardTextFn = [](void* user) -> const char* {
        App& a = *static_cast<App*>(user);
        const std::string text = a.input.clipboard.text(a.window);
        a.input.pasted = a.number.id == 0 ? text : pasted_number(text);
        return a.input.pasted.c_str();
    };
}

void begin_polling(App& app) { app.input.waits_since = glfwGetTime(); }

void end_polling(App& app) { app.input.polled = glfwGetTime(); }

void hand_on_input(App& app) {
    Input& input = app.input;
    if (input.frames_to_settle > 0) --input.frames_to_settle;
    if (std::exchange(input.enter_to_release, false)) ImGui::GetIO().KeysDown[GLFW_KEY_ENTER] = false;
    Outcome outcome = Outcome::done;
    while (!input.events.empty() && !waits(app, input.events.front(), outcome)) {
        const InputEvent event = input.events.front();
        input.events.pop_front();  // before it is taken: what fails is not tried again
        const Outcome next = take(app, event);
        if (next == Outcome::later) {
            input.events.push_front(event);
            break;
        }
        input.left = false;
        if (next != Outcome::done) outcome = next;
        if (!app.editor.requests.empty()) {  // a dialog may open, which takes the keys
            input.frames_to_settle = 2;
            break;
        }
    }
    if (!input.events.empty() || input.frames_to_settle > 0) app.wake();
}

void place_mouse(const App& app) {
    ImGuiIO& io = ImGui::GetIO();
    if (io.MousePos.x > -FLT_MAX) io.MousePos = {float(app.cursor.x), float(app.cursor.y)};
    std::copy(app.input.buttons.begin(), app.input.buttons.end(), io.MouseDown);
}

}  // namespace probewarp
