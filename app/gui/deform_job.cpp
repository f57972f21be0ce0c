#include "gui/deform_job.h"

#include <chrono>
#include <new>

#include "editor/painting.h"
#include "gui/app.h"

namespace probewarp {

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The editor's binding where it is the document's own; else null.
std::shared_ptr<const Binding> present_binding(const Editor& editor) {
    const auto& binding = editor.deformation.binding;
    return is_bound(binding.get(), editor.document) ? binding : nullptr;
}

void start(App& app) {
    app.deform_job = std::make_unique<DeformJob>();
    DeformJob& job = *app.deform_job;
    const auto present = present_binding(app.editor);
    job.document = app.editor.document;
    job.binds = !present;
    job.since = ImGui::GetTime();
    job.result = std::async(std::launch::async, [&job, present, before = app.last_binding] {
        struct WakeUp {
            ~WakeUp() { glfwPostEmptyEvent(); }
        } wake_up;
        const auto binding = present ? present : make_binding(job.document, before, &job.given_up);
        const auto start = Clock::now();
        Deformation made;
        pose(made, job.document, binding);
        job.milliseconds = milliseconds_since(start);
        return made;
    });
}

/// Takes what the job has, where it is there within `patience`.
void finish(App& app, std::chrono::milliseconds patience) {
    if (app.deform_job->result.wait_for(patience) != std::future_status::ready) return;
    const std::unique_ptr<DeformJob> ended = std::move(app.deform_job);
    app.wake();
    try {
        app.editor.next_deformation = ended->result.get();
        app.last_binding = app.editor.next_deformation->binding;
        app.deform_milliseconds = ended->milliseconds;
    } catch (const GivenUp&) {
    } catch (const std::bad_alloc&) {
        app.undeformable = ended->document;
        app.undeformable_reason = "There is not enough memory for the weights; choose a coarser mesh.";
        say(app, Tone::error, app.undeformable_reason);
    } catch (const std::exception& error) {
        app.undeformable = ended->document;
        app.undeformable_reason = error.what();
        say(app, Tone::error, app.undeformable_reason);
    }
}

/// Leaves the job to come to its end by itself. What it has of the last binding's cache it still uses, so the
/// next job begins without.
void abandon(App& app) {
    app.deform_job->given_up = true;
    if (app.deform_job->binds) app.last_binding.reset();
    app.abandoned_jobs.push_back(std::move(app.deform_job));
}

/// Whether what was worked out last failed, and would again.
bool is_undeformable(const App& app) {
    return app.undeformable && binds_alike(*app.undeformable, app.editor.document);
}

bool wants_job(const App& app) {
    const Editor& editor = app.editor;
    if (!has_picture(editor) || defers_deformation(editor) || editor.next_deformation) return false;
    if (present_binding(editor)) {
        if (refining_work(editor.deformation, editor.document) <= refined_at_once) return false;
    } else if (editor.gesture && editor.gesture->stroke) {
        return false;  // a stroke keeps the mesh that it began on
    }
    // One that cannot be interrupted where it is may still have all its memory: not one more each time.
    return app.abandoned_jobs.size() < 2 && !is_undeformable(app);
}

}  // namespace

std::string why_not_deformed(const App& app) {
    if (is_deformed(app.editor)) return {};
    return is_undeformable(app) ? "The weights cannot be worked out: " + app.undeformable_reason
                                : "The weights are still being worked out.";
}

void update_deformation(App& app) {
    Editor& editor = app.editor;
    if (app.deform_job) {
        // What was replaced meanwhile is not worth waiting for; a probe that is still being dragged is.
        if (same_means(app.deform_job->document, editor.document))
            finish(app, 0ms);
        else
            abandon(app);
    }
    std::erase_if(app.abandoned_jobs,
                  [](const auto& job) { return job->result.wait_for(0ms) == std::future_status::ready; });
    if (!app.deform_job && wants_job(app)) {
        start(app);
        finish(app, 12ms);
    }
    if (is_shaded(app)) return;
    const bool comes_from_job = editor.next_deformation.has_value();
    const unsigned long version = editor.deformation.version;
    const auto start_time = Clock::now();
    refresh(editor);
    if (editor.deformation.version != version && !comes_from_job)
        app.deform_milliseconds = milliseconds_since(start_time);
}

}  // namespace probewarp
