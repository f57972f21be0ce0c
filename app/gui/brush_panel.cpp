#include "gui/brush_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "editor/painting.h"
#include "gui/app.h"
#include "gui/widgets.h"

namespace probewarp {

namespace {

struct ModeRow {
    BrushMode mode;
    const char *label, *tip;
};
constexpr std::array<ModeRow, 5> modes{
    {{BrushMode::replace, "Replace", "Paints the value"},
     {BrushMode::add, "Add", "Adds the value to what is there"},
     {BrushMode::subtract, "Subtract", "Takes the value from what is there"},
     {BrushMode::smooth, "Smooth", "Evens out what is there"},
     {BrushMode::erase, "Erase", "Back to the automatic weights"}}};

constexpr float label_width = 76;

void mode_combo(App& app) {
    Brush& brush = app.editor.brush;
    row_label(app, "Mode", label_width);
    const auto chosen =
        std::find_if(modes.begin(), modes.end(), [&](const ModeRow& m) { return m.mode == brush.mode; });
    if (!begin_combo(app, "##mode", chosen->label, ImGui::GetContentRegionAvail().x)) return;
    for (const ModeRow& row : modes) {
        if (ImGui::Selectable(row.label, row.mode == brush.mode)) brush.mode = row.mode;
        tooltip(row.tip);
    }
    ImGui::EndCombo();
}

void percent_row(App& app, const char* label, double& part, double least) {
    double percent = part * 100;
    row_label(app, label, label_width);
    ImGui::PushID(label);
    if (slider_field(app, "##percent", percent, "%", ImGui::GetContentRegionAvail().x, least, 100))
        part = percent / 100;
    ImGui::PopID();
}

void axis_fields(App& app) {
    MirrorAxis axis = mirror_axis(app.editor);
    double degrees = axis.angle * 180 / std::numbers::pi;
    row_label(app, "Axis", label_width);
    const float width = (ImGui::GetContentRegionAvail().x - app.px(8)) / 2;
    const bool moved = number_field(app, "##axis", axis.point.x,
                                    {.unit = "x",
                                     .measure = NumberUnit::pixels,
                                     .width = width,
                                     .step = 0.5,
                                     .least = -1e6,
                                     .most = 1e6});
    ImGui::SameLine(0, app.px(8));
    const bool turned = number_field(
        app, "##angle", degrees,
        {.unit = "°", .measure = NumberUnit::degrees, .width = width, .step = 0.5, .least = -80, .most = 80});
    axis.angle = degrees * std::numbers::pi / 180;
    if (moved || turned) app.editor.axis = axis;
}

}  // namespace

void draw_brush_section(App& app) {
    Editor& editor = app.editor;
    const bool stiff = paints_stiffness(editor);
    begin_section_gap(app);
    if (!section(app, "brush", stiff ? "Stiffness brush" : "Brush", app.brush_open)) return;
    Brush& brush = editor.brush;
    mode_combo(app);
    if (brush.mode != BrushMode::smooth && brush.mode != BrushMode::erase)
        percent_row(app, "Value", brush.value, 0);
    row_label(app, "Size", label_width);
    number_field(app, "##size", brush.radius,
                 {.unit = "px",
                  .measure = NumberUnit::pixels,
                  .width = ImGui::GetContentRegionAvail().x,
                  .step = 0.5,
                  .least = min_brush_radius,
                  .most = max_brush_radius});
    percent_row(app, "Strength", brush.strength, 1);
    percent_row(app, "Hardness", brush.hardness, 0);
    percent_row(app, "Spacing", brush.spacing, 1);
    row_label(app, "", label_width);
    check_box(app, "Build up", brush.build_up);
    tooltip("Dabs of one stroke pile up");
    ImGui::SameLine(0, app.px(12));
    check_box(app, "Mirror", editor.mirror, false);
    tooltip("Strokes are painted on both sides of the axis (X), onto the probe that mirrors the chosen one");
    if (editor.mirror) axis_fields(app);
}

namespace {

/// The colours from 0 to 1, with a mark at `value` where it is not negative.
void draw_scale(App& app, double value) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = app.px(10);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float step = width / float(heat_colours.size() - 1);
    for (std::size_t i = 0; i + 1 < heat_colours.size(); ++i) {
        const ImU32 from = to_u32(heat_colours[i]), to = to_u32(heat_colours[i + 1]);
        list->AddRectFilledMultiColor({at.x + step * float(i), at.y},
                                      {at.x + step * float(i + 1), at.y + height}, from, to, to, from);
    }
    if (value >= 0) {
        const float x = std::round(at.x + width * float(std::clamp(value, 0.0, 1.0)));
        list->AddRectFilled({x - app.px(2), at.y - app.px(2)}, {x + app.px(2), at.y + height + app.px(2)},
                            IM_COL32(0x0d, 0x0f, 0x12, 255), app.px(2));
        list->AddRectFilled({x - app.px(1), at.y - app.px(1)}, {x + app.px(1), at.y + height + app.px(1)},
                            IM_COL32_WHITE, app.px(1));
    }
    ImGui::Dummy({width, height + app.px(2)});
    ImGui::PushFont(app.fonts.small);
    const ImVec2 line = ImGui::GetCursorScreenPos();
    const std::string under = value >= 0 ? fmt::format("under the cursor {:.2f}", value) : "";
    const ImVec2 size = ImGui::CalcTextSize(under.c_str());
    list->AddText(line, app.theme.muted, "0");
    list->AddText({std::round(line.x + (width - size.x) / 2), line.y}, app.theme.muted, under.c_str());
    list->AddText({line.x + width - ImGui::CalcTextSize("1").x, line.y}, app.theme.muted, "1");
    ImGui::Dummy({width, ImGui::GetFontSize() + app.px(4)});
    ImGui::PopFont();
}

void shown_combo(App& app) {
    Editor& editor = app.editor;
    const std::array<const char*, 3> labels{"Hidden", "The chosen probe's", "All, in their colours"};
    row_label(app, "Shown", label_width);
    if (begin_combo(app, "##shown", labels[std::size_t(editor.shown_weights)],
                    ImGui::GetContentRegionAvail().x)) {
        for (const ShownWeights shown : {ShownWeights::none, ShownWeights::chosen, ShownWeights::all})
            if (ImGui::Selectable(labels[std::size_t(shown)], shown == editor.shown_weights)) {
                editor.shown_weights = shown;
                editor.shown_by_brush = false;
            }
        ImGui::EndCombo();
    }
}

}  // namespace

void draw_weights_section(App& app) {
    Editor& editor = app.editor;
    const Probe* probe = find_probe(editor.document, editor.selected);
    if (editor.document.probes.empty()) return;
    begin_section_gap(app);
    const std::string title = probe ? "Weights of " + probe->name : "Weights";
    if (!section(app, "weights", title.c_str(), app.weights_open)) return;
    double value = -1;
    if (probe && app.shares.size() == editor.document.probes.size())
        value = app.shares[std::size_t(probe - editor.document.probes.data())];
    draw_scale(app, value);
    shown_combo(app);
    if (editor.shown_weights == ShownWeights::none) return;
    double opacity = double(editor.weights_opacity) * 100;
    row_label(app, "Opacity", label_width);
    if (slider_field(app, "##opacity", opacity, "%", ImGui::GetContentRegionAvail().x, 0, 100))
        editor.weights_opacity = float(opacity / 100);
    row_label(app, "", label_width);
    check_box(app, "Iso-lines", editor.iso_lines);
    tooltip("A line at every tenth of the weight (I)");
}

}  // namespace probewarp
