// The bars around the canvas; the panel at the right has a file of its own, panel.cpp.
#include "gui/panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "editor/commands.h"
#include "editor/tools.h"
#include "gui/actions.h"
#include "gui/app.h"
#include "gui/shown_text.h"
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

/// Returns where they end, window pixels.
float draw_menus(App& app) {
    std::string_view open_menu;
    bool shown = false;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {app.px(10), app.px(8)});
    // Where the window is narrow the menus move together, so that the name has room; where it is low their
    // rows do, so that the longest menu has room below the bar.
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const bool narrow = display.x < app.px(800), low = display.y < app.px(600);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {app.px(narrow ? 6 : 18), app.px(low ? 5 : 9)});
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
    const float end = ImGui::GetCursorScreenPos().x;
    ImGui::PopStyleVar(2);
    return end;
}

/// In the middle of the window, or of what is free between `left` and `right`, shortened to that.
void draw_title(App& app, float left, float right) {
    const std::string name = document_name(app);
    const float room = right - left;
    if (name.empty() || room < app.px(48)) return;
    const bool saved = is_saved(app.editor.history) && !app.editor.gesture;
    const std::string title = saved ? name : "●  " + name;
    const float text = std::min(room, ImGui::CalcTextSize(title.c_str()).x);
    const float middle = (ImGui::GetIO().DisplaySize.x - text) / 2;
    draw_shown(app,
               {std::round(std::clamp(middle, left, right - text)),
                std::round((app.px(look::menu) - ImGui::GetFontSize()) / 2)},
               text + 1, app.theme.muted, title);
}

}  // namespace

void draw_menu_bar(App& app) {
    const float width = ImGui::GetIO().DisplaySize.x, height = app.px(look::menu);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {app.px(8), (height - ImGui::GetFontSize()) / 2});
    begin_bar(app, "##menu", {0, 0}, {width, height}, ImGuiWindowFlags_MenuBar);
    float menus_end = 0;
    if (ImGui::BeginMenuBar()) {
        ImGui::SetCursorPosX(app.px(8));
        menus_end = draw_menus(app);
        ImGui::EndMenuBar();
    }
    ImGui::PopStyleVar();
    ImGui::PushClipRect({0, 0}, {width, height}, false);
    draw_title(app, menus_end + app.px(8), width - app.px(166 + 12));
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

/// "285 folded · 2 cancelled"; empty where the deformation is sound, or the shader's, which nobody counts.
std::string deformation_warning(const App& app) {
    if (!has_picture(app.editor) || is_shaded(app)) return {};
    const std::size_t folded = app.folds.value_or(0), cancelled = app.editor.deformation.cancelled;
    std::string text = folded > 0 ? fmt::format("{} folded", grouped(folded)) : "";
    if (cancelled > 0) text += fmt::format("{}{} cancelled", text.empty() ? "" : " · ", grouped(cancelled));
    return text;
}

constexpr const char* warning_explanation =
    "Folded: triangles that lie turned over, so that the picture covers itself. View, Show folded\n"
    "triangles marks them. Cancelled: vertices for which the blend has no answer, so that they follow\n"
    "their heaviest probe.";

/// A part of the status bar's right.
struct Fact {
    std::string text;
    ImU32 ink;
};

/// From left to right: what one should not miss first. What there is no room for goes from the end.
std::vector<Fact> facts(App& app) {
    const Editor& editor = app.editor;
    const ImU32 ink = app.theme.muted;
    if (!has_picture(editor)) return {{shown(app, app.renderer_label), ink}};
    std::vector<Fact> facts;
    if (std::string warning = deformation_warning(app); !warning.empty())
        facts.push_back({std::move(warning), app.theme.warning});
    if (app.deform_job && ImGui::GetTime() - app.deform_job->since > 0.1)
        facts.push_back({"working out the weights…", ink});
    const Image& image = editor.document.picture->image;
    facts.push_back({fmt::format("{} × {}", image.width, image.height), ink});
    facts.push_back({fmt::format("{} vertices", grouped(editor.deformation.now.size())), ink});
    facts.push_back({deform_facts(app), ink});
    facts.push_back({shown(app, app.renderer_label), ink});
    return facts;
}

constexpr const char* between_facts = " · ";

float width_of(const std::vector<Fact>& facts) {
    float width = 0;
    for (const Fact& fact : facts)
        width += ImGui::CalcTextSize(fact.text.c_str()).x +
                 (&fact == facts.data() ? 0 : ImGui::CalcTextSize(between_facts).x);
    return width;
}

/// Draws what fits between `left` and `right`, up to the right edge.
void draw_facts(App& app, float left, float right, float y) {
    std::vector<Fact> fitting = facts(app);
    std::string all;
    for (const Fact& fact : fitting) all += (all.empty() ? "" : between_facts) + fact.text;
    while (fitting.size() > 1 && width_of(fitting) > right - left) fitting.pop_back();
    float x = std::round(std::max(left, right - width_of(fitting)));
    const float beginning = x;
    ImDrawList* list = ImGui::GetWindowDrawList();
    for (const Fact& fact : fitting) {
        if (x > beginning) {
            list->AddText({x, y}, app.theme.muted, between_facts);
            x += ImGui::CalcTextSize(between_facts).x;
        }
        const std::string text = shortened(fact.text, right - x + 1, ImGui::GetFont());
        list->AddText({x, y}, fact.ink, text.c_str());
        x += ImGui::CalcTextSize(text.c_str()).x;
    }
    if (x <= beginning) return;
    ImGui::SetCursorScreenPos({beginning, ImGui::GetWindowPos().y});
    ImGui::InvisibleButton("##facts", {x - beginning, app.px(look::status)});
    if (!has_picture(app.editor)) return;
    if (!deformation_warning(app).empty()) all += fmt::format("\n{}", warning_explanation);
    tooltip((all + "\n" + deform_explanation(app)).c_str());
}

/// How wide the place and the colour under the pointer get, so that nothing jumps when they change.
struct PixelWidths {
    float place, colour;
};

PixelWidths pixel_widths(const App& app) {
    const Image& image = app.editor.document.picture->image;
    const std::string place = fmt::format("−{0}, −{0} px", std::max(image.width, image.height));
    const char* colour = image.bits() == 8 ? "255 255 255 255" : "65535 65535 65535 65535";
    return {ImGui::CalcTextSize(place.c_str()).x + app.px(14),
            ImGui::CalcTextSize(colour).x + app.px(18 + 14)};
}

/// The image pixel under the pointer and the colour of the picture there.
void draw_pixel(App& app, float x, float y, const PixelWidths& widths) {
    const Editor& editor = app.editor;
    if (!editor.pointer) return;
    const glm::dvec2 point = to_image(editor.view, *editor.pointer);
    draw_shown(app, {x, y}, widths.place - app.px(14), app.theme.muted,
               fmt::format("{:.0f}, {:.0f} px", std::floor(point.x), std::floor(point.y)));
    if (!app.under) return;
    const glm::dvec2 rest = rest_point(mesh_of(editor.deformation), *app.under);
    const Image& image = editor.document.picture->image;
    const auto within = [](double v, int size) { return std::clamp(int(std::floor(v)), 0, size - 1); };
    const auto rgba = pixel(image, within(rest.x, image.width), within(rest.y, image.height));
    const int shift = image.bits() - 8;
    x += widths.place;
    const float middle = y + ImGui::GetFontSize() / 2;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({x, middle - app.px(5.5)}, {x + app.px(11), middle + app.px(5.5)},
                        IM_COL32(rgba[0] >> shift, rgba[1] >> shift, rgba[2] >> shift, 255), app.px(2));
    const std::string values = fmt::format("{} {} {} {}", rgba[0], rgba[1], rgba[2], rgba[3]);
    list->AddText({x + app.px(18), y}, app.theme.muted, values.c_str());
}

/// The zoom and the pixel under the pointer. Returns where they may end.
float draw_view_facts(App& app, float y) {
    const float left = app.px(16);
    if (!has_picture(app.editor)) return left;
    const double percent = app.editor.view.zoom * 100;
    ImGui::GetWindowDrawList()->AddText({left, y}, app.theme.text,
                                        fmt::format("{:.{}f} %", percent, percent < 10 ? 1 : 0).c_str());
    const PixelWidths widths = pixel_widths(app);
    draw_pixel(app, left + app.px(60), y, widths);
    return left + app.px(60) + widths.place + widths.colour;
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
    draw_facts(app, draw_view_facts(app, y), display.x - app.px(16), y);
    ImGui::PopFont();
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
