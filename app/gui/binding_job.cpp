#include "gui/binding_job.h"

#include <chrono>
#include <new>

#include "gui/app.h"

namespace probewarp {

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

void start(App& app, const std::shared_ptr<const Binding>& before) {
    app.binding_job = std::make_unique<BindingJob>();
    BindingJob& job = *app.binding_job;
    job.document = app.editor.document;
    job.since = ImGui::GetTime();
    job.result = std::async(std::launch::async, [&job, before] {
        struct WakeUp {
            ~WakeUp() { glfwPostEmptyEvent(); }
        } wake_up;
        return make_binding(job.document, before, &job.given_up);
    });
}

/// Takes what the job has, where it is there within `patience`.
void finish(App& app, std::chrono::milliseconds patience) {
    if (app.binding_job->result.wait_for(patience) != std::future_status::ready) return;
    const std::unique_ptr<BindingJob> ended = std::move(app.binding_job);
    app.wake();
    try {
        auto binding = ended->result.get();
        app.last_binding = binding;
        app.editor.next_binding = std::move(binding);
    } catch (const GivenUp&) {
    } catch (const std::bad_alloc&) {
        app.unbound = ended->document;
        app.unbound_reason = "There is not enough memory for the weights; choose a coarser mesh.";
        say(app, Tone::error, app.unbound_reason);
    } catch (const std::exception& error) {
        app.unbound = ended->document;
        app.unbound_reason = error.what();
        say(app, Tone::error, app.unbound_reason);
    }
}

/// Leaves the job to come to its end by itself. What it has of the last binding's cache it still uses, so the
/// next job begins without.
void abandon(App& app) {
    app.binding_job->given_up = true;
    app.abandoned_jobs.push_back(std::move(app.binding_job));
    app.last_binding.reset();
}

/// Whether the binding that was worked out last failed, and would again.
bool is_unbindable(const App& app) { return app.unbound && binds_alike(*app.unbound, app.editor.document); }

bool wants_binding(const App& app) {
    const Editor& editor = app.editor;
    for (const auto& binding : {editor.deformation.binding, editor.next_binding})
        if (is_bound(binding.get(), editor.document)) return false;
    if (editor.gesture && editor.gesture->stroke) return false;  // a stroke keeps the mesh that it began on
    // One that cannot be interrupted where it is may still have all its memory: not one more each time.
    return app.abandoned_jobs.size() < 2 && !is_unbindable(app);
}

}  // namespace

std::string why_not_deformed(const App& app) {
    if (is_deformed(app.editor)) return {};
    return is_unbindable(app) ? "The weights cannot be worked out: " + app.unbound_reason
                              : "The weights are still being worked out.";
}

void update_deformation(App& app) {
    Editor& editor = app.editor;
    if (app.binding_job) {
        // What was replaced meanwhile is not worth waiting for; a probe that is still being dragged is.
        if (same_means(app.binding_job->document, editor.document))
            finish(app, 0ms);
        else
            abandon(app);
    }
    std::erase_if(app.abandoned_jobs,
                  [](const auto& job) { return job->result.wait_for(0ms) == std::future_status::ready; });
    if (!app.binding_job && wants_binding(app)) {
        start(app, app.last_binding);
        finish(app, 12ms);
    }
    if (is_shaded(app)) return;
    const auto before = Clock::now();
    const unsigned long version = editor.deformation.version;
    refresh(editor);
    if (editor.deformation.version != version)
        app.deform_milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - before).count();
}

}  // namespace probewarp
