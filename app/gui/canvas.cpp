#include "gui/canvas.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "editor/comparison.h"
#include "editor/painting.h"
#include "editor/tools.h"
#include "gui/app.h"
#include "gui/widgets.h"
#include "model/folds.h"

namespace probewarp {

namespace {

/// What the canvas should show now, at that size.
Shown wanted(const App& app, glm::ivec2 size) {
    const Editor& editor = app.editor;
    Shown wanted;
    wanted.picture = app.uploaded;
    wanted.mesh_version = editor.deformation.mesh_version;
    wanted.version = editor.deformation.version;
    wanted.view = editor.view;
    wanted.size = size;
    wanted.mesh = editor.show_mesh;
    wanted.folds = editor.show_folds;
    wanted.light = app.theme.is_light;
    wanted.still = shown_positions(editor).data() != editor.deformation.now.data();
    // Another picture's mesh is no way to show this one: until its binding is there it is shown as it is.
    wanted.bound = editor.deformation.binding && editor.deformation.source.picture == editor.document.picture;
    if (wanted.bound) wanted.overlay = overlay_key(editor);
    if (wanted.bound && is_shaded(app)) wanted.pose = transformations_of(editor.document);
    if (const auto x = divider(editor); x && wanted.bound) {
        wanted.compared = editor.comparison->blend;
        wanted.divider = int(*x);
    }
    return wanted;
}

/// Lets go of the shader's weights and of all that they follow from, where they are not the deformation's any
/// more: a large mesh has hundreds of mebibytes of them, here and at the driver.
void drop_outdated_weights(App& app, const WeightsKey& weights) {
    if (!app.shaded.binding || (app.shown.bound && app.shaded == weights)) return;
    app.shaded = {};
    app.renderer->set_weights({});
}

/// Has the vertex shader move the vertices; the weights are handed over where it has not got them yet. Where
/// it cannot, it is the processor's turn from then on.
void shade(App& app, const WeightsKey& weights) {
    const Deformation& deformation = app.editor.deformation;
    try {
        if (!app.shaded.binding) app.renderer->set_weights(weights_of(deformation));
        app.shaded = weights;
        app.renderer->set_pose(app.shown.pose, glm::vec2(centre(deformation.source.picture->image)));
    } catch (const Error&) {
        app.editor.deform_by = DeformBy::processor;
        throw;
    }
}

/// Draws what `app.shown` says; `before` is what the renderer holds.
void draw_shown(App& app, const Shown& before) {
    Editor& editor = app.editor;
    Renderer& renderer = *app.renderer;
    const Shown& now = app.shown;
    const bool new_mesh = before.mesh_version != now.mesh_version;
    // Where two blends are compared the renderer holds the other one's positions, where it shaded its own.
    const bool new_positions = before.bound != now.bound || new_mesh || before.version != now.version ||
                               before.still != now.still || !before.compared.empty() || !before.pose.empty();
    const WeightsKey weights = weights_key(editor.deformation);
    drop_outdated_weights(app, weights);
    if (now.bound && new_mesh)
        renderer.set_mesh(editor.deformation.binding->mesh, editor.deformation.binding->still);
    if (!now.bound)
        renderer.set_positions({}, false);
    else if (!now.pose.empty())
        shade(app, weights);
    else if (new_positions)
        renderer.set_positions(shown_positions(editor), editor.deformation.moved);
    if (before.bound != now.bound || new_mesh || app.overlaid != weights || before.overlay != now.overlay)
        renderer.set_overlay(overlay_vertices(editor, now.overlay), overlay_style(now.overlay));
    app.overlaid = now.overlay.weights == ShownWeights::none ? WeightsKey{} : weights;
    View view;
    view.scale = glm::dvec2(now.view.zoom);
    view.origin = -now.view.corner / now.view.zoom;
    view.width = now.size.x;
    view.height = now.size.y;
    const auto draw = [&](int first_column) {
        renderer.draw(view, 1, true, first_column, Fineness::seen);
        const ShownMesh mesh{now.bound && now.mesh, now.bound && now.folds ? double(app.px(7)) : 0};
        app.shown_texture =
            renderer.display(view, display_colours(app.theme), double(app.px(12)), mesh, first_column);
    };
    draw(0);
    if (now.compared.empty()) return;
    renderer.set_positions(compared_positions(editor), editor.deformation.moved);
    draw(now.divider);
}

/// Counts the folded triangles of the pose that is shown. Those of a large mesh are not counted while it
/// changes with each frame, nor where the graphics card alone knows where they are.
void count_folds(App& app) {
    constexpr std::size_t quickly_counted = 1 << 17;  // triangles: far below a millisecond
    const Deformation& deformation = app.editor.deformation;
    if (deformation.binding && app.folds_version == deformation.version) return;
    app.folds.reset();  // those of another document too
    if (!deformation.binding) return;
    const bool waits = app.editor.gesture && mesh_of(deformation).triangles.size() / 3 > quickly_counted;
    if (waits || is_shaded(app)) return;
    app.folds = deformation.moved ? folded_triangles(mesh_of(deformation), deformation.now) : 0;
    app.folds_version = deformation.version;
}

void update_texture(App& app, glm::ivec2 size) {
    update_deformation(app);
    count_folds(app);
    if (app.uploaded != app.editor.document.picture) return prepare_picture(app, app.editor.document.picture);
    Shown now = wanted(app, size);
    if (app.shown == now) return;
    // Kept before the drawing: where it fails, it is tried again only when something has changed.
    std::swap(app.shown, now);
    app.redraws = true;
    try {
        draw_shown(app, std::exchange(app.shown_failed, true) ? Shown() : now);
        app.shown_failed = false;
    } catch (const std::exception& error) {
        say(app, Tone::error, error.what());
    }
}

void look_under_pointer(App& app) {
    Editor& editor = app.editor;
    if (is_shaded(app)) return;  // the same as before: what is dragged stays under the pointer
    app.under.reset();
    app.shares.clear();
    const bool shown =
        editor.deformation.binding && editor.deformation.source.picture == editor.document.picture;
    if (!editor.pointer || !shown) return;
    const auto positions =
        is_compared(editor, *editor.pointer) ? compared_positions(editor) : shown_positions(editor);
    app.under = locate(mesh_of(editor.deformation), positions, to_image(editor.view, *editor.pointer));
    if (app.under) app.shares = shares_at(editor.deformation, *app.under);
}

/// Draws probes at a place of the window, in the look of look.md.
struct ProbePainter {
    App& app;
    ImDrawList* list;
    ImVec2 corner;  ///< of the canvas, window pixels

    ImVec2 at(glm::dvec2 p) const { return {corner.x + float(p.x), corner.y + float(p.y)}; }

    void reach(const Probe& probe, ImVec2 middle) const {
        const double radius = probe.radius * app.editor.view.zoom;
        const int dashes = std::clamp(int(radius * 2 * std::numbers::pi / double(app.px(10))), 8, 400);
        const ImU32 colour = to_u32(probe.colour, 0.75f);
        for (int i = 0; i < dashes; ++i) {
            const float from = float(2 * std::numbers::pi * i / dashes),
                        to = from + float(std::numbers::pi / dashes);
            list->PathArcTo(middle, float(radius), from, to, 6);
            list->PathStroke(colour, 0, app.px(1.5));
        }
    }

    void draw(const Probe& probe) const {
        const Editor& editor = app.editor;
        const bool chosen = probe.id == editor.selected;
        const bool lit =
            editor.hover.probe == probe.id || (editor.gesture && editor.gesture->probe == probe.id);
        const ImU32 dark = IM_COL32(0x0d, 0x0f, 0x12, 255);
        const ImU32 plain = to_u32(probe.colour);
        const ImU32 colour = lit ? mixed(plain, IM_COL32_WHITE, 0.25f) : plain;
        const ImVec2 middle = at(to_canvas(editor.view, probe.now)), knob = at(knob_position(editor, probe));
        const float radius = app.px(disc_radius);
        if (chosen) {
            reach(probe, middle);
            list->AddCircle(middle, radius + app.px(4), IM_COL32_WHITE, 48, app.px(2));
        }
        list->AddLine(middle, knob, dark, app.px(5));
        list->AddLine(middle, knob, colour, app.px(2.5));
        list->AddCircleFilled(knob, app.px(knob_radius + 1.2), dark, 24);
        list->AddCircleFilled(knob, app.px(knob_radius), colour, 24);
        list->AddCircleFilled(middle, radius, faded(colour, lit ? 0.45f : 0.28f), 48);
        list->AddCircle(middle, radius, dark, 48, app.px(4.5));
        list->AddCircle(middle, radius, colour, 48, app.px(2.5));
        list->AddCircleFilled(middle, app.px(3), IM_COL32_WHITE, 16);
        if (probe.locked) {
            const ImVec2 badge{middle.x + radius * 0.8f, middle.y + radius * 0.8f};
            list->AddCircleFilled(badge, app.px(8), dark, 24);
            ImFont* font = app.fonts.icons_small;
            const float size = app.px(12);
            const ImVec2 extent = font->CalcTextSizeA(size, FLT_MAX, 0, icon::lock);
            list->AddText(font, size, {badge.x - extent.x / 2, badge.y - extent.y / 2}, IM_COL32_WHITE,
                          icon::lock);
        }
    }
};

void draw_label(const App& app, ImDrawList* list, ImVec2 at, const std::string& text, ImU32 ink,
                float rounding) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const ImVec2 pad{app.px(12), app.px(5)};
    list->AddRectFilled(at, {at.x + size.x + 2 * pad.x, at.y + size.y + 2 * pad.y},
                        faded(on_picture::night, on_picture::label_opacity), rounding);
    list->AddText({at.x + pad.x, at.y + pad.y}, ink, text.c_str());
}

std::string signed_number(double value) {
    return fmt::format("{}{:.0f}", std::round(value) < 0 ? "−" : "+", std::abs(value));
}

void draw_gesture_label(const App& app, const ProbePainter& painter) {
    const Editor& editor = app.editor;
    if (!editor.gesture || !editor.gesture->probe) return;
    const Probe* probe = find_probe(editor.document, editor.gesture->probe);
    if (!probe) return;
    const glm::dvec2 way = probe->now - probe->rest;
    const std::string text = editor.gesture->kind == Gesture::Kind::reach
                                 ? fmt::format("reach {:.0f} px", probe->radius)
                                 : fmt::format("{}, {} px   {:.0f}°", signed_number(way.x),
                                               signed_number(way.y), probe->angle * 180 / std::numbers::pi);
    const ImVec2 middle = painter.at(to_canvas(editor.view, probe->now));
    draw_label(app, painter.list, {std::round(middle.x + app.px(32)), std::round(middle.y - app.px(74))},
               text, on_picture::text, app.px(6));
}

/// The brush's circle about the pointer, with the part that a dab covers wholly, and what is mirrored.
void draw_brush(const App& app, const ProbePainter& painter) {
    const Editor& editor = app.editor;
    if (!is_painting_tool(editor) || app.modal) return;
    const ImU32 dark = IM_COL32(0x0d, 0x0f, 0x12, 200), light = IM_COL32(255, 255, 255, 235);
    ImDrawList* list = painter.list;
    if (editor.mirror) {
        const MirrorAxis axis = mirror_axis(editor);
        const glm::dvec2 along{std::sin(axis.angle), -std::cos(axis.angle)};
        const double far =
            2 * double(std::max(editor.document.picture->image.width, editor.document.picture->image.height));
        const ImVec2 from = painter.at(to_canvas(editor.view, axis.point - far * along)),
                     to = painter.at(to_canvas(editor.view, axis.point + far * along));
        list->AddLine(from, to, faded(dark, 0.6f), app.px(3));
        list->AddLine(from, to, app.theme.accent, app.px(1));
        const ImVec2 grip = painter.at(axis_grip(editor));
        list->AddCircleFilled(grip, app.px(8), dark, 24);
        list->AddCircleFilled(grip, app.px(6.5), app.theme.accent, 24);
    }
    // While it is sized by hand the circle stays where that began.
    const bool sized = editor.gesture && editor.gesture->kind == Gesture::Kind::brush_size;
    if (!editor.pointer && !sized) return;
    const ImVec2 middle = painter.at(sized ? editor.gesture->pressed.at : *editor.pointer);
    const float radius = float(editor.brush.radius * editor.view.zoom);
    const int segments = std::clamp(int(radius), 24, 200);
    list->AddCircle(middle, radius, dark, segments, app.px(3));
    list->AddCircle(middle, radius, light, segments, app.px(1.25));
    if (editor.brush.hardness > 0.02 && editor.brush.hardness < 0.98)
        list->AddCircle(middle, radius * float(editor.brush.hardness), faded(light, 0.5f), segments,
                        app.px(1));
    if (sized)
        draw_label(app, list, {middle.x + app.px(16), middle.y - app.px(40)},
                   fmt::format("{:.0f} px", editor.brush.radius), on_picture::text, app.px(6));
}

/// The name of a blend at the top of the canvas, ending at the divider or beginning there.
void draw_blend_name(const App& app, ImDrawList* list, float x, float top, std::string_view blend,
                     bool ends) {
    const std::string text(find_blend_method(blend)->label);
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    const float left = ends ? x - width - app.px(36) : x + app.px(24);  // a label has a margin of its own
    draw_label(app, list, {std::round(left), top + app.px(12)}, text, on_picture::text, app.px(6));
}

/// The line between two blends, a grip to take hold of it, and their names.
void draw_divider(const App& app, const ProbePainter& painter, float height) {
    const Editor& editor = app.editor;
    const auto at = divider(editor);
    if (!at || app.shown.compared.empty()) return;
    const float x = painter.corner.x + float(*at), top = painter.corner.y;
    const ImU32 dark = IM_COL32(0x0d, 0x0f, 0x12, 160);
    ImDrawList* list = painter.list;
    list->AddLine({x, top}, {x, top + height}, dark, app.px(4));
    list->AddLine({x, top}, {x, top + height}, IM_COL32_WHITE, app.px(1.5));
    const ImVec2 middle{x, top + std::round(height / 2)};
    list->AddCircleFilled(middle, app.px(13), dark, 32);
    list->AddCircleFilled(middle, app.px(11), IM_COL32_WHITE, 32);
    for (const float side : {-1.0f, 1.0f}) {
        const float tip = x + side * app.px(7.5), base = x + side * app.px(3);
        list->AddTriangleFilled({tip, middle.y}, {base, middle.y - app.px(4)}, {base, middle.y + app.px(4)},
                                IM_COL32(0x20, 0x24, 0x2a, 255));
    }
    draw_blend_name(app, list, x, top, editor.document.blend, true);
    draw_blend_name(app, list, x, top, app.shown.compared, false);
}

void draw_hint(const App& app, ImDrawList* list, float left, float bottom, float width) {
    const std::string text(app.editor.tool->hint);
    ImGui::PushFont(app.fonts.small);
    const float text_width = ImGui::CalcTextSize(text.c_str()).x + app.px(24);
    if (text_width <= width && !app.editor.gesture)
        draw_label(app, list, {std::round(left + (width - text_width) / 2), bottom - app.px(32)}, text,
                   on_picture::hint, app.px(12));
    ImGui::PopFont();
}

void choose_cursor(const Editor& editor) {
    if (editor.gesture && editor.gesture->kind == Gesture::Kind::pan)
        return ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
    const bool drags_divider = editor.gesture && editor.gesture->kind == Gesture::Kind::divider;
    if (drags_divider || (!editor.gesture && editor.pointer && is_on_divider(editor, *editor.pointer)))
        return ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (is_painting_tool(editor)) return ImGui::SetMouseCursor(ImGuiMouseCursor_None);
    if (editor.hover.part == Part::disc) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
    if (editor.hover.part == Part::knob || editor.hover.part == Part::reach)
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
}

}  // namespace

void draw_canvas(App& app, float left, float top, float width, float height) {
    Editor& editor = app.editor;
    resize_canvas(editor, {width, height}, double(app.scale));
    ImGui::SetNextWindowPos({left, top});
    ImGui::SetNextWindowSize({width, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, app.theme.canvas);
    ImGui::Begin("##canvas", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
    if (!has_picture(editor)) {
        draw_empty_state(app, left, top, width, height);
        ImGui::End();
        return;
    }
    update_texture(app, {int(width), int(height)});
    look_under_pointer(app);
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (app.shown_texture != 0 && app.shown.picture == editor.document.picture)
        list->AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(app.shown_texture)), {left, top},
                       {left + width, top + height});
    const ProbePainter painter{app, list, {left, top}};
    list->PushClipRect({left, top}, {left + width, top + height}, true);
    draw_divider(app, painter, height);
    if (editor.show_probes) {
        for (const Probe& probe : editor.document.probes)
            if (probe.visible && probe.id != editor.selected) painter.draw(probe);
        if (const Probe* chosen = find_probe(editor.document, editor.selected); chosen && chosen->visible)
            painter.draw(*chosen);
        draw_gesture_label(app, painter);
    }
    draw_brush(app, painter);
    draw_hint(app, list, left, top + height, width);
    list->PopClipRect();
    if (editor.pointer && !app.modal) choose_cursor(editor);
    ImGui::End();
}

}  // namespace probewarp
