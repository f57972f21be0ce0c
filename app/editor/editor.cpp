#include "editor/editor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "editor/painting.h"
#include "editor/tools.h"
#include "model/error.h"

namespace probewarp {

Editor::Editor() : tool(&tools()[0]) {}

bool has_picture(const Editor& editor) { return editor.document.picture != nullptr; }

Probe* selected_probe(Editor& editor) { return find_probe(editor.document, editor.selected); }

namespace {

/// The versions go on: who keeps what was drawn from the last deformation must see that this is another.
void forget_deformation(Editor& editor) {
    Deformation fresh;
    fresh.mesh_version = editor.deformation.mesh_version;
    fresh.version = editor.deformation.version;
    editor.deformation = std::move(fresh);
    editor.next_deformation.reset();
}

}  // namespace

void start(Editor& editor, Document document, std::filesystem::path path, bool saved) {
    editor.gesture.reset();
    editor.selected = 0;
    editor.hover = {};
    editor.history = new_history(document, saved);
    editor.document = std::move(document);
    forget_deformation(editor);
    ++editor.opened;
    editor.path = std::move(path);
    editor.axis.reset();
    if (has_picture(editor)) editor.brush.radius = default_brush_radius(editor.document.picture->image);
    editor.fit_wanted = true;
}

namespace {

/// Whether `next` is closer to the document's own deformation.
bool is_nearer(const Deformation& next, const Deformation& present, const Document& document) {
    if (!fits(next.binding.get(), document)) return false;
    if (!fits(present.binding.get(), document)) return true;
    if (next.binding != present.binding)
        return is_bound(next.binding.get(), document) || !is_bound(present.binding.get(), document);
    // Of two that leave as much to do the later one follows the hand.
    const std::size_t work = refining_work(present, document);
    return work > 0 && refining_work(next, document) <= work;
}

void take_next(Editor& editor) {
    std::optional<Deformation>& next = editor.next_deformation;
    if (!next) return;
    if (is_nearer(*next, editor.deformation, editor.document)) {
        // A stroke keeps the mesh that it began on.
        if (is_stroking(editor) && next->binding != editor.deformation.binding) return;
        replace(editor.deformation, std::move(*next));
    }
    next.reset();
}

}  // namespace

bool settles_at_once(const Editor& editor) {
    constexpr std::size_t at_once = std::size_t{1} << 22;
    return refining_work(editor.deformation, editor.document) <= at_once;
}

void refresh(Editor& editor) {
    if (!has_picture(editor) || defers_deformation(editor)) return;
    auto& deformation = editor.deformation;
    const Pace pace = editor.gesture ? Pace::dragging : Pace::settled;
    if (!editor.deforms_elsewhere) return update(deformation, editor.document, pace);
    take_next(editor);
    if (!fits(deformation.binding.get(), editor.document)) return;
    if (settles_at_once(editor)) return pose(deformation, editor.document, deformation.binding, pace);
    // The weights are not there yet: those that are go on deforming.
    if (const auto shown = in_pose_of(deformation.source, editor.document))
        pose(deformation, *shown, deformation.binding, pace);
}

bool is_deformed(const Editor& editor) {
    return is_bound(editor.deformation.binding.get(), editor.document) &&
           editor.deformation.source == editor.document;
}

void commit(Editor& editor, std::string label) {
    editor.gesture.reset();
    commit(editor.history, editor.document, std::move(label));
}

void cancel(Editor& editor) {
    if (!editor.gesture) {
        editor.selected = 0;
        return;
    }
    if (editor.gesture->kind == Gesture::Kind::pan) editor.view.corner = editor.gesture->start_corner;
    if (editor.gesture->kind == Gesture::Kind::brush_size) editor.brush.radius = editor.gesture->start_radius;
    if (editor.gesture->kind == Gesture::Kind::divider && editor.comparison)
        editor.comparison->divider = editor.gesture->start_divider;
    editor.document = std::move(editor.gesture->before);
    editor.gesture.reset();
    if (!selected_probe(editor)) editor.selected = 0;
}

namespace {

void show_present(Editor& editor) {
    editor.gesture.reset();
    editor.document = present(editor.history);
    if (!selected_probe(editor)) editor.selected = 0;
}

}  // namespace

void restore(Editor& editor) {
    show_present(editor);
    editor.hover = {};
    forget_deformation(editor);
}

void undo_step(Editor& editor) {
    if (undo(editor.history)) show_present(editor);
}

void redo_step(Editor& editor) {
    if (redo(editor.history)) show_present(editor);
}

void begin_field(Editor& editor) {
    if (!editor.gesture) begin(editor, Gesture::Kind::field, {}, {});
}

void end_field(Editor& editor, std::string label) { commit(editor, std::move(label)); }

int put_probe(Editor& editor, glm::dvec2 at) {
    if (!has_picture(editor)) return 0;
    refresh(editor);
    const glm::dvec2 point = to_image(editor.view, at);
    const auto pose = editor.deformation.binding ? pose_at(editor.deformation, point) : std::nullopt;
    if (!pose) {
        editor.notice = "There is no picture there to put a probe on.";
        return 0;
    }
    Probe probe = new_probe(editor.document, pose->rest);
    probe.now = point;
    probe.angle = pose->angle;
    if (editor.document.probes.empty()) probe.now = probe.rest;  // nothing is deformed yet: exactly at rest
    return add_probe(editor, probe) ? probe.id : 0;
}

bool add_probe(Editor& editor, Probe probe) {
    editor.document.probes.push_back(std::move(probe));
    try {
        check_size(editor.document);
    } catch (const Error& error) {
        editor.document.probes.pop_back();
        editor.notice = std::string(error.what()) + ".";
        return false;
    }
    editor.selected = editor.document.probes.back().id;
    return true;
}

void say_locked_stay(Editor& editor, const std::function<bool(const Probe&)>& would_change) {
    const Probe* last = nullptr;
    std::size_t count = 0;
    for (const Probe& probe : editor.document.probes)
        if (probe.locked && would_change(probe)) {
            last = &probe;
            ++count;
        }
    if (count == 1) editor.notice = last->name + " is locked and stays as it is.";
    if (count > 1) editor.notice = std::to_string(count) + " locked probes stay as they are.";
}

glm::dvec2 knob_position(const Editor& editor, const Probe& probe) {
    return to_canvas(editor.view, probe.now) +
           stem_length * editor.scale * glm::dvec2(std::sin(probe.angle), -std::cos(probe.angle));
}

namespace {

double distance(glm::dvec2 a, glm::dvec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

Part part_at(const Editor& editor, const Probe& probe, glm::dvec2 at) {
    const double reach = (knob_radius + 4) * editor.scale;
    if (distance(at, knob_position(editor, probe)) <= reach) return Part::knob;
    if (distance(at, to_canvas(editor.view, probe.now)) <= (disc_radius + 2) * editor.scale)
        return Part::disc;
    return Part::none;
}

}  // namespace

Hit hit_test(const Editor& editor, glm::dvec2 at) {
    if (!editor.show_probes) return {};
    const auto& probes = editor.document.probes;
    const Probe* chosen = find_probe(editor.document, editor.selected);
    if (chosen && chosen->visible)
        if (const Part part = part_at(editor, *chosen, at); part != Part::none) return {part, chosen->id};
    for (auto probe = probes.rbegin(); probe != probes.rend(); ++probe)
        if (const Part part = part_at(editor, *probe, at); probe->visible && part != Part::none)
            return {part, probe->id};
    if (chosen && chosen->visible) {
        const double off =
            distance(at, to_canvas(editor.view, chosen->now)) - chosen->radius * editor.view.zoom;
        if (std::abs(off) <= 4 * editor.scale) return {Part::reach, chosen->id};
    }
    return {};
}

void resize_canvas(Editor& editor, glm::dvec2 size, double scale) {
    editor.canvas_size = size;
    editor.scale = scale;
    if (!has_picture(editor) || !editor.fit_wanted) return;
    const Image& image = editor.document.picture->image;
    editor.view = fitted({image.width, image.height}, size, 40 * scale, std::max(1.0, scale));
}

void zoom_canvas(Editor& editor, glm::dvec2 fixed, double factor) {
    zoom_at(editor.view, fixed, factor);
    editor.fit_wanted = false;
}

}  // namespace probewarp
