#include "gui/widgets.h"

#include <algorithm>
#include <cmath>

#include "gui/shown_text.h"

namespace probewarp {

void draw_icon(ImFont* font, ImVec2 middle, ImU32 colour, const char* symbol) {
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, FLT_MAX, 0, symbol);
    ImGui::GetWindowDrawList()->AddText(
        font, font->FontSize, {std::round(middle.x - size.x / 2), std::round(middle.y - size.y / 2)}, colour,
        symbol);
}

void tooltip(const char* text) {
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) || !*text) return;
    show_tooltip(text);
}

void show_tooltip(const std::string& text) {
    const float size = ImGui::GetFontSize(), room = ImGui::GetIO().DisplaySize.x;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {size * 0.65f, size * 0.4f});
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(std::min(size * 28, room - size * 3));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

void list_tooltip(const App& app, const std::string& text) {
    if (!ImGui::IsItemHovered() || text.empty()) return;
    ImGui::SetNextWindowPos({ImGui::GetWindowPos().x - app.px(8), ImGui::GetItemRectMin().y},
                            ImGuiCond_Always, {1, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {app.px(10), app.px(6)});
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(app.px(280));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

bool icon_button(App& app, const char* id, const char* symbol, const char* tip, bool on,
                 const std::string& why_not) {
    const float side = app.px(26);
    const bool clicked = ImGui::InvisibleButton(id, {side, side}) && why_not.empty();
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    const bool hovered = ImGui::IsItemHovered() && why_not.empty();
    if (hovered) ImGui::GetWindowDrawList()->AddRectFilled(from, to, app.theme.over, app.px(5));
    const ImU32 colour = !why_not.empty() ? app.theme.dim
                         : on             ? app.theme.accent
                         : hovered        ? app.theme.text
                                          : app.theme.muted;
    draw_icon(app.fonts.icons_small, {(from.x + to.x) / 2, (from.y + to.y) / 2},
              faded(colour, ImGui::GetStyle().Alpha), symbol);
    tooltip(why_not.empty() ? tip : why_not.c_str());
    return clicked;
}

bool accent_button(App& app, const char* label, ImVec2 size, const char* symbol, bool enabled) {
    ImGui::PushID(label);
    const bool clicked = ImGui::InvisibleButton("##accent", size) && enabled;
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    const bool lit = ImGui::IsItemHovered() && enabled;
    ImU32 fill = enabled ? app.theme.accent : app.theme.raised;
    if (lit) fill = ImGui::IsItemActive() ? app.theme.accent_pressed : app.theme.accent_over;
    const ImU32 ink = enabled ? app.theme.on_accent : app.theme.dim;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(from, to, fill, app.px(5));
    if (ImGui::IsItemFocused() && ImGui::GetIO().NavVisible)
        list->AddRect(from, to, app.theme.text, app.px(5), 0, app.px(2));
    const ImVec2 text = app.fonts.strong->CalcTextSizeA(app.fonts.strong->FontSize, FLT_MAX, 0, label);
    const float icon_room = symbol ? app.px(20) : 0;
    const float left = from.x + (size.x - text.x - icon_room) / 2;
    const float middle = (from.y + to.y) / 2;
    if (symbol) draw_icon(app.fonts.icons_small, {left + app.px(7), middle}, ink, symbol);
    list->AddText(app.fonts.strong, app.fonts.strong->FontSize,
                  {std::round(left + icon_room), std::round(middle - text.y / 2)}, ink, label);
    ImGui::PopID();
    return clicked;
}

bool section(App& app, const char* id, const char* title, bool& open, bool* add) {
    ImGui::PushID(id);
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = app.px(24);
    if (ImGui::InvisibleButton("##fold", {width - (add ? app.px(30) : 0), height})) open = !open;
    const ImU32 chevron = ImGui::IsItemHovered() ? app.theme.text : app.theme.muted;
    draw_icon(app.fonts.icons_small, {from.x + app.px(4), from.y + height / 2}, chevron,
              open ? icon::down : icon::right);
    ImGui::PushFont(app.fonts.strong);
    draw_shown(app, {from.x + app.px(18), std::round(from.y + (height - ImGui::GetFontSize()) / 2)},
               width - app.px(add ? 48 : 18), app.theme.text, title);
    ImGui::PopFont();
    if (add) {
        ImGui::SetCursorScreenPos({from.x + width - app.px(22), from.y - app.px(1)});
        *add = icon_button(app, "##add", icon::plus, "Add a probe in the middle of the picture");
    }
    ImGui::PopID();
    return open;
}

void row_label(App& app, const char* text, float width) {
    const ImVec2 at = ImGui::GetCursorPos();
    ImGui::SetCursorPos({at.x, at.y + (app.px(look::field) - ImGui::GetTextLineHeight()) / 2});
    ImGui::PushStyleColor(ImGuiCol_Text, app.theme.muted);
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
    ImGui::SetCursorPos({at.x + app.px(width), at.y});
}

bool slim_slider(App& app, const char* id, double& part, float width) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = app.px(look::field);
    ImGui::InvisibleButton(id, {width, height});
    const bool held = ImGui::IsItemActive();
    if (held) part = std::clamp(double((ImGui::GetIO().MousePos.x - at.x) / width), 0.0, 1.0);
    const float middle = at.y + height / 2, grip = at.x + float(part) * width;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({at.x, middle - app.px(2)}, {at.x + width, middle + app.px(2)}, app.theme.line,
                        app.px(2));
    list->AddRectFilled({at.x, middle - app.px(2)}, {grip, middle + app.px(2)}, app.theme.accent, app.px(2));
    list->AddCircleFilled({grip, middle}, app.px(7), IM_COL32_WHITE, 24);
    list->AddCircle({grip, middle}, app.px(7), app.theme.line, 24);
    return held;
}

bool slider_field(App& app, const char* id, double& value, const char* unit, float width, double least,
                  double most) {
    const bool coarse = most > 10;
    ImGui::PushID(id);
    double part = (value - least) / (most - least);
    const bool moved = slim_slider(app, "##track", part, width - app.px(look::slider_number + 8));
    if (moved) value = least + part * (most - least);
    ImGui::SameLine(0, app.px(8));
    const bool typed = number_field(app, "##number", value,
                                    {.unit = unit,
                                     .measure = *unit == '%' ? NumberUnit::percent : NumberUnit::none,
                                     .width = app.px(look::slider_number),
                                     .step = coarse ? 0.5 : 0.005,
                                     .least = least,
                                     .most = most,
                                     .decimals = coarse ? 0 : 2,
                                     .bare = true});
    ImGui::PopID();
    return moved || typed;
}

bool check_box(App& app, const char* label, bool& on, bool first) {
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, std::max(1.0f, std::floor(app.px(1))));
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {app.px(3), app.px(3)});
    if (first) ImGui::SetCursorPosY(ImGui::GetCursorPosY() + app.px(3));
    const bool clicked = ImGui::Checkbox(label, &on);
    ImGui::PopStyleVar(2);
    return clicked;
}

void begin_section_gap(App& app) {
    ImGui::Dummy({0, app.px(4)});
    ImGui::Separator();
    ImGui::Dummy({0, app.px(4)});
}

bool begin_combo(App& app, const char* id, const char* shown, float width) {
    ImGui::SetNextItemWidth(width);
    ImGui::PushStyleColor(ImGuiCol_FrameBg, app.theme.raised);
    ImGui::PushStyleColor(ImGuiCol_FrameBgHovered, app.theme.over);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->ChannelsSplit(2);  // the chevron lies over the frame that BeginCombo draws
    list->ChannelsSetCurrent(1);
    draw_icon(app.fonts.icons_small, {at.x + width - app.px(14), at.y + ImGui::GetFrameHeight() / 2},
              app.theme.muted, icon::down);
    list->ChannelsSetCurrent(0);
    const bool open =
        ImGui::BeginCombo(id, shown, ImGuiComboFlags_NoArrowButton | ImGuiComboFlags_HeightLarge);
    list->ChannelsMerge();
    ImGui::PopStyleColor(2);
    return open;
}

}  // namespace probewarp
