// The bars around the canvas; the panel at the right has a file of its own, panel.cpp.
#include "gui/panels.h"

#include <fmt/format.h>

#include <cmath>

#include "editor/commands.h"
#include "editor/tools.h"
#include "gui/actions.h"
#include "gui/app.h"
#include "gui/widgets.h"

namespace probewarp {

namespace {

constexpr ImGuiWindowFlags bar_flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                       ImGuiWindowFlags_NoSavedSettings |
                                       ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav;

void begin_bar(App& app, const char* id, ImVec2 at, ImVec2 size, ImGuiWindowFlags more = 0) {
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, app.theme.panel);
    ImGui::Begin(id, nullptr, bar_flags | more);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(4);
}

std::string reason(const Editor& editor, const Command& command) {
    return command.why_not ? std::string(command.why_not(editor)) : std::string();
}

void menu_item(App& app, const Command& command) {
    const std::string why_not = reason(app.editor, command);
    const bool theme = command.label == "Light theme";
    const bool on = theme ? app.theme.is_light : command.on && command.on(app.editor);
    if (ImGui::MenuItem(std::string(command.label).c_str(), to_text(command.shortcut).c_str(), on,
                        why_not.empty()))
        run(app.editor, command);
    if (!why_not.empty()) tooltip(why_not.c_str());
}

void draw_menus(App& app) {
    std::string_view open_menu;
    bool shown = false;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {app.px(10), app.px(8)});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {app.px(18), app.px(9)});
    for (const Command& command : commands()) {
        if (command.menu != open_menu) {
            if (shown) ImGui::EndMenu();
            open_menu = command.menu;
            shown = ImGui::BeginMenu(std::string(open_menu).c_str());
        } else if (shown && command.separated) {
            ImGui::Separator();
        }
        if (shown) menu_item(app, command);
    }
    if (shown) ImGui::EndMenu();
    ImGui::PopStyleVar(2);
}

void draw_title(App& app, float width) {
    const std::string name = document_name(app);
    if (name.empty()) return;
    const bool saved = is_saved(app.editor.history) && !app.editor.gesture;
    const std::string title = saved ? name : "●  " + name;
    const float text = ImGui::CalcTextSize(title.c_str()).x;
    ImGui::GetWindowDrawList()->AddText(
        {std::round((width - text) / 2), std::round((app.px(look::menu) - ImGui::GetFontSize()) / 2)},
        app.theme.muted, title.c_str());
}

}  // namespace

void draw_menu_bar(App& app) {
    const float width = ImGui::GetIO().DisplaySize.x, height = app.px(look::menu);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {app.px(8), (height - ImGui::GetFontSize()) / 2});
    begin_bar(app, "##menu", {0, 0}, {width, height}, ImGuiWindowFlags_MenuBar);
    if (ImGui::BeginMenuBar()) {
        ImGui::SetCursorPosX(app.px(8));
        draw_menus(app);
        ImGui::EndMenuBar();
    }
    ImGui::PopStyleVar();
    ImGui::PushClipRect({0, 0}, {width, height}, false);
    draw_title(app, width);
    const float y = (height - app.px(26)) / 2;
    for (const auto& [label, symbol, x] :
         {std::tuple{"Undo", icon::undo, 166.0}, {"Redo", icon::redo, 136.0}}) {
        const Command& command = find_command(label);
        ImGui::SetCursorPos({width - app.px(x), y});
        const std::string tip = fmt::format("{} ({})", label, to_text(command.shortcut));
        if (icon_button(app, label, symbol, tip.c_str(), false, reason(app.editor, command)))
            run(app.editor, command);
    }
    ImGui::SetCursorPos({width - app.px(96), (height - app.px(22)) / 2});
    if (accent_button(app, "Export", {app.px(84), app.px(22)}, icon::export_, has_picture(app.editor)))
        run(app.editor, find_command("Export…"));
    tooltip(has_picture(app.editor) ? "Export the deformed picture (Ctrl+E)" : "Open a picture first");
    ImGui::GetWindowDrawList()->AddLine({0, height - 1}, {width, height - 1}, app.theme.line);
    ImGui::PopClipRect();
    ImGui::End();
}

namespace {

/// A button of the tool strip: 36 pixels square, marked at the left where it is the present tool.
bool strip_button(App& app, const char* id, const char* symbol, float y, bool on, bool is_switch,
                  const std::string& tip) {
    ImGui::SetCursorPos({app.px(6), y});
    const bool clicked = ImGui::InvisibleButton(id, {app.px(36), app.px(36)});
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const bool hovered = ImGui::IsItemHovered();
    if ((on && !is_switch) || hovered) list->AddRectFilled(from, to, app.theme.raised, app.px(6));
    if (on && !is_switch)
        list->AddRectFilled(from, {from.x + app.px(3), to.y}, app.theme.accent, app.px(1.5));
    const ImU32 colour = is_switch && on ? app.theme.accent
                         : on || hovered ? app.theme.text
                                         : app.theme.muted;
    draw_icon(app.fonts.icons, {(from.x + to.x) / 2, (from.y + to.y) / 2}, colour, symbol);
    tooltip(tip.c_str());
    return clicked;
}

const char* tool_icon(std::string_view name) {
    return name == "select"  ? icon::select
           : name == "add"   ? icon::add
           : name == "brush" ? icon::brush
           : name == "pin"   ? icon::pin
                             : icon::zoom;
}

}  // namespace

void draw_tool_strip(App& app) {
    const float top = app.px(look::menu), height = ImGui::GetIO().DisplaySize.y - top - app.px(look::status);
    const float width = app.px(look::tools);
    begin_bar(app, "##tools", {0, top}, {width, height});
    float y = app.px(9);
    for (const Tool& tool : tools()) {
        const std::string tip = fmt::format("{} ({})", tool.label, tool.key);
        if (strip_button(app, std::string(tool.name).c_str(), tool_icon(tool.name), y,
                         app.editor.tool == &tool, false, tip))
            choose_tool(app.editor, tool);
        y += app.px(44);
    }
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddLine({app.px(10), top + y + app.px(4)}, {app.px(38), top + y + app.px(4)}, app.theme.line);
    y += app.px(14);
    for (const auto& [label, symbol] : {std::pair{"Show probes", icon::eye},
                                        {"Show mesh", icon::grid},
                                        {"Show the chosen probe's", icon::palette}}) {
        const Command& command = find_command(label);
        const bool on = command.on(app.editor);
        const char* shown = !on && command.label == "Show probes" ? icon::eye_off : symbol;
        if (strip_button(
                app, label, shown, y, on, true,
                fmt::format("{} ({})", symbol == icon::palette ? "Show the chosen probe's weights" : label,
                            to_text(command.shortcut))))
            run(app.editor, command);
        y += app.px(40);
    }
    list->AddLine({width - 1, top}, {width - 1, top + height}, app.theme.line);
    ImGui::End();
}

namespace {

/// "7,812": with a comma every three digits.
std::string grouped(std::size_t number) {
    std::string digits = std::to_string(number);
    for (auto at = std::ptrdiff_t(digits.size()) - 3; at > 0; at -= 3) digits.insert(std::size_t(at), ",");
    return digits;
}

std::string facts(const App& app) {
    const Editor& editor = app.editor;
    if (!has_picture(editor)) return app.renderer_label;
    const Image& image = editor.document.picture->image;
    std::string text =
        fmt::format("{} × {} · {} vertices · {} · {}", image.width, image.height,
                    grouped(editor.deformation.now.size()), deform_facts(app), app.renderer_label);
    if (app.deform_job && ImGui::GetTime() - app.deform_job->since > 0.1)
        text = "working out the weights… · " + text;
    // Nobody counts what the shader could not blend.
    if (editor.deformation.cancelled > 0 && !is_shaded(app))
        text = fmt::format("no blend at {} vertices · {}", grouped(editor.deformation.cancelled), text);
    return text;
}

/// The image pixel under the pointer and the colour of the picture there.
void draw_pixel(App& app, float x, float y, ImDrawList* list) {
    const Editor& editor = app.editor;
    if (!editor.pointer) return;
    const glm::dvec2 point = to_image(editor.view, *editor.pointer);
    const std::string place = fmt::format("{:.0f}, {:.0f} px", std::floor(point.x), std::floor(point.y));
    list->AddText({x, y}, app.theme.muted, place.c_str());
    if (!app.under) return;
    const glm::dvec2 rest = rest_point(mesh_of(editor.deformation), *app.under);
    const Image& image = editor.document.picture->image;
    const auto within = [](double v, int size) { return std::clamp(int(std::floor(v)), 0, size - 1); };
    const auto rgba = pixel(image, within(rest.x, image.width), within(rest.y, image.height));
    const int shift = image.bits() - 8;
    x += app.px(96);
    const float middle = y + ImGui::GetFontSize() / 2;
    list->AddRectFilled({x, middle - app.px(5.5)}, {x + app.px(11), middle + app.px(5.5)},
                        IM_COL32(rgba[0] >> shift, rgba[1] >> shift, rgba[2] >> shift, 255), app.px(2));
    const std::string values = fmt::format("{} {} {} {}", rgba[0], rgba[1], rgba[2], rgba[3]);
    list->AddText({x + app.px(18), y}, app.theme.muted, values.c_str());
}

}  // namespace

void draw_status_bar(App& app) {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float height = app.px(look::status), top = display.y - height;
    begin_bar(app, "##status", {0, top}, {display.x, height});
    ImGui::PushFont(app.fonts.small);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddLine({0, top}, {display.x, top}, app.theme.line);
    const float y = std::round(top + (height - ImGui::GetFontSize()) / 2);
    if (has_picture(app.editor)) {
        const double percent = app.editor.view.zoom * 100;
        list->AddText({app.px(16), y}, app.theme.text,
                      fmt::format("{:.{}f} %", percent, percent < 10 ? 1 : 0).c_str());
        draw_pixel(app, app.px(76), y, list);
    }
    const std::string text = facts(app);
    const float left = std::round(display.x - app.px(16) - ImGui::CalcTextSize(text.c_str()).x);
    list->AddText({left, y}, app.theme.muted, text.c_str());
    ImGui::PopFont();
    ImGui::SetCursorScreenPos({left, top});
    ImGui::InvisibleButton("##facts", {display.x - app.px(16) - left, height});
    if (has_picture(app.editor)) tooltip(deform_explanation(app).c_str());
    ImGui::End();
}

void draw_makeshift(App& app) {
    draw_menu_bar(app);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::Begin("##makeshift", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::TextUnformatted("The picture cannot be shown now. It can be saved.");
    if (ImGui::Button("Show it again")) app.failed_frames = 0;
    ImGui::End();
}

}  // namespace probewarp
