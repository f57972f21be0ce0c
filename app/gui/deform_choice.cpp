#include "gui/deform_choice.h"

#include <fmt/format.h>

#include "gui/app.h"

namespace probewarp {

bool wants_trial(const App& app) {
    const bool still = app.frames_wanted <= 0 && !app.editor.gesture && !app.binding_job && !is_busy(app);
    return !app.deform_measurement.over && app.shown.picture && still;
}

void advance_trial(App& app) {
    DeformMeasurement& measurement = app.deform_measurement;
    try {
        if (!measurement.trial) measurement.trial = std::make_unique<DeformTrial>();
        measurement.trial->step();
        if (!measurement.trial->done()) return;
        measurement.times = measurement.trial->times();
    } catch (const Error&) {  // the choice says that it could not be measured
    }
    measurement.over = true;
    measurement.trial.reset();
    app.wake();
}

DeformChoice deform_choice(const App& app) {
    return choose_deform(app.editor.deform_by, app.renderer_label, app.deform_measurement.times);
}

bool is_shaded(const App& app) {
    const Editor& editor = app.editor;
    const bool drags = editor.gesture && (editor.gesture->kind == Gesture::Kind::move ||
                                          editor.gesture->kind == Gesture::Kind::turn);
    if (!drags || !find_blend_method(editor.document.blend)->summed || editor.comparison) return false;
    return is_bound(editor.deformation.binding.get(), editor.document) &&
           unposed(editor.deformation.source) == unposed(editor.document) &&
           deform_choice(app).by == DeformBy::shader;
}

std::string deform_facts(const App& app) {
    const bool shader = deform_choice(app).by == DeformBy::shader;
    const char* const by = shader ? "shader" : "processor";
    const auto& times = app.deform_measurement.times;
    if (!times) return fmt::format("by {}", by);
    return fmt::format("by {} ({:.2f} ms; {} {:.2f} ms)", by, shader ? times->shader : times->processor,
                       shader ? "processor" : "shader", shader ? times->processor : times->shader);
}

std::string deform_explanation(const App& app) {
    const DeformChoice choice = deform_choice(app);
    const auto& times = app.deform_measurement.times;
    std::string text = fmt::format("While a probe is dragged the {}: {}. The menu View has the choice.",
                                   choice.by == DeformBy::shader ? "vertex shader moves what blends by DLB"
                                                                 : "processor moves the vertices",
                                   choice.why);
    if (times)
        text += fmt::format(
            "\nMeasured once, a step of a drag of {} vertices by {} probes: processor {:.3f} ms, vertex "
            "shader "
            "{:.3f} ms.",
            DeformTrial::vertices, DeformTrial::probes, times->processor, times->shader);
    return text;
}

}  // namespace probewarp
