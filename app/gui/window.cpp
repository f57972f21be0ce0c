#include "gui/window.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <future>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "editor/commands.h"
#include "gui/actions.h"
#include "gui/app.h"
#include "gui/canvas.h"
#include "gui/dialogs.h"
#include "gui/panels.h"
#include "render/context.h"

namespace probewarp {

namespace {

App& app_of(GLFWwindow* window) { return *static_cast<App*>(glfwGetWindowUserPointer(window)); }

ImVec2 canvas_corner(const App& app) { return {app.px(look::tools), app.px(look::menu)}; }

/// PROBEWARP_UI_SCALE wins over what the display says.
float wanted_scale(GLFWmonitor* monitor) {
    if (const char* text = std::getenv("PROBEWARP_UI_SCALE"))
        if (const float value = std::strtof(text, nullptr); value >= 0.5f && value <= 4) return value;
    float x = 1, y = 1;
    if (monitor) glfwGetMonitorContentScale(monitor, &x, &y);
    return std::clamp(x, 0.5f, 4.0f);
}

/// The pointer in canvas pixels, with the keys that are held. Where it was at the event: asked now, the
/// display would say where it has got to since, and a quick hand would press beside what it meant.
PointerEvent pointer_event(const App& app, Button button = Button::left) {
    const auto held = [&app](int left, int right) {
        return glfwGetKey(app.window, left) == GLFW_PRESS || glfwGetKey(app.window, right) == GLFW_PRESS;
    };
    PointerEvent event;
    event.at = app.cursor - glm::dvec2(canvas_corner(app).x, canvas_corner(app).y);
    event.button = button;
    event.shift = held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
    event.ctrl = held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
    event.alt = held(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
    event.space = held(GLFW_KEY_SPACE, GLFW_KEY_SPACE);
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

void on_move(GLFWwindow* window, double x, double y) {
    App& app = app_of(window);
    app.wake();
    app.cursor = {x, y};
    const PointerEvent event = pointer_event(app);
    const bool drags = app.editor.gesture && app.editor.gesture->kind != Gesture::Kind::field;
    if (drags || on_canvas(app, event.at))
        move(app.editor, event);
    else {
        app.editor.pointer.reset();
        app.editor.hover = {};
    }
}

void on_button(GLFWwindow* window, int which, int action, int mods) {
    ImGui_ImplGlfw_MouseButtonCallback(window, which, action, mods);
    static double last_press = -1;
    static glm::dvec2 last_place{0};
    App& app = app_of(window);
    app.wake();
    if (which > GLFW_MOUSE_BUTTON_MIDDLE) return;
    const Button button = which == GLFW_MOUSE_BUTTON_LEFT     ? Button::left
                          : which == GLFW_MOUSE_BUTTON_MIDDLE ? Button::middle
                                                              : Button::right;
    const PointerEvent event = pointer_event(app, button);
    if (action == GLFW_RELEASE) return release(app.editor, event);
    if (!on_canvas(app, event.at)) return;
    if (app.editor.gesture && app.editor.gesture->kind == Gesture::Kind::field) end_gesture(app);
    const glm::dvec2 way = event.at - last_place;
    const double now = glfwGetTime();
    const bool twice =
        button == Button::left && now - last_press < 0.4 && std::hypot(way.x, way.y) < app.px(5);
    last_press = button == Button::left && !twice ? now : -1;
    last_place = event.at;
    if (twice)
        double_click(app.editor, event);
    else
        press(app.editor, event);
}

void on_scroll(GLFWwindow* window, double across, double steps) {
    ImGui_ImplGlfw_ScrollCallback(window, across, steps);
    App& app = app_of(window);
    app.wake();
    const PointerEvent event = pointer_event(app);
    if (on_canvas(app, event.at)) scroll(app.editor, event, steps);
}

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
        case GLFW_KEY_KP_ADD:
            return '=';
        case GLFW_KEY_KP_SUBTRACT:
            return '-';
        default:
            return key > 0 && key < 127 ? key : 0;
    }
}

/// The key as the keyboard's layout labels it, so that Ctrl+Z is where the Z is.
int layout_key(int key, int scancode) {
    const char* name = key >= GLFW_KEY_A && key <= GLFW_KEY_Z ? glfwGetKeyName(key, scancode) : nullptr;
    if (name && name[0] >= 'a' && name[0] <= 'z' && name[1] == '\0') return name[0] - 'a' + 'A';
    return key;
}

/// ImGui looks at keys once a frame, so that a key pressed and released between two frames would be lost: its
/// release is kept for the next frame.
struct KeyRelease {
    int key, scancode, mods;
};
std::vector<int> pressed_this_frame;
std::vector<KeyRelease> late_releases;

void hand_key_to_toolkit(GLFWwindow* window, int key, int scancode, int action, int mods) {
    const bool just_pressed =
        std::find(pressed_this_frame.begin(), pressed_this_frame.end(), key) != pressed_this_frame.end();
    if (action == GLFW_RELEASE && just_pressed) return late_releases.push_back({key, scancode, mods});
    if (action == GLFW_PRESS) pressed_this_frame.push_back(key);
    ImGui_ImplGlfw_KeyCallback(window, key, scancode, action, mods);
}

void release_late_keys(App& app) {
    pressed_this_frame.clear();
    for (const KeyRelease& late : std::exchange(late_releases, {})) {
        ImGui_ImplGlfw_KeyCallback(app.window, late.key, late.scancode, GLFW_RELEASE, late.mods);
        app.wake();
    }
}

void on_key(GLFWwindow* window, int key, int scancode, int action, int mods) {
    hand_key_to_toolkit(window, key, scancode, action, mods);
    App& app = app_of(window);
    app.wake();
    if (action == GLFW_RELEASE || app.modal || (mods & (GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0) return;
    const Shortcut shortcut{editor_key(layout_key(key, scancode)), (mods & GLFW_MOD_CONTROL) != 0,
                            (mods & GLFW_MOD_SHIFT) != 0};
    const bool field = app.editor.gesture && app.editor.gesture->kind == Gesture::Kind::field;
    if (field || ImGui::GetIO().WantTextInput) {
        // While something is typed, only the commands for files are keys; they take the number as it stands.
        const bool for_files =
            shortcut.ctrl && std::string_view("SEONQ").find(char(shortcut.key)) != std::string_view::npos;
        if (!for_files) return;
        end_gesture(app);
    }
    if (shortcut.key != 0) press_key(app.editor, shortcut);
}

void on_character(GLFWwindow* window, unsigned character) {
    ImGui_ImplGlfw_CharCallback(window, character);
    app_of(window).wake();
}

void on_enter(GLFWwindow* window, int entered) {
    ImGui_ImplGlfw_CursorEnterCallback(window, entered);
    App& app = app_of(window);
    app.wake();
    if (!entered) app.editor.pointer.reset();
}

void on_focus(GLFWwindow* window, int focused) {
    ImGui_ImplGlfw_WindowFocusCallback(window, focused);
    App& app = app_of(window);
    app.wake();
    if (!focused) end_gesture(app);
}

void on_close(GLFWwindow* window) {
    glfwSetWindowShouldClose(window, GLFW_FALSE);
    App& app = app_of(window);
    app.wake();
    if (!app.modal) app.editor.requests.push_back(Request::quit);
}

void on_drop(GLFWwindow* window, int count, const char** paths) {
    App& app = app_of(window);
    app.wake();
    if (count > 0 && !app.modal) open_path(app, paths[0]);
}

void on_damage(GLFWwindow* window) {
    App& app = app_of(window);
    app.redraws = true;
    app.wake();
}
void on_size(GLFWwindow* window, int, int) { on_damage(window); }

void use_fonts(App& app, const Fonts& fonts) {
    app.fonts = fonts;
    ImGui::GetIO().FontDefault = fonts.text;
    apply_theme(app.theme, app.scale);
}

void rebuild_fonts(App& app) {
    use_fonts(app, load_fonts(app.scale));
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
    app.redraws = true;
}

void on_content_scale(GLFWwindow* window, float scale, float) {
    App& app = app_of(window);
    if (!std::getenv("PROBEWARP_UI_SCALE")) app.scale = std::clamp(scale, 0.5f, 4.0f);
    app.fonts = {};  // rasterised anew before the next frame
    app.wake();
}

/// GLFW, from its beginning to its end.
struct Glfw {
    Glfw() {
        glfwSetErrorCallback([](int, const char*) {});
        if (!glfwInit()) {
            const char* why = nullptr;
            glfwGetError(&why);
            throw Error(fmt::format("cannot open a window: {}; probewarp render works without a display",
                                    why ? why : "no display"));
        }
    }
    ~Glfw() { glfwTerminate(); }
    Glfw(const Glfw&) = delete;
    Glfw& operator=(const Glfw&) = delete;
};

/// 1280 x 800 at scale 1, or what the monitor has room for.
ImVec2 window_size(GLFWmonitor* monitor, float scale) {
    int x = 0, y = 0, width = 1280, height = 800;
    if (monitor) glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    return {std::min(1280 * scale, float(width)), std::min(800 * scale, float(height))};
}

GLFWwindow* open_window(float scale) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    const ImVec2 size = window_size(glfwGetPrimaryMonitor(), scale);
    GLFWwindow* window = glfwCreateWindow(int(size.x), int(size.y), "Probewarp", nullptr, nullptr);
    if (!window) {
        const char* why = nullptr;
        glfwGetError(&why);
        throw Error(fmt::format("cannot open a window with OpenGL 3.3: {}", why ? why : "unknown reason"));
    }
    glfwMakeContextCurrent(window);
    glfwSwapInterval(1);
    return window;
}

/// What GLFW calls for an event, with no exception on the way back.
template <auto callback, class... Values>
void on(GLFWwindow* window, Values... values) {
    guarded(app_of(window), [&] { callback(window, values...); });
}

void set_callbacks(GLFWwindow* window) {
    glfwSetCursorPosCallback(window, &on<&on_move>);
    glfwSetMouseButtonCallback(window, &on<&on_button>);
    glfwSetScrollCallback(window, &on<&on_scroll>);
    glfwSetKeyCallback(window, &on<&on_key>);
    glfwSetCharCallback(window, &on<&on_character>);
    glfwSetCursorEnterCallback(window, &on<&on_enter>);
    glfwSetWindowFocusCallback(window, &on<&on_focus>);
    glfwSetWindowCloseCallback(window, &on<&on_close>);
    glfwSetDropCallback(window, &on<&on_drop>);
    glfwSetWindowRefreshCallback(window, &on<&on_damage>);
    glfwSetFramebufferSizeCallback(window, &on<&on_size>);
    glfwSetWindowContentScaleCallback(window, &on<&on_content_scale>);
}

/// ImGui itself; its fonts are rasterised on a thread of their own from the beginning on.
struct Toolkit {
    std::future<Fonts> fonts;

    explicit Toolkit(float scale) {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
        try {
            fonts = std::async(std::launch::async, &load_fonts, scale);
        } catch (const std::system_error&) {  // there is no thread for it
            fonts = std::async(std::launch::deferred, &load_fonts, scale);
        }
    }
    ~Toolkit() {
        if (fonts.valid()) fonts.wait();
        ImGui::DestroyContext();
    }
    Toolkit(const Toolkit&) = delete;
    Toolkit& operator=(const Toolkit&) = delete;
};

/// Its two backends. The callbacks are ours and hand on to its own.
struct ToolkitBackends {
    explicit ToolkitBackends(GLFWwindow* window) {
        ImGui_ImplGlfw_InitForOpenGL(window, false);
        ImGui_ImplOpenGL3_Init("#version 330 core");
    }
    ~ToolkitBackends() {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
    }
    ToolkitBackends(const ToolkitBackends&) = delete;
    ToolkitBackends& operator=(const ToolkitBackends&) = delete;
};

void set_title(App& app) {
    static std::string shown;
    const std::string name = document_name(app);
    const bool dirty = has_picture(app.editor) && !is_saved(app.editor.history);
    const std::string title =
        name.empty() ? "Probewarp" : fmt::format("{}{} – Probewarp", dirty ? "● " : "", name);
    if (title != shown) glfwSetWindowTitle(app.window, title.c_str());
    shown = title;
}

/// Shows what the toolkit has, unless it is on the screen already.
void show_frame(App& app) {
    if (!app.last_frame.differs(*ImGui::GetDrawData()) && !app.redraws) return;
    app.redraws = false;
    int width = 0, height = 0;
    glfwGetFramebufferSize(app.window, &width, &height);
    clear_window(width, height, display_colours(app.theme).canvas);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(app.window);
    ++app.frames;
}

/// The canvas and the panels round it.
void draw_workplace(App& app) {
    const ImVec2 display = ImGui::GetIO().DisplaySize, corner = canvas_corner(app);
    const float panel = has_picture(app.editor) ? app.px(look::panel) : 0;
    // Behind work that the window waits for nothing can be used; it keeps its looks, since most is over at
    // once.
    const bool busy = is_busy(app);
    ImGui::PushStyleVar(ImGuiStyleVar_DisabledAlpha, busy ? 1.0f : ImGui::GetStyle().DisabledAlpha);
    ImGui::BeginDisabled(busy);
    draw_canvas(app, corner.x, corner.y, std::max(1.0f, display.x - corner.x - panel),
                std::max(1.0f, display.y - corner.y - app.px(look::status)));
    draw_menu_bar(app);
    draw_tool_strip(app);
    draw_panel(app);
    draw_status_bar(app);
    ImGui::EndDisabled();
    ImGui::PopStyleVar();
}

void draw_frame(App& app) {
    if (!app.fonts.text) rebuild_fonts(app);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    app.overlays.clear();
    // One that failed once is tried once more.
    if (app.failed_frames < 2)
        draw_workplace(app);
    else
        draw_makeshift(app);
    draw_file_dialog(app);
    draw_export_dialog(app);
    draw_levels_dialog(app);
    draw_questions(app);
    draw_about(app);
    draw_progress(app);
    draw_messages(app);
    app.modal = is_busy(app) ||
                ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel) ||
                app.file_dialog.open || app.export_dialog.open || app.levels_dialog.open || app.about_open ||
                !app.questions.empty();
    ImGui::Render();
    show_frame(app);
}

/// Draws a frame, and ends one that fails so that another can begin.
void draw_guarded_frame(App& app) {
    const bool makeshift = app.failed_frames >= 2;
    if (guarded(app, [&] { draw_frame(app); })) {
        app.failed_frames = makeshift ? std::min(app.failed_frames, 2) : 0;
        return;
    }
    ++app.failed_frames;
    if (ImGui::GetCurrentContext()->WithinFrameScope) {
        ImGui::ErrorCheckEndFrameRecover(nullptr);
        ImGui::EndFrame();
    }
}

/// Sleeps until there is something to do: idle, the program uses no processor time.
void wait_for_events(App& app) {
    if (is_busy(app) && !app.jobs.uploading) {  // leaves the processor to those who work
        glfwWaitEventsTimeout(0.03);
        return app.wake();
    }
    // One failure after the other does not keep the processor busy.
    if (app.failed_frames > 2) return glfwWaitEventsTimeout(0.1);
    if (app.frames_wanted > 0 || wants_trial(app)) return glfwPollEvents();
    const double message = next_message_change(app);
    const double caret = ImGui::GetIO().WantTextInput ? 0.3 : -1;  // a text field's caret blinks
    // While weights are being worked out the status bar tells so; and what was given up is seen to end.
    if (app.deform_job || !app.abandoned_jobs.empty()) {
        glfwWaitEventsTimeout(0.1);
        return app.wake();
    }
    const double wait = message < 0 ? caret : caret < 0 ? message : std::min(message, caret);
    if (wait < 0)
        glfwWaitEvents();
    else
        glfwWaitEventsTimeout(std::max(wait, 0.005));
    app.wake();
}

void run(App& app) {
    // For the benchmark of the start: the first frame, or where there is a picture the first with it, is the
    // last.
    const bool leaves_at_once = std::getenv("PROBEWARP_QUIT_AFTER_FIRST_FRAME") != nullptr;
    const bool opens = is_busy(app);
    while (!app.quit) {
        guarded(app, [&] { wait_for_events(app); });
        guarded(app, [&] { advance_jobs(app); });
        guarded(app, [&] { handle_requests(app); });
        guarded(app, [&] { set_title(app); });
        settle_trouble(app);
        draw_guarded_frame(app);
        if (leaves_at_once && (!opens || app.shown.picture)) return;
        release_late_keys(app);
        if (app.frames_wanted > 0)
            --app.frames_wanted;
        else if (wants_trial(app))
            guarded(app, [&] { advance_trial(app); });
    }
}

}  // namespace

int run_window(const std::string& path, DeformBy deform_by) {
    const Glfw glfw;
    App app;
    app.scale = wanted_scale(glfwGetPrimaryMonitor());
    app.editor.deforms_elsewhere = true;
    app.editor.deform_by = deform_by;
    // The driver takes most of the time until the first frame: fonts and file are read meanwhile.
    Toolkit toolkit(app.scale);
    if (!path.empty()) open_path(app, path);
    app.window = open_window(app.scale);
    load_gl(&glfwGetProcAddress);
    glfwSetWindowUserPointer(app.window, &app);
    app.renderer = std::make_unique<Renderer>();
    app.renderer_label = renderer_name();
    use_fonts(app, toolkit.fonts.get());
    const ToolkitBackends backends(app.window);
    set_callbacks(app.window);
    run(app);
    glfwHideWindow(app.window);  // a thread that is in the middle of something may take seconds to end
    return 0;
}

}  // namespace probewarp
