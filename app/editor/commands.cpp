#include "editor/commands.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "editor/comparison.h"
#include "editor/paint_commands.h"
#include "editor/painting.h"
#include "editor/tools.h"

namespace probewarp {

namespace {

std::string needs_picture(const Editor& e) { return has_picture(e) ? "" : "Open a picture first"; }
std::string needs_probe(const Editor& e) {
    return find_probe(e.document, e.selected) ? "" : "Choose a probe first";
}
std::string needs_pose(const Editor& e) {
    const auto& probes = e.document.probes;
    if (std::all_of(probes.begin(), probes.end(), at_rest)) return "No probe has moved";
    const auto stays = [](const Probe& probe) { return probe.locked || at_rest(probe); };
    return std::all_of(probes.begin(), probes.end(), stays) ? "Every probe that has moved is locked" : "";
}
std::string needs_undo(const Editor& e) { return e.history.at > 0 ? "" : "There is nothing to undo"; }
std::string needs_redo(const Editor& e) {
    return e.history.at + 1 < e.history.steps.size() ? "" : "There is nothing to redo";
}

template <Request R>
void ask(Editor& editor) {
    editor.requests.push_back(R);
}

void delete_probe(Editor& editor) {
    const Probe* probe = selected_probe(editor);
    const std::string label = "Delete " + probe->name;
    std::erase_if(editor.document.probes, [id = probe->id](const Probe& p) { return p.id == id; });
    editor.selected = 0;
    editor.hover = {};
    commit(editor, label);
}

void duplicate_probe(Editor& editor) {
    const Probe original = *selected_probe(editor);
    Probe copy = new_probe(editor.document, original.rest);
    const double aside = original.radius / 2;
    copy.rest = original.rest + glm::dvec2(aside, 0);
    copy.now = original.now + glm::dvec2(aside, 0);
    copy.angle = original.angle;
    copy.radius = original.radius;
    if (add_probe(editor, copy)) commit(editor, "Duplicate " + original.name);
}

void reset_probe(Editor& editor) {
    put_to_rest(*selected_probe(editor));
    commit(editor, "Reset " + selected_probe(editor)->name);
}

void reset_pose(Editor& editor) {
    say_locked_stay(editor, [](const Probe& probe) { return !at_rest(probe); });
    for (Probe& probe : editor.document.probes)
        if (!probe.locked) put_to_rest(probe);
    commit(editor, "Reset pose");
}

void toggle_lock(Editor& editor) {
    Probe& probe = *selected_probe(editor);
    probe.locked = !probe.locked;
    commit(editor, (probe.locked ? "Lock " : "Unlock ") + probe.name);
}

template <ShownWeights W>
void toggle_weights(Editor& editor) {
    editor.shown_weights = editor.shown_weights == W ? ShownWeights::none : W;
    editor.shown_by_brush = false;
}
template <ShownWeights W>
bool shows_weights(const Editor& editor) {
    return editor.shown_weights == W;
}

void show_whole(Editor& editor) { editor.fit_wanted = true; }
void show_actual(Editor& editor) { zoom_canvas(editor, editor.canvas_size / 2.0, 1 / editor.view.zoom); }
void zoom_in(Editor& editor) { zoom_canvas(editor, editor.canvas_size / 2.0, 1.5); }
void zoom_out(Editor& editor) { zoom_canvas(editor, editor.canvas_size / 2.0, 1 / 1.5); }

template <DeformBy By>
void deform_by(Editor& editor) {
    editor.deform_by = By;
}
template <DeformBy By>
bool deforms_by(const Editor& editor) {
    return editor.deform_by == By;
}

constexpr Command all[] = {
    {"File", "New", {'N', true}, nullptr, &ask<Request::new_document>},
    {"File", "Open…", {'O', true}, nullptr, &ask<Request::open>},
    {"File", "Save", {'S', true}, &needs_picture, &ask<Request::save>, true},
    {"File", "Save as…", {'S', true, true}, &needs_picture, &ask<Request::save_as>},
    {"File", "Export…", {'E', true}, &needs_picture, &ask<Request::export_picture>, true},
    {"File", "Import probes (CSV)…", {}, &needs_picture, &ask<Request::import_probes>},
    {"File", "Replace picture…", {}, &needs_picture, &ask<Request::replace_picture>},
    {"File", "Quit", {'Q', true}, nullptr, &ask<Request::quit>, true},
    {"Edit", "Undo", {'Z', true}, &needs_undo, &undo_step},
    {"Edit", "Redo", {'Z', true, true}, &needs_redo, &redo_step},
    {"Edit", "Unselect", {}, &needs_probe, [](Editor& e) { e.selected = 0; }, true},
    {"Probe", "Delete", {key_delete}, &needs_unlocked, &delete_probe},
    {"Probe", "Duplicate", {'D', true}, &needs_probe, &duplicate_probe},
    {"Probe",
     "Lock",
     {'L', true},
     &needs_probe,
     &toggle_lock,
     false,
     [](const Editor& e) {
         return find_probe(e.document, e.selected) && find_probe(e.document, e.selected)->locked;
     }},
    {"Probe", "Put back to rest", {'R', true}, &needs_unlocked, &reset_probe, true},
    {"Probe", "Reset the pose of all", {'R', true, true}, &needs_pose, &reset_pose},
    {"Weights",
     "Show the chosen probe's",
     {'W'},
     &needs_picture,
     &toggle_weights<ShownWeights::chosen>,
     false,
     &shows_weights<ShownWeights::chosen>},
    {"Weights",
     "Show all in the probes' colours",
     {'W', false, true},
     &needs_picture,
     &toggle_weights<ShownWeights::all>,
     false,
     &shows_weights<ShownWeights::all>},
    {"Weights",
     "Iso-lines",
     {'I'},
     &needs_picture,
     [](Editor& e) { e.iso_lines = !e.iso_lines; },
     false,
     [](const Editor& e) { return e.iso_lines; }},
    {"Weights",
     "Mirror strokes",
     {'X'},
     &needs_picture,
     [](Editor& e) { e.mirror = !e.mirror; },
     false,
     [](const Editor& e) { return e.mirror; }},
    {"Weights", "Fill with the brush's value", {}, &needs_unlocked, &fill_paint, true},
    {"Weights", "Invert", {'I', true}, &needs_unlocked, &invert_paint},
    {"Weights", "Blur", {}, &needs_unlocked, &blur_paint},
    {"Weights", "Levels…", {}, &needs_unlocked, &ask<Request::levels>},
    {"Weights", "Copy paint", {'C', true}, &needs_paint, &copy_paint, true},
    {"Weights", "Paste paint", {'V', true}, &needs_copied_paint, &paste_paint},
    {"Weights", "Mirror left to right", {}, &needs_own_paint, &mirror_left_to_right},
    {"Weights", "Mirror right to left", {}, &needs_own_paint, &mirror_right_to_left},
    {"Weights", "Limit to four probes a place", {}, &needs_any_paint, &limit_paint, true},
    {"Weights", "Normalise", {}, &needs_any_paint, &normalise_paint},
    {"Weights", "Clear the probe's paint", {}, &needs_own_paint, &clear_paint, true},
    {"Weights", "Clear all paint", {}, &needs_any_paint, &clear_all_paint},
    {"Weights", "Clear stiffness", {}, &needs_stiffness, &clear_stiffness},
    {"View", "Fit", {'F'}, &needs_picture, &show_whole},
    {"View", "100 %", {'1'}, &needs_picture, &show_actual},
    {"View", "Zoom in", {'='}, &needs_picture, &zoom_in},
    {"View", "Zoom out", {'-'}, &needs_picture, &zoom_out},
    {"View",
     "Show probes",
     {'H'},
     nullptr,
     [](Editor& e) { e.show_probes = !e.show_probes; },
     true,
     [](const Editor& e) { return e.show_probes; }},
    {"View",
     "Show mesh",
     {'M'},
     nullptr,
     [](Editor& e) { e.show_mesh = !e.show_mesh; },
     false,
     [](const Editor& e) { return e.show_mesh; }},
    {"View",
     "Show folded triangles",
     {'M', false, true},
     nullptr,
     [](Editor& e) { e.show_folds = !e.show_folds; },
     false,
     [](const Editor& e) { return e.show_folds; }},
    {"View",
     "Compare two blends",
     {'2'},
     &needs_picture,
     [](Editor& e) {
         compare_with(e, e.comparison ? "" : e.document.blend == "linear" ? "dlb" : "linear");
     },
     false,
     [](const Editor& e) { return e.comparison.has_value(); }},
    {"View",
     "Deform by whichever is quicker",
     {},
     nullptr,
     &deform_by<DeformBy::automatic>,
     true,
     &deforms_by<DeformBy::automatic>},
    {"View",
     "Deform by the processor",
     {},
     nullptr,
     &deform_by<DeformBy::processor>,
     false,
     &deforms_by<DeformBy::processor>},
    {"View",
     "Deform by the graphics card",
     {},
     nullptr,
     &deform_by<DeformBy::shader>,
     false,
     &deforms_by<DeformBy::shader>},
    {"View", "Light theme", {}, nullptr, &ask<Request::switch_theme>, true},
    {"Help", "About Probewarp", {}, nullptr, &ask<Request::about>},
};

constexpr Alias second_keys[] = {
    {{'Y', true}, "Redo"}, {{key_backspace}, "Delete"}, {{'0'}, "Fit"}, {{'+'}, "Zoom in"}};

void nudge(Editor& editor, glm::dvec2 way, bool held) {
    Probe* probe = selected_probe(editor);
    if (!probe) return;
    if (probe->locked) {
        editor.notice = needs_unlocked(editor) + ".";
        return;
    }
    probe->now += way;
    // The step that a held key has begun is made anew: held keys are one step.
    const Nudge last = std::exchange(editor.nudge, {});
    if (held && last.probe == probe->id && last.step == editor.history.at) undo(editor.history);
    const std::size_t before = editor.history.at;
    commit(editor, "Nudge " + probe->name);
    if (editor.history.at != before) editor.nudge = {probe->id, editor.history.at};
}

}  // namespace

std::string to_text(const Shortcut& shortcut) {
    if (shortcut.key == 0) return {};
    std::string text = shortcut.ctrl ? "Ctrl+" : "";
    if (shortcut.shift) text += "Shift+";
    return text + (shortcut.key == key_delete ? "Del" : std::string(1, char(shortcut.key)));
}

std::span<const Command> commands() { return all; }
std::span<const Alias> aliases() { return second_keys; }

const Command& find_command(std::string_view label) {
    const auto found =
        std::find_if(std::begin(all), std::end(all), [&](const Command& c) { return c.label == label; });
    assert(found != std::end(all));
    return *found;
}

void run(Editor& editor, const Command& command) {
    if (editor.gesture) return;  // a drag ends by itself or by Escape
    const std::string why_not = command.why_not ? command.why_not(editor) : "";
    if (why_not.empty())
        command.run(editor);
    else
        editor.notice = why_not + ".";
}

bool press_key(Editor& editor, const Shortcut& key, bool held) {
    if (key == Shortcut{key_escape}) {
        cancel(editor);
        return true;
    }
    if (!key.ctrl && !key.shift && press_brush_key(editor, key.key)) return true;
    for (const Command& command : all)
        if (command.shortcut.key != 0 && command.shortcut == key) {
            run(editor, command);
            return true;
        }
    for (const Alias& alias : second_keys)
        if (alias.key == key) {
            run(editor, find_command(alias.label));
            return true;
        }
    if (editor.gesture || key.ctrl) return false;
    for (const Tool& tool : tools())
        if (key == Shortcut{tool.key}) {
            choose_tool(editor, tool);
            return true;
        }
    const double step = key.shift ? 10 : 1;
    switch (key.key) {
        case key_left:
            nudge(editor, {-step, 0}, held);
            return true;
        case key_right:
            nudge(editor, {step, 0}, held);
            return true;
        case key_up:
            nudge(editor, {0, -step}, held);
            return true;
        case key_down:
            nudge(editor, {0, step}, held);
            return true;
        default:
            return false;
    }
}

}  // namespace probewarp
