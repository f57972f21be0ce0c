// The panel at the right: the list of probes, the chosen probe's numbers, the deformation.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "editor/commands.h"
#include "editor/comparison.h"
#include "editor/painting.h"
#include "gui/app.h"
#include "gui/brush_panel.h"
#include "gui/panels.h"
#include "gui/shown_text.h"
#include "gui/widgets.h"

namespace probewarp {

namespace {

constexpr std::size_t most_rows = 8;  // of the list of probes; more scroll
constexpr double farthest = 1e6;      // of a typed coordinate, image pixels

/// Call after a field of the panel: what it does until it is left is one step of the history.
void is_step(App& app, const std::string& label) {
    if (!ImGui::IsItemActive() || (app.editor.gesture && app.field == ImGui::GetItemID())) return;
    if (app.editor.gesture) end_field(app.editor, app.field_label);  // from one field straight into another
    begin_field(app.editor);
    app.field = ImGui::GetItemID();
    app.field_label = label;
}

void edit_at_once(App& app, const std::string& label) { commit(app.editor, label); }

/// `room`: for the name, pixels.
void draw_name(App& app, Probe& probe, ImVec2 at, float room, bool chosen) {
    if (app.renaming != probe.id) {
        const float y = std::round(at.y + (app.px(look::field) - ImGui::GetFontSize()) / 2);
        draw_shown(app, {at.x + app.px(42), y}, room, chosen ? app.theme.text : app.theme.soft, probe.name);
        return;
    }
    ImGui::SetCursorScreenPos({at.x + app.px(36), at.y});
    ImGui::SetNextItemWidth(app.px(170));
    const bool first = !ImGui::IsAnyItemActive();
    if (first) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputText(
        "##rename", &app.new_name, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    app.glyphs.ask(app.new_name);
    if (!entered && !ImGui::IsItemDeactivated()) return;
    app.renaming = 0;
    if (app.new_name.empty() || app.new_name.size() > 200 || ImGui::IsKeyPressed(GLFW_KEY_ESCAPE)) return;
    probe.name = app.new_name;
    edit_at_once(app, "Rename probe");
}

/// The probe's weight under the cursor, ending at `at`.
void draw_share(App& app, const Probe& probe, ImVec2 at) {
    const auto& probes = app.editor.document.probes;
    if (app.shares.size() != probes.size() || app.renaming == probe.id) return;
    const std::string text = fmt::format("{:.2f}", app.shares[std::size_t(&probe - probes.data())]);
    ImFont* font = app.fonts.small;
    const float width = font->CalcTextSizeA(font->FontSize, FLT_MAX, 0, text.c_str()).x;
    ImGui::GetWindowDrawList()->AddText(
        font, font->FontSize, {at.x - width, std::round(at.y + (app.px(look::field) - font->FontSize) / 2)},
        app.theme.muted, text.c_str());
}

void draw_probe_row(App& app, Probe& probe) {
    Editor& editor = app.editor;
    ImGui::PushID(probe.id);
    const bool chosen = probe.id == editor.selected;
    const bool scrolled = app.editor.document.probes.size() > most_rows;
    const ImVec2 cursor = ImGui::GetCursorScreenPos();
    const ImVec2 at{cursor.x - app.px(8), cursor.y};
    const float width = ImGui::GetContentRegionAvail().x + app.px(scrolled ? 8 : 16),
                height = app.px(look::field);
    ImDrawList* list = ImGui::GetWindowDrawList();
    ImGui::SetCursorScreenPos(at);
    if (ImGui::InvisibleButton("##row", {width - app.px(66), height})) editor.selected = probe.id;
    const bool hovered = ImGui::IsItemHovered();
    if (hovered && ImGui::IsMouseDoubleClicked(0)) {
        app.renaming = probe.id;
        app.new_name = probe.name;
    }
    if (chosen || hovered)
        list->AddRectFilled(at, {at.x + width, at.y + height},
                            chosen ? app.theme.raised : faded(app.theme.raised, 0.5f), app.px(5));
    if (chosen) list->AddRectFilled(at, {at.x + app.px(3), at.y + height}, app.theme.accent, app.px(1.5));
    list->AddCircleFilled({at.x + app.px(18), at.y + height / 2}, app.px(6),
                          to_u32(probe.colour, probe.visible ? 1 : 0.4f), 24);
    draw_name(app, probe, at, width - app.px(42 + (app.shares.empty() ? 66 : 100)), chosen);
    draw_share(app, probe, {at.x + width - app.px(68), at.y});
    ImGui::SetCursorScreenPos({at.x + width - app.px(62), at.y});
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha,
                        probe.locked ? 1.0f : 0.5f);  // most are unlocked: they step back
    const bool toggled = icon_button(
        app, "##lock", probe.locked ? icon::lock : icon::lock_open,
        probe.locked ? "Unlock"
                     : "Lock: cannot be moved by hand, and keeps its share when others are painted");
    ImGui::PopStyleVar();
    if (toggled) {
        probe.locked = !probe.locked;
        edit_at_once(app, probe.locked ? "Lock" : "Unlock");
    }
    ImGui::SetCursorScreenPos({at.x + width - app.px(32), at.y});
    if (icon_button(app, "##eye", probe.visible ? icon::eye : icon::eye_off,
                    probe.visible ? "Hide (it still deforms)" : "Show")) {
        probe.visible = !probe.visible;
        edit_at_once(app, probe.visible ? "Show" : "Hide");
    }
    ImGui::SetCursorScreenPos({cursor.x, cursor.y + app.px(look::row)});
    ImGui::PopID();
}

/// Many probes scroll among themselves, so that what is below stays in reach.
void draw_probe_list(App& app) {
    auto& probes = app.editor.document.probes;
    const bool scrolls = probes.size() > most_rows;
    if (scrolls) {
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() - app.px(8));
        ImGui::BeginChild(
            "##list", {ImGui::GetContentRegionAvail().x + app.px(8), app.px(look::row) * (most_rows + 0.5f)});
        ImGui::Indent(app.px(8));
    }
    // A row may end a gesture or take a step, never add or remove a probe.
    for (Probe& probe : probes) {
        draw_probe_row(app, probe);
        if (!scrolls || probe.id != app.editor.selected || probe.id == app.listed) continue;
        ImGui::SetScrollHereY(0.5f);
        app.wake();
    }
    app.listed = app.editor.selected;
    if (scrolls) ImGui::EndChild();
}

void draw_probes(App& app) {
    bool add = false;
    if (section(app, "probes", "Probes", app.probes_open, &add)) {
        if (app.editor.document.probes.empty()) {
            ImGui::PushTextWrapPos(0);
            ImGui::TextDisabled("None yet. Double-click the picture to put one there.");
            ImGui::PopTextWrapPos();
        }
        draw_probe_list(app);
    }
    if (!add) return;
    const Image& image = app.editor.document.picture->image;
    const glm::dvec2 middle = to_canvas(app.editor.view, centre(image));
    if (put_probe(app.editor, middle) != 0) commit(app.editor, "Add probe");
}

/// The two fields of a place; a pair that is pasted into the first fills both.
void point_fields(App& app, const char* label, glm::dvec2& point, const Probe& probe) {
    row_label(app, label, 52);
    const float width = (ImGui::GetContentRegionAvail().x - app.px(8)) / 2;
    NumberField field{.unit = "x",
                      .measure = NumberUnit::pixels,
                      .width = width,
                      .step = 0.5,
                      .least = -farthest,
                      .most = farthest,
                      .partner = &point.y};
    ImGui::PushID(label);
    number_field(app, "##x", point.x, field);
    is_step(app, "Move " + probe.name);
    ImGui::SameLine(0, app.px(8));
    field.unit = "y";
    field.partner = nullptr;
    number_field(app, "##y", point.y, field);
    is_step(app, "Move " + probe.name);
    ImGui::PopID();
}

void turn_field(App& app, Probe& probe) {
    row_label(app, "Turn", 52);
    double degrees = probe.angle * 180 / std::numbers::pi;
    const int turns = int(std::trunc(degrees / 360));
    const std::string unit =
        turns == 0 ? "°" : fmt::format("{} × + {:.1f} °", turns, degrees - 360.0 * turns);
    if (number_field(app, "##turn", degrees,
                     {.unit = unit.c_str(),
                      .measure = NumberUnit::degrees,
                      .width = ImGui::GetContentRegionAvail().x,
                      .step = 0.5,
                      .least = -1e6,
                      .most = 1e6}))
        probe.angle = degrees * std::numbers::pi / 180;
    is_step(app, "Turn " + probe.name);
}

void draw_chosen_probe(App& app) {
    Probe* probe = selected_probe(app.editor);
    if (!probe) return;
    begin_section_gap(app);
    if (!section(app, "chosen", probe->name.c_str(), app.probe_open)) return;
    ImGui::BeginDisabled(probe->locked);
    point_fields(app, "Now", probe->now, *probe);
    point_fields(app, "Rest", probe->rest, *probe);
    turn_field(app, *probe);
    row_label(app, "Reach", 52);
    number_field(app, "##reach", probe->radius,
                 {.unit = "px",
                  .measure = NumberUnit::pixels,
                  .width = ImGui::GetContentRegionAvail().x,
                  .step = 0.5,
                  .least = 1,
                  .most = farthest});
    is_step(app, "Reach of " + probe->name);
    ImGui::EndDisabled();
    if (probe->locked && ImGui::IsWindowHovered() &&
        ImGui::IsMouseHoveringRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax()))
        ImGui::SetTooltip("The probe is locked");
}

/// One row of a table of methods; the names' labels are shown, the names are kept.
template <class Rows>
void method_combo(App& app, const char* label, std::string& name, const Rows& rows, const char* step) {
    row_label(app, label, 68);
    const auto chosen =
        std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.name == name; });
    ImGui::PushID(label);
    if (begin_combo(app, "##method", std::string(chosen->label).c_str(), ImGui::GetContentRegionAvail().x)) {
        for (const auto& row : rows) {
            if (ImGui::Selectable(std::string(row.label).c_str(), row.name == name)) {
                name = std::string(row.name);
                edit_at_once(app, step);
            }
            list_tooltip(app, std::string(row.when));
        }
        ImGui::EndCombo();
    }
    ImGui::PopID();
}

/// The blend beside the document's own: a way of looking, no step.
void comparison_combo(App& app) {
    row_label(app, "Beside", 68);
    const std::string chosen = app.editor.comparison ? app.editor.comparison->blend : std::string();
    const auto label = [](const BlendMethod* blend) { return std::string(blend ? blend->label : "Nothing"); };
    const float width = ImGui::GetContentRegionAvail().x;
    if (begin_combo(app, "##beside", label(find_blend_method(chosen)).c_str(), width)) {
        if (ImGui::Selectable("Nothing", chosen.empty())) compare_with(app.editor, "");
        for (const BlendMethod& blend : blend_methods()) {
            if (ImGui::Selectable(label(&blend).c_str(), blend.name == chosen))
                compare_with(app.editor, blend.name);
            list_tooltip(app, std::string(blend.when));
        }
        ImGui::EndCombo();
    }
    tooltip("Another blend of the same pose, at the right of a divider that one drags");
}

/// Takes the mesh's settings unless it would need more weights than fit; says so then.
void set_mesh(App& app, const MeshSettings& mesh) {
    Document changed = app.editor.document;
    changed.mesh = mesh;
    try {
        check_size(changed);
        app.editor.document.mesh = mesh;
    } catch (const Error& error) {
        app.editor.notice = error.what();
    }
}

/// Cubic, so that coarse meshes have room.
void mesh_slider(App& app) {
    row_label(app, "Mesh", 68);
    constexpr double least = 10, most = max_cells;
    MeshSettings mesh = app.editor.document.mesh;
    double part = std::cbrt(std::clamp((mesh.cells - least) / (most - least), 0.0, 1.0));
    const float number = app.px(look::slider_number);
    const bool moved =
        slim_slider(app, "##mesh", part, ImGui::GetContentRegionAvail().x - number - app.px(8));
    is_step(app, "Mesh density");
    tooltip("Cells along the picture's longer side");
    if (moved) mesh.cells = int(std::lround(least + (most - least) * part * part * part));
    ImGui::SameLine(0, app.px(8));
    double cells = mesh.cells;
    // Taken when it is whole: on the way to 1000 nobody wants meshes of 1 and 10 cells.
    const bool typed = number_field(app, "##cells", cells,
                                    {.width = number,
                                     .step = 0.5,
                                     .least = min_cells,
                                     .most = max_cells,
                                     .decimals = 0,
                                     .bare = true,
                                     .when_left = true});
    is_step(app, "Mesh density");
    if (typed) mesh.cells = int(std::lround(cells));
    if (moved || typed) set_mesh(app, mesh);
}

std::string islands_text(const Binding& binding) {
    const int lone = lone_islands(binding);
    if (binding.islands.count < 2) return {};
    std::string text = fmt::format("{} loose parts", binding.islands.count);
    if (lone == 1) text += "; one has no probe and follows the nearest";
    if (lone > 1) text += fmt::format("; {} have no probe and follow the nearest", lone);
    return text + ".";
}

void draw_deformation(App& app) {
    begin_section_gap(app);
    if (!section(app, "deformation", "Deformation", app.deformation_open)) return;
    method_combo(app, "Blend", app.editor.document.blend, blend_methods(), "Blend");
    comparison_combo(app);
    method_combo(app, "Weights", app.editor.document.weights.scheme, weight_schemes(), "Weights");
    mesh_slider(app);
    if (!app.editor.deformation.binding) return;
    const std::string islands = islands_text(*app.editor.deformation.binding);
    if (islands.empty()) return;
    ImGui::PushTextWrapPos(0);
    ImGui::TextDisabled("%s", islands.c_str());
    ImGui::PopTextWrapPos();
}

/// How the mesh follows the picture's transparency.
void outline_rows(App& app) {
    MeshSettings& mesh = app.editor.document.mesh;
    row_label(app, "Outline", 76);
    if (check_box(app, "Only where there is picture", mesh.from_alpha)) edit_at_once(app, "Outline");
    tooltip("Leaves out the cells without a visible pixel, so that limbs that do not touch are not joined");
    ImGui::BeginDisabled(!mesh.from_alpha);
    const float width = ImGui::GetContentRegionAvail().x - app.px(76);
    row_label(app, "Threshold", 76);
    double threshold = mesh.threshold;
    if (number_field(
            app, "##threshold", threshold,
            {.unit = "of 255", .width = width, .step = 0.25, .least = 0, .most = 254, .decimals = 0}))
        mesh.threshold = int(std::lround(threshold));
    is_step(app, "Outline threshold");
    tooltip("Pixels with more alpha than this are visible");
    row_label(app, "Margin", 76);
    number_field(app, "##margin", mesh.margin,
                 {.unit = "px",
                  .measure = NumberUnit::pixels,
                  .width = width,
                  .step = 0.25,
                  .least = 0,
                  .most = max_mesh_margin});
    is_step(app, "Outline margin");
    tooltip("Cells that come this near to a visible pixel stay");
    ImGui::EndDisabled();
}

/// What the weights and the mesh keep to.
void draw_limits(App& app) {
    begin_section_gap(app);
    if (!section(app, "limits", "Limits and outline", app.limits_open)) return;
    WeightSettings& weights = app.editor.document.weights;
    const float width = ImGui::GetContentRegionAvail().x - app.px(76);
    const bool has_exponent = find_weight_scheme(weights.scheme)->has_exponent;
    ImGui::BeginDisabled(!has_exponent);
    row_label(app, "Exponent", 76);
    number_field(app, "##exponent", weights.exponent,
                 {.width = width, .step = 0.01, .least = min_exponent, .most = max_exponent, .decimals = 2});
    is_step(app, "Exponent");
    tooltip(has_exponent ? "How quickly weights fall with distance; 2 is usual"
                         : "Only weights by distance have an exponent");
    ImGui::EndDisabled();
    row_label(app, "Falloff", 76);
    number_field(app, "##falloff", weights.falloff,
                 {.unit = weights.falloff > 0 ? "× reach" : "none",
                  .measure = NumberUnit::times,
                  .width = width,
                  .step = 0.02,
                  .least = 0,
                  .most = max_falloff,
                  .decimals = 2});
    is_step(app, "Falloff limit");
    tooltip("How many reaches away a probe's weight fades to nothing; 0: nowhere");
    row_label(app, "Follows", 76);
    const auto text = [](int most) {
        return most == 0 ? std::string("All probes") : fmt::format("The {} heaviest", most);
    };
    if (begin_combo(app, "##most", text(weights.most).c_str(), width)) {
        for (const int most : {0, 4, 8})
            if (ImGui::Selectable(text(most).c_str(), most == weights.most)) {
                weights.most = most;
                edit_at_once(app, "Probes per vertex");
            }
        ImGui::EndCombo();
    }
    tooltip("How many probes a vertex may follow");
    outline_rows(app);
}

/// Leaving a field makes what it did a step, however it was left; Escape takes it back.
void end_left_field(App& app) {
    const bool took_back = std::exchange(app.number.took_back, false);
    if (!app.editor.gesture || app.editor.gesture->kind != Gesture::Kind::field ||
        ImGui::GetActiveID() == app.field)
        return;
    if (took_back)
        cancel(app.editor);
    else
        end_field(app.editor, app.field_label);
}

}  // namespace

void draw_panel(App& app) {
    if (!has_picture(app.editor)) return;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float top = app.px(look::menu), width = app.px(look::panel);
    const float height = display.y - top - app.px(look::status);
    ImGui::SetNextWindowPos({display.x - width, top});
    ImGui::SetNextWindowSize({width, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::Begin("##panel", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoNav);
    ImGui::PopStyleVar(2);
    draw_probes(app);
    if (is_painting_tool(app.editor))
        draw_brush_section(app);
    else
        draw_chosen_probe(app);
    draw_deformation(app);
    draw_weights_section(app);
    draw_limits(app);
    end_left_field(app);
    ImGui::GetWindowDrawList()->AddLine({display.x - width, top}, {display.x - width, top + height},
                                        app.theme.line);
    ImGui::End();
}

}  // namespace probewarp
