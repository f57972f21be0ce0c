#include "gui/theme.h"

#include <algorithm>
#include <cmath>

namespace probewarp {

namespace {

constexpr ImU32 rgb(unsigned hex) { return IM_COL32(hex >> 16 & 0xff, hex >> 8 & 0xff, hex & 0xff, 0xff); }

glm::vec3 to_vec3(ImU32 colour) {
    const ImVec4 c = ImGui::ColorConvertU32ToFloat4(colour);
    return {c.x, c.y, c.z};
}

}  // namespace

const Theme& dark_theme() {
    static constexpr Theme theme{.is_light = false,
                                 .canvas = rgb(0x17191d),
                                 .panel = rgb(0x212429),
                                 .raised = rgb(0x2b2f36),
                                 .line = rgb(0x343942),
                                 .over = rgb(0x3d434d),
                                 .text = rgb(0xdfe3ea),
                                 .soft = rgb(0xc3c9d3),
                                 .muted = rgb(0x9aa2b0),
                                 .dim = rgb(0x747c8a),
                                 .accent = rgb(0x5aa9ff),
                                 .accent_over = rgb(0x7bbaff),
                                 .accent_pressed = rgb(0x3f93ee),
                                 .on_accent = rgb(0x0c1420),
                                 .warning = rgb(0xff9d5c),
                                 .check_light = rgb(0x383c44),
                                 .check_dark = rgb(0x2a2d33)};
    return theme;
}

const Theme& light_theme() {
    static constexpr Theme theme{.is_light = true,
                                 .canvas = rgb(0xf4f5f7),
                                 .panel = rgb(0xffffff),
                                 .raised = rgb(0xe9ebef),
                                 .line = rgb(0xd5d9e0),
                                 .over = rgb(0xdcdfe5),
                                 .text = rgb(0x1d2128),
                                 .soft = rgb(0x363c46),
                                 .muted = rgb(0x596373),
                                 .dim = rgb(0x7f8794),
                                 .accent = rgb(0x0a62ba),
                                 .accent_over = rgb(0x1f74cf),
                                 .accent_pressed = rgb(0x084c93),
                                 .on_accent = rgb(0xffffff),
                                 .warning = rgb(0xa84400),
                                 .check_light = rgb(0xffffff),
                                 .check_dark = rgb(0xe3e6eb)};
    return theme;
}

namespace {

/// WCAG 2.1, "relative luminance".
double luminance(ImU32 colour) {
    const auto linear = [](float v) {
        return v <= 0.04045f ? double(v) / 12.92 : std::pow((double(v) + 0.055) / 1.055, 2.4);
    };
    const ImVec4 c = ImGui::ColorConvertU32ToFloat4(colour);
    return 0.2126 * linear(c.x) + 0.7152 * linear(c.y) + 0.0722 * linear(c.z);
}

}  // namespace

double contrast(ImU32 one, ImU32 other) {
    const auto [darker, lighter] = std::minmax({luminance(one), luminance(other)});
    return (lighter + 0.05) / (darker + 0.05);
}

ImU32 faded(ImU32 colour, float part) {
    const float alpha = float(colour >> IM_COL32_A_SHIFT & 0xff) * part;
    return (colour & ~IM_COL32_A_MASK) | (ImU32(alpha + 0.5f) << IM_COL32_A_SHIFT);
}

ImU32 mixed(ImU32 from, ImU32 to, float part) {
    const ImVec4 a = ImGui::ColorConvertU32ToFloat4(from), b = ImGui::ColorConvertU32ToFloat4(to);
    const auto mix = [part](float x, float y) { return x + part * (y - x); };
    return ImGui::ColorConvertFloat4ToU32({mix(a.x, b.x), mix(a.y, b.y), mix(a.z, b.z), mix(a.w, b.w)});
}

ImU32 to_u32(Colour colour, float alpha) { return faded(IM_COL32(colour.r, colour.g, colour.b, 255), alpha); }

DisplayColours display_colours(const Theme& theme) {
    DisplayColours colours;
    colours.canvas = to_vec3(theme.canvas);
    colours.light = to_vec3(theme.check_light);
    colours.dark = to_vec3(theme.check_dark);
    colours.lines = theme.is_light ? glm::vec4(0, 0, 0, 0.25f) : glm::vec4(1, 1, 1, 0.2f);
    return colours;
}

void apply_theme(const Theme& theme, float scale) {
    ImGuiStyle style;
    style.WindowPadding = {16, 12};
    style.FramePadding = {8, 5};
    style.ItemSpacing = {8, 6};
    style.ItemInnerSpacing = {8, 6};
    style.WindowRounding = style.PopupRounding = 8;
    style.FrameRounding = style.GrabRounding = style.ChildRounding = 5;
    style.ScrollbarRounding = 5;
    style.ScrollbarSize = 10;
    style.GrabMinSize = 14;
    style.WindowBorderSize = style.PopupBorderSize = 1;
    style.FrameBorderSize = 0;
    style.DisabledAlpha = disabled_opacity;
    style.WindowMenuButtonPosition = ImGuiDir_None;
    style.ScaleAllSizes(scale);

    const auto set = [&style](ImGuiCol which, ImU32 colour) {
        style.Colors[which] = ImGui::ColorConvertU32ToFloat4(colour);
    };
    set(ImGuiCol_Text, theme.text);
    set(ImGuiCol_TextDisabled, theme.muted);
    set(ImGuiCol_WindowBg, theme.panel);
    set(ImGuiCol_ChildBg, IM_COL32_BLACK_TRANS);
    set(ImGuiCol_PopupBg, theme.panel);
    set(ImGuiCol_MenuBarBg, theme.panel);
    set(ImGuiCol_Border, theme.line);
    set(ImGuiCol_BorderShadow, IM_COL32_BLACK_TRANS);
    set(ImGuiCol_FrameBg, theme.canvas);
    set(ImGuiCol_FrameBgHovered, theme.raised);
    set(ImGuiCol_FrameBgActive, theme.raised);
    set(ImGuiCol_TitleBg, theme.panel);
    set(ImGuiCol_TitleBgActive, theme.panel);
    set(ImGuiCol_Button, theme.raised);
    set(ImGuiCol_ButtonHovered, theme.over);
    set(ImGuiCol_ButtonActive, theme.line);
    set(ImGuiCol_Header, theme.raised);
    set(ImGuiCol_HeaderHovered, theme.raised);
    set(ImGuiCol_HeaderActive, theme.line);
    set(ImGuiCol_CheckMark, theme.accent);
    set(ImGuiCol_SliderGrab, theme.accent);
    set(ImGuiCol_SliderGrabActive, theme.accent);
    set(ImGuiCol_Separator, theme.line);
    set(ImGuiCol_ScrollbarBg, IM_COL32_BLACK_TRANS);
    set(ImGuiCol_ScrollbarGrab, theme.over);
    set(ImGuiCol_ScrollbarGrabHovered, theme.muted);
    set(ImGuiCol_ScrollbarGrabActive, theme.muted);
    set(ImGuiCol_TextSelectedBg, faded(theme.accent, 0.4f));
    set(ImGuiCol_NavHighlight, faded(theme.accent, 0.7f));
    set(ImGuiCol_PlotHistogram, theme.accent);
    set(ImGuiCol_ModalWindowDimBg, faded(theme.canvas, 0.6f));
    ImGui::GetStyle() = style;
}

}  // namespace probewarp
