#include "gui/deform_choice.h"

#include <fmt/format.h>

#include "gui/app.h"

namespace probewarp {

bool wants_trial(const App& app) {
    const bool still = app.frames_wanted <= 0 && !app.editor.gesture && !app.deform_job && !is_busy(app);
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
    const DeformChoice choice =
        choose_deform(app.editor.deform_by, app.renderer_label, app.deform_measurement.times);
    if (choice.by == DeformBy::processor) return choice;
    if (!find_blend_method(app.editor.document.blend)->summed)
        return {DeformBy::processor, "the vertex shader blends by DLB only"};
    if (app.editor.comparison)
        return {DeformBy::processor, "the vertex shader cannot show two blends at once"};
    return choice;
}

bool is_shaded(const App& app) {
    const Editor& editor = app.editor;
    const bool drags = editor.gesture && (editor.gesture->kind == Gesture::Kind::move ||
                                          editor.gesture->kind == Gesture::Kind::turn);
    return drags && deform_choice(app).by == DeformBy::shader &&
           is_bound(editor.deformation.binding.get(), editor.document) &&
           unposed(editor.deformation.source) == unposed(editor.document);
}

std::string deform_facts(const App& app) {
    const bool shader = deform_choice(app).by == DeformBy::shader;
    const char* const by = shader ? "shader" : "processor";
    const std::string text = is_shaded(app)
                                 ? "deform by shader"
                                 : fmt::format("deform {:.2f} ms, drags by {}", app.deform_milliseconds, by);
    const auto& times = app.deform_measurement.times;
    if (!times) return text;
    return fmt::format("{} ({:.2f} ms; {} {:.2f} ms)", text, shader ? times->shader : times->processor,
                       shader ? "processor" : "shader", shader ? times->processor : times->shader);
}

std::string deform_explanation(const App& app) {
    const DeformChoice choice = deform_choice(app);
    const auto& times = app.deform_measurement.times;
    std::string text = is_shaded(app)
                           ? std::string("The vertex shader moves the vertices.")
                           : fmt::format("The processor moved the vertices in {:.2f} ms, the last time.",
                                         app.deform_milliseconds);
    text += fmt::format("\nWhile a probe is dragged the {} moves them: {}. The menu View has the choice.",
                        choice.by == DeformBy::shader ? "vertex shader" : "processor", choice.why);
    if (times)
        text += fmt::format(
            "\nMeasured once, a step of a drag of {} vertices by {} probes, blended by DLB: processor {:.3f} "
            "ms, vertex shader {:.3f} ms.",
            DeformTrial::vertices, DeformTrial::probes, times->processor, times->shader);
    return text;
}

}  // namespace probewarp
