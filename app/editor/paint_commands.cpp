#include "editor/paint_commands.h"

#include <algorithm>

#include "editor/painting.h"
#include "model/paint_ops.h"

namespace probewarp {

namespace {

std::size_t chosen_place(const Editor& editor) { return place_of(editor.document, editor.selected); }

/// Has the window work out a document beside itself. The deformation is copied, and settled there where it is
/// not the document's own yet: the window goes on with its own.
void add_task(Editor& editor, std::string label, std::function<Document(const Deformation&)> work) {
    refresh(editor);
    if (!is_bound(editor.deformation.binding.get(), editor.document)) {
        editor.notice = "The weights are still being worked out.";
        return;
    }
    editor.tasks.push_back(
        {std::move(label), [deformation = std::make_shared<Deformation>(editor.deformation),
                            document = editor.document, work = std::move(work)] {
             pose(*deformation, document, deformation->binding);
             return work(*deformation);
         }});
}

/// A task that gives the chosen probe a new map, worked out from its shares.
void reshape(Editor& editor, const char* what,
             std::function<PaintMap(const PaintMap&, ShareRaster)> operation) {
    const std::size_t probe = chosen_place(editor);
    add_task(editor, what + (" " + editor.document.probes[probe].name),
             [probe, operation = std::move(operation)](const Deformation& deformation) {
                 Document document = deformation.source;
                 const PaintMap map = map_of(document, document.probes[probe].paint);
                 document.probes[probe].paint =
                     std::make_shared<const PaintMap>(operation(map, share_raster(deformation, probe, map)));
                 return document;
             });
}

void set_paint(Editor& editor, PaintPtr paint, const char* what) {
    Probe& probe = *selected_probe(editor);
    probe.paint = std::move(paint);
    commit(editor, what + (" " + probe.name));
}

bool has_paint(const Probe& probe) { return probe.paint != nullptr; }

/// The probe's paint and its counterpart's become each other's mirror images.
void mirror_paint(Editor& editor, Side side) {
    const MirrorAxis axis = mirror_axis(editor);
    const std::size_t probe = chosen_place(editor), other = counterpart(editor.document, probe, axis);
    say_locked_stay(editor, [&](const Probe& p) { return &p == &editor.document.probes[other]; });
    add_task(editor, "Mirror " + editor.document.probes[probe].name,
             [probe, other, axis, side](const Deformation& deformation) {
                 Document document = deformation.source;
                 const PictureFrame frame = frame_of(document.picture->image);
                 const PaintMap own = map_of(document, document.probes[probe].paint);
                 const PaintMap others = map_of(document, document.probes[other].paint);
                 const auto mirror = [&](std::size_t onto, const PaintMap& old, const PaintMap& from) {
                     PaintMap map = mirrored_paint(old, from, frame, axis, side);
                     document.probes[onto].paint =
                         is_blank(map) ? nullptr : std::make_shared<const PaintMap>(std::move(map));
                 };
                 mirror(probe, own, others);
                 if (other != probe && !document.probes[other].locked) mirror(other, others, own);
                 return document;
             });
}

}  // namespace

std::string needs_unlocked(const Editor& editor) {
    const Probe* probe = find_probe(editor.document, editor.selected);
    if (!probe) return "Choose a probe first";
    return probe->locked ? probe->name + " is locked; unlock it first" : "";
}
std::string needs_paint(const Editor& editor) {
    const Probe* probe = find_probe(editor.document, editor.selected);
    return !probe ? "Choose a probe first" : !probe->paint ? "The probe has no paint" : "";
}
std::string needs_own_paint(const Editor& editor) {
    std::string why_not = needs_unlocked(editor);
    return why_not.empty() ? needs_paint(editor) : why_not;
}
std::string needs_any_paint(const Editor& editor) {
    if (!is_painted(editor.document)) return "Nothing is painted";
    const auto stays = [](const Probe& probe) { return probe.locked || !probe.paint; };
    const auto& probes = editor.document.probes;
    return std::all_of(probes.begin(), probes.end(), stays) ? "Every probe that has paint is locked" : "";
}
std::string needs_copied_paint(const Editor& editor) {
    return editor.copied_paint ? needs_unlocked(editor) : "Copy a probe's paint first";
}
std::string needs_stiffness(const Editor& editor) {
    return editor.document.stiffness ? "" : "No stiffness is painted";
}

void fill_paint(Editor& editor) {
    const PaintMap map = map_of(editor.document, selected_probe(editor)->paint);
    set_paint(editor, std::make_shared<const PaintMap>(filled(map, float(editor.brush.value))), "Fill");
}

void invert_paint(Editor& editor) {
    reshape(editor, "Invert", [](const PaintMap& map, ShareRaster raster) {
        return paint_of(map, inverted(std::move(raster)));
    });
}

void blur_paint(Editor& editor) {
    reshape(editor, "Blur", [](const PaintMap& map, ShareRaster raster) {
        return paint_of(map, blurred(raster, std::max(map.width, map.height) / 100.0));
    });
}

void level_paint(Editor& editor, float black, float white, float gamma) {
    reshape(editor, "Levels of", [=](const PaintMap& map, ShareRaster raster) {
        return paint_of(map, levelled(std::move(raster), black, white, gamma));
    });
}

void copy_paint(Editor& editor) { editor.copied_paint = selected_probe(editor)->paint; }
void paste_paint(Editor& editor) { set_paint(editor, editor.copied_paint, "Paste paint onto"); }
void mirror_left_to_right(Editor& editor) { mirror_paint(editor, Side::left); }
void mirror_right_to_left(Editor& editor) { mirror_paint(editor, Side::right); }
void limit_paint(Editor& editor) {
    say_locked_stay(editor, has_paint);
    add_task(editor, "Limit paint",
             [](const Deformation& deformation) { return limited_paint(deformation, 4); });
}
void normalise_paint(Editor& editor) {
    say_locked_stay(editor, has_paint);
    add_task(editor, "Normalise paint", &normalised_paint);
}
void clear_paint(Editor& editor) { set_paint(editor, nullptr, "Clear paint of"); }

void clear_all_paint(Editor& editor) {
    say_locked_stay(editor, has_paint);
    for (Probe& probe : editor.document.probes)
        if (!probe.locked) probe.paint = nullptr;
    commit(editor, "Clear all paint");
}

void clear_stiffness(Editor& editor) {
    editor.document.stiffness = nullptr;
    commit(editor, "Clear stiffness");
}

}  // namespace probewarp
