// What pointer events do: they start a tool's gesture, carry it on, and end it as one step.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "editor/comparison.h"
#include "editor/painting.h"
#include "editor/tools.h"

namespace probewarp {

namespace {

constexpr double click_slack = 3;  // pixels at scale 1 that a click may wander
constexpr double snap = std::numbers::pi / 12;
constexpr double least_radius = 1;  // image pixels, for radii pulled by hand

bool wandered(const Editor& editor) {
    const glm::dvec2 d = editor.gesture->last - editor.gesture->pressed.at;
    return std::hypot(d.x, d.y) > click_slack * editor.scale;
}

void move_probe(const Editor& editor, const Gesture& gesture, Probe& probe, const PointerEvent& event) {
    const Probe* before = find_probe(gesture.before, probe.id);
    const glm::dvec2 from = before ? before->now : to_image(editor.view, gesture.pressed.at);
    glm::dvec2 way = (event.at - gesture.pressed.at) / editor.view.zoom;
    if (event.shift) (std::abs(way.x) > std::abs(way.y) ? way.y : way.x) = 0;
    probe.now = from + way;
}

/// Adds the turn of the pointer about the probe since the last event, so that whole turns count.
void turn_probe(const Editor& editor, Gesture& gesture, Probe& probe, const PointerEvent& event) {
    const glm::dvec2 middle = to_canvas(editor.view, probe.now);
    const glm::dvec2 from = gesture.last - middle, to = event.at - middle;
    if (std::hypot(to.x, to.y) < 2) return;  // at the centre there is no direction
    gesture.raw_angle += std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y);
    probe.angle = event.shift ? snap * std::round(gesture.raw_angle / snap) : gesture.raw_angle;
    gesture.last = event.at;
}

void drag(Editor& editor, const PointerEvent& event) {
    Gesture& gesture = *editor.gesture;
    if (gesture.kind == Gesture::Kind::pan) {
        editor.fit_wanted = false;
        editor.view.corner = gesture.start_corner + event.at - gesture.pressed.at;
        gesture.last = event.at;
        gesture.moved = gesture.moved || wandered(editor);
        return;
    }
    if (gesture.kind == Gesture::Kind::divider) return drag_divider(editor, event);
    if (is_brush_gesture(gesture.kind)) return drag_brush(editor, event);
    Probe* probe = find_probe(editor.document, gesture.probe);
    if (!probe) return;
    if (gesture.kind == Gesture::Kind::turn) return turn_probe(editor, gesture, *probe, event);
    gesture.last = event.at;
    // A click that trembles must not move a probe; once it has moved, it follows exactly.
    gesture.moved = gesture.moved || wandered(editor);
    if (!gesture.moved) return;
    if (gesture.kind == Gesture::Kind::move) move_probe(editor, gesture, *probe, event);
    if (gesture.kind == Gesture::Kind::reach) {
        const glm::dvec2 d = to_image(editor.view, event.at) - probe->now;
        probe->radius = std::max(least_radius, std::hypot(d.x, d.y));
    }
}

/// Where the other blend is shown, what is pressed is not what the person sees: says so.
bool only_compares(Editor& editor, const PointerEvent& event) {
    if (!is_compared(editor, event.at)) return false;
    editor.notice = "This side only compares: work on the picture at the left of the divider.";
    return true;
}

/// The tools that look for the picture under the pointer.
bool changes_picture(const Tool& tool) { return tool.name != "select" && tool.name != "zoom"; }

}  // namespace

void press(Editor& editor, const PointerEvent& event) {
    editor.pointer = event.at;
    if (editor.gesture || !has_picture(editor)) return;
    if (event.button == Button::middle || (event.button == Button::left && event.space))
        begin(editor, Gesture::Kind::pan, event, {});
    else if (event.button == Button::left && is_on_divider(editor, event.at))
        begin(editor, Gesture::Kind::divider, event, {}).start_divider = editor.comparison->divider;
    else if (event.button == Button::left && !(changes_picture(*editor.tool) && only_compares(editor, event)))
        editor.tool->press(editor, event);
}

void move(Editor& editor, const PointerEvent& event) {
    editor.pointer = event.at;
    if (editor.gesture && editor.gesture->kind != Gesture::Kind::field)
        drag(editor, event);
    else if (has_picture(editor))
        editor.hover = is_painting_tool(editor) && !event.alt ? Hit{} : hit_test(editor, event.at);
}

void release(Editor& editor, const PointerEvent& event) {
    editor.pointer = event.at;
    if (!editor.gesture || editor.gesture->kind == Gesture::Kind::field ||
        editor.gesture->pressed.button != event.button)
        return;
    const bool pans = editor.gesture->kind == Gesture::Kind::pan, clicked = !editor.gesture->moved;
    if (pans) {
        const bool by_tool = event.button == Button::left && !editor.gesture->pressed.space;
        editor.gesture.reset();
        if (clicked && by_tool && editor.tool->click) editor.tool->click(editor, event);
        return;
    }
    if (editor.gesture->kind == Gesture::Kind::divider) return editor.gesture.reset();
    if (is_brush_gesture(editor.gesture->kind)) return release_brush(editor);
    commit(editor, editor.gesture->label);
}

void double_click(Editor& editor, const PointerEvent& event) {
    if (event.button != Button::left || event.space || !has_picture(editor)) return;
    // On the circle of a probe's reach there is room for another probe; on its disc and knob there is none.
    const Part part = hit_test(editor, event.at).part;
    if (editor.tool != &find_tool("select") || part == Part::disc || part == Part::knob ||
        only_compares(editor, event))
        return;
    if (const int id = put_probe(editor, event.at); id != 0)
        commit(editor, "Add " + find_probe(editor.document, id)->name);
}

void scroll(Editor& editor, const PointerEvent& event, double steps) {
    if (has_picture(editor) && !editor.gesture) zoom_canvas(editor, event.at, std::pow(1.2, steps));
}

}  // namespace probewarp
