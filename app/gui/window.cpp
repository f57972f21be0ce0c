#include "gui/window.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <future>

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

App& app_of(GLFWwindow* window) { return *static_cast<App*>(glfwGetWindowUserPointer(window)); }

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

void set_callbacks(GLFWwindow* window) {
    set_input_callbacks(window);
    glfwSetWindowCloseCallback(window, &on_close);
    glfwSetDropCallback(window, &on_drop);
    glfwSetWindowRefreshCallback(window, &on_damage);
    glfwSetFramebufferSizeCallback(window, &on_size);
    glfwSetWindowContentScaleCallback(window, &on_content_scale);
}

/// ImGui itself; its fonts are rasterised on a thread of their own from the beginning on.
struct Toolkit {
    std::future<Fonts> fonts;

    explicit Toolkit(float scale) {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
        fonts = std::async(std::launch::async, &load_fonts, scale);
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

void draw_frame(App& app) {
    if (!app.fonts.text) rebuild_fonts(app);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    place_mouse(app);
    ImGui::NewFrame();
    begin_number_fields(app);
    app.overlays.clear();
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

/// Sleeps until there is something to do: idle, the program uses no processor time.
void wait_for_events(App& app) {
    if (is_busy(app) && !app.jobs.uploading) {  // leaves the processor to those who work
        glfwWaitEventsTimeout(0.03);
        return app.wake();
    }
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
        begin_polling(app);
        wait_for_events(app);
        end_polling(app);
        hand_on_input(app);
        advance_jobs(app);
        handle_requests(app);
        set_title(app);
        draw_frame(app);
        if (leaves_at_once && (!opens || app.shown.picture)) return;
        if (app.frames_wanted > 0)
            --app.frames_wanted;
        else if (wants_trial(app))
            advance_trial(app);
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
    set_up_toolkit_input(app);
    set_callbacks(app.window);
    run(app);
    glfwHideWindow(app.window);  // a thread that is in the middle of something may take seconds to end
    return 0;
}

}  // namespace probewarp
