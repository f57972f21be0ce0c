#include "gui/window.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <future>
#include <system_error>

#include "editor/commands.h"
#include "gui/actions.h"
#include "gui/app.h"
#include "gui/canvas.h"
#include "gui/dialogs.h"
#include "gui/input.h"
#include "gui/panels.h"
#include "render/context.h"

namespace probewarp {

namespace {

/// PROBEWARP_UI_SCALE wins over what the display says.
float wanted_scale(GLFWmonitor* monitor) {
    if (const char* text = std::getenv("PROBEWARP_UI_SCALE"))
        if (const float value = std::strtof(text, nullptr); value >= 0.5f && value <= 4) return value;
    float x = 1, y = 1;
    if (monitor) glfwGetMonitorContentScale(monitor, &x, &y);
    return std::clamp(x, 0.5f, 4.0f);
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
    open_dropped(app, {paths, std::size_t(std::max(0, count))});
}

void on_damage(GLFWwindow* window) {
    App& app = app_of(window);
    app.redraws = true;
    app.wake();
}

/// How large the window must be for all of it to be in reach, pixels at scale 1.
constexpr float least_width = 640, least_height = 480;

/// As much of the scale as a window of that size has room for, in steps that are worth rasterising fonts for.
float scale_within(float scale, ImVec2 size) {
    const float room = std::min(size.x / least_width, size.y / least_height);
    return std::min(scale, std::max(0.5f, std::floor(room * 8) / 8));
}

void fit_scale(App& app, ImVec2 size) {
    const float scale = scale_within(app.display_scale, size);
    if (scale == app.scale) return;
    app.scale = scale;
    app.fonts = {};  // rasterised anew before the next frame
}

void on_size(GLFWwindow* window, int width, int height) {
    fit_scale(app_of(window), {float(width), float(height)});
    on_damage(window);
}

void use_fonts(App& app, const Fonts& fonts) {
    app.fonts = fonts;
    ImGui::GetIO().FontDefault = fonts.text;
    apply_theme(app.theme, app.scale);
}

void rebuild_fonts(App& app) {
    app.fonts = {};  // whatever fails on the way, the old ones are gone: the next frame tries again
    use_fonts(app, load_fonts_with(app.scale, app.glyphs.loaded));
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
    app.redraws = true;
}

/// 640 x 480 at scale 1, or what the monitor has room for.
void set_least_size(GLFWwindow* window, float scale) {
    int x = 0, y = 0, width = 0, height = 0;
    if (GLFWmonitor* monitor = glfwGetPrimaryMonitor())
        glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    const auto least = [](float wanted, int room) {
        return room > 0 ? std::min(int(wanted), room) : int(wanted);
    };
    glfwSetWindowSizeLimits(window, least(least_width * scale, width), least(least_height * scale, height),
                            GLFW_DONT_CARE, GLFW_DONT_CARE);
}

void on_content_scale(GLFWwindow* window, float scale, float) {
    App& app = app_of(window);
    if (!std::getenv("PROBEWARP_UI_SCALE")) app.display_scale = std::clamp(scale, 0.5f, 4.0f);
    set_least_size(window, app.display_scale);
    int width = 0, height = 0;
    glfwGetWindowSize(window, &width, &height);
    fit_scale(app, {float(width), float(height)});
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

void set_callbacks(GLFWwindow* window) {
    set_input_callbacks(window);
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
    if (app.glyphs.update(app.scale) || !app.fonts.text) rebuild_fonts(app);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    place_mouse(app);
    ImGui::NewFrame();
    begin_number_fields(app);
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
    end_number_fields(app);
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
        guarded(app, [&] {
            begin_polling(app);
            wait_for_events(app);
            end_polling(app);
        });
        guarded(app, [&] { hand_on_input(app); });
        guarded(app, [&] { advance_jobs(app); });
        guarded(app, [&] { handle_requests(app); });
        guarded(app, [&] { set_title(app); });
        settle_trouble(app);
        draw_guarded_frame(app);
        if (leaves_at_once && (!opens || app.shown.picture)) return;
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
    app.display_scale = wanted_scale(glfwGetPrimaryMonitor());
    app.scale = scale_within(app.display_scale, window_size(glfwGetPrimaryMonitor(), app.display_scale));
    app.editor.deforms_elsewhere = true;
    app.editor.deform_by = deform_by;
    // The driver takes most of the time until the first frame: fonts and file are read meanwhile.
    Toolkit toolkit(app.scale);
    if (!path.empty()) open_path(app, path);
    app.window = open_window(app.display_scale);
    set_least_size(app.window, app.display_scale);
    load_gl(&glfwGetProcAddress);
    glfwSetWindowUserPointer(app.window, &app);
    app.renderer = std::make_unique<Renderer>();
    app.renderer_label = renderer_name();
    use_fonts(app, toolkit.fonts.get());
    const ToolkitBackends backends(app.window);
    set_up_toolkit_input(app);
    set_callbacks(app.window);
    run(app);
    glfwHideWindow(app.window);  // a thread that is in the middle of something may take seconds to end
    return 0;
}

}  // namespace probewarp
