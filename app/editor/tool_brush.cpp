// Paints the chosen probe's weights, or with the pin the picture's stiffness.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "editor/painting.h"
#include "editor/tools.h"
#include "model/paint_ops.h"
#include "model/sum_of.h"

namespace probewarp {

double default_brush_radius(const Image& image) {
    return std::max(min_brush_radius, std::max(image.width, image.height) / 16.0);
}

bool paints_stiffness(const Editor& editor) { return editor.tool == &find_tool("pin"); }
bool is_painting_tool(const Editor& editor) {
    return editor.tool == &find_tool("brush") || paints_stiffness(editor);
}
bool is_brush_gesture(Gesture::Kind kind) {
    return kind == Gesture::Kind::paint || kind == Gesture::Kind::brush_size || kind == Gesture::Kind::axis;
}

MirrorAxis mirror_axis(const Editor& editor) {
    return editor.axis.value_or(MirrorAxis{centre(editor.document.picture->image), 0});
}

glm::dvec2 axis_grip(const Editor& editor) {
    const MirrorAxis axis = mirror_axis(editor);
    const double above = 18 * editor.scale / editor.view.zoom;  // image pixels over the picture's top edge
    const double way = (axis.point.y + above) / std::cos(axis.angle);
    return to_canvas(editor.view, axis.point + way * glm::dvec2(std::sin(axis.angle), -std::cos(axis.angle)));
}

std::span<const glm::vec2> shown_positions(const Editor& editor) {
    const PaintStroke* stroke = editor.gesture ? editor.gesture->stroke.get() : nullptr;
    return stroke && !stroke->still.empty() ? stroke->still : editor.deformation.now;
}

bool is_stroking(const Editor& editor) { return editor.gesture && editor.gesture->stroke; }

bool defers_deformation(const Editor& editor) {
    const PaintStroke* stroke = editor.gesture ? editor.gesture->stroke.get() : nullptr;
    return stroke && stroke->layer.probe == 0 && !stroke->still.empty();
}

namespace {

PaintPtr& paint_of_layer(Document& document, int probe) {
    return probe == 0 ? document.stiffness : find_probe(document, probe)->paint;
}

/// The probe's share at each vertex as it is now.
std::vector<float> shares_of(const Deformation& deformation, std::size_t probe) {
    const std::size_t probes = deformation.source.probes.size();
    const auto weights = weights_of(deformation);
    std::vector<float> shares;
    shares.reserve(deformation.now.size());
    for (std::size_t start = 0; start < weights.size(); start += probes)
        shares.push_back(weights[start + probe] / float(sum_of(weights.subspan(start, probes))));
    return shares;
}

PaintStroke::Layer layer_of(Editor& editor, int probe) {
    PaintStroke::Layer layer;
    layer.probe = probe;
    layer.map = map_of(editor.document, paint_of_layer(editor.document, probe));
    layer.stroke = {layer.map, {}, {}};
    if (probe != 0) layer.shares = shares_of(editor.deformation, place_of(editor.document, probe));
    return layer;
}

/// What the layer's probe has at a texel before the stroke: the paint there, over what its vertices had.
float share_at(const PaintStroke& stroke, const PaintStroke::Layer& layer, const PictureFrame& frame, int x,
               int y) {
    const Paint before = texel(layer.stroke.before, x, y);
    if (layer.probe == 0) return before.value * before.coverage;
    if (before.coverage == 1) return before.value;
    const Mesh& mesh = *stroke.binding->mesh;
    const auto at = locate_at_rest(mesh, to_picture(layer.map, frame, {x + 0.5, y + 0.5}));
    if (!at) return before.value * before.coverage;
    double share = 0;
    for (int k = 0; k < 3; ++k)
        share += at->barycentric[k] * double(layer.shares[at->corners[std::size_t(k)]]);
    return before.coverage * before.value + (1 - before.coverage) * float(share);
}

void fall(Editor& editor, const PaintStroke& stroke, PaintStroke::Layer& layer, const Mask& mask) {
    const PictureFrame frame = frame_of(editor.document.picture->image);
    dab(layer.map, layer.stroke, mask, stroke.brush, stroke.inverted,
        [&](int x, int y) { return share_at(stroke, layer, frame, x, y); });
    paint_of_layer(editor.document, layer.probe) = std::make_shared<const PaintMap>(layer.map);
}

/// The brush as the tool uses it: with Ctrl the pin takes stiffness away.
Brush brush_for(const Editor& editor, bool inverted) {
    Brush brush = editor.brush;
    if (paints_stiffness(editor) && inverted) brush.mode = BrushMode::erase;
    return brush;
}

void fall_at(Editor& editor, PaintStroke& stroke, glm::dvec2 point) {
    const Image& image = editor.document.picture->image;
    const PictureFrame frame = frame_of(image);
    const Brush& brush = stroke.brush;
    PaintStroke::Layer& layer = stroke.layer;
    const Mask mask =
        dab_mask(layer.map, frame, *stroke.binding->mesh, shown_positions(editor), image, brush, point);
    fall(editor, stroke, layer, mask);
    if (!editor.mirror) return;
    PaintStroke::Layer& other = stroke.mirrored ? *stroke.mirrored : layer;
    fall(editor, stroke, other, mirrored(mask, layer.map, other.map, frame, mirror_axis(editor)));
}

/// Why the chosen probe cannot be painted; empty where it can.
std::string why_not(const Editor& editor) {
    const Deformation& deformation = editor.deformation;
    constexpr const char* wait = "The weights are still being worked out.";
    if (!fits(deformation.binding.get(), editor.document)) return wait;
    if (paints_stiffness(editor)) return {};
    const Probe* probe = find_probe(editor.document, editor.selected);
    if (!probe) return "Choose a probe to paint, in the list or with Alt+click.";
    if (probe->locked) return probe->name + " is locked. Unlock it in the list to paint it.";
    // A stroke adds to the shares that the vertices have before it.
    const bool settled = is_bound(deformation.binding.get(), editor.document) &&
                         refining_work(deformation, editor.document) == 0;
    return settled ? "" : wait;
}

void begin_stroke(Editor& editor, const PointerEvent& event) {
    refresh(editor);
    if (auto reason = why_not(editor); !reason.empty()) {
        editor.notice = std::move(reason);
        return;
    }
    const bool stiff = paints_stiffness(editor);
    const int probe = stiff ? 0 : editor.selected;
    auto stroke = std::make_shared<PaintStroke>();
    stroke->binding = editor.deformation.binding;
    stroke->layer = layer_of(editor, probe);
    stroke->inverted = event.ctrl;
    stroke->brush = brush_for(editor, event.ctrl);
    stroke->last = to_image(editor.view, event.at);
    if (editor.shown_weights != ShownWeights::none) stroke->still = editor.deformation.now;
    if (editor.mirror && !stiff) {
        const std::size_t place = place_of(editor.document, probe);
        const std::size_t other = counterpart(editor.document, place, mirror_axis(editor));
        if (other != place)
            say_locked_stay(editor, [&](const Probe& p) { return &p == &editor.document.probes[other]; });
        if (other != place && !editor.document.probes[other].locked)
            stroke->mirrored = layer_of(editor, editor.document.probes[other].id);
    }
    Gesture& gesture = begin(editor, Gesture::Kind::paint, event,
                             stiff ? "Paint stiffness" : "Paint " + find_probe(editor.document, probe)->name);
    gesture.stroke = stroke;
    fall_at(editor, *stroke, stroke->last);
}

}  // namespace

void press_brush(Editor& editor, const PointerEvent& event) {
    if (event.alt) {
        if (const Hit hit = hit_test(editor, event.at); hit.probe != 0) editor.selected = hit.probe;
        return;
    }
    const glm::dvec2 off = event.at - axis_grip(editor);
    if (editor.mirror && std::hypot(off.x, off.y) <= 12 * editor.scale)
        begin(editor, Gesture::Kind::axis, event, {});
    else if (event.shift)
        begin(editor, Gesture::Kind::brush_size, event, {}).start_radius = editor.brush.radius;
    else
        begin_stroke(editor, event);
}

void drag_brush(Editor& editor, const PointerEvent& event) {
    Gesture& gesture = *editor.gesture;
    const glm::dvec2 way = (event.at - gesture.last) / editor.view.zoom;  // image pixels since the last event
    gesture.last = event.at;
    if (gesture.kind == Gesture::Kind::axis) {
        MirrorAxis axis = mirror_axis(editor);
        axis.point.x += way.x;
        editor.axis = axis;
        return;
    }
    if (gesture.kind == Gesture::Kind::brush_size) {
        editor.brush.radius = std::clamp(editor.brush.radius + way.x, min_brush_radius, max_brush_radius);
        return;
    }
    refresh(editor);  // the picture follows the stroke, and the stroke the picture
    PaintStroke& stroke = *gesture.stroke;
    assert(stroke.binding == editor.deformation.binding);  // refresh keeps it
    for (const glm::dvec2 point : dabs_between(stroke.last, to_image(editor.view, event.at), stroke.brush)) {
        fall_at(editor, stroke, point);
        stroke.last = point;
    }
}

void release_brush(Editor& editor) {
    if (editor.gesture->kind != Gesture::Kind::paint) {
        editor.gesture.reset();  // the brush and the axis are no part of the document
        return;
    }
    const PaintStroke& stroke = *editor.gesture->stroke;
    for (const PaintStroke::Layer* layer : {&stroke.layer, stroke.mirrored ? &*stroke.mirrored : nullptr})
        if (layer && is_blank(layer->map)) paint_of_layer(editor.document, layer->probe) = nullptr;
    commit(editor, editor.gesture->label);
}

bool press_brush_key(Editor& editor, int key) {
    if (!is_painting_tool(editor)) return false;
    Brush& brush = editor.brush;
    if (key == '[' || key == ']') {
        brush.radius =
            std::clamp(brush.radius * (key == '[' ? 1 / 1.15 : 1.15), min_brush_radius, max_brush_radius);
        return true;
    }
    if (key < '0' || key > '9') return false;
    brush.strength = key == '0' ? 1 : (key - '0') / 10.0;
    return true;
}

}  // namespace probewarp
