#include "gui/binding_job.h"

#include <chrono>

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

/// Takes what the job has, where it is there within `patience`. False while it is not.
bool finish(App& app, std::chrono::milliseconds patience) {
    BindingJob& job = *app.binding_job;
    if (job.result.wait_for(patience) != std::future_status::ready) return false;
    const std::unique_ptr<BindingJob> ended = std::move(app.binding_job);
    app.wake();
    try {
        auto binding = ended->result.get();
        app.last_binding = binding;
        app.editor.next_binding = std::move(binding);
    } catch (const GivenUp&) {
    } catch (const std::exception& error) {
        app.unbound = ended->document;
        say(app, Tone::error, error.what());
    }
    return true;
}

/// Leaves the job to come to its end by itself. What it has of the last binding's cache it still uses, so the
/// next job begins without.
void abandon(App& app) {
    app.binding_job->given_up = true;
    app.abandoned_jobs.push_back(std::move(app.binding_job));
    app.last_binding.reset();
}

bool wants_binding(const App& app) {
    if (is_deformation_ready(app)) return false;
    return !app.unbound || !(*app.unbound == app.editor.document);
}

}  // namespace

bool is_deformation_ready(const App& app) {
    const Binding* binding = app.editor.deformation.binding.get();
    return is_bound(binding, app.editor.document) && fits(binding, app.editor.document);
}

void update_deformation(App& app) {
    Editor& editor = app.editor;
    if (app.binding_job) {
        // What was replaced meanwhile is not worth waiting for; a probe that is still being dragged is.
        const Document& bound = app.binding_job->document;
        if (bound.picture != editor.document.picture || !(bound.mesh == editor.document.mesh) ||
            !(bound.weights == editor.document.weights))
            abandon(app);
        else
            finish(app, 0ms);
    }
    std::erase_if(app.abandoned_jobs,
                  [](const auto& job) { return job->result.wait_for(0ms) == std::future_status::ready; });
    if (!app.binding_job && wants_binding(app)) {
        start(app, app.last_binding);
        finish(app, 12ms);
    }
    const auto before = Clock::now();
    const unsigned long version = editor.deformation.version;
    refresh(editor);
    if (editor.deformation.version != version)
        app.deform_milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - before).count();
}

}  // namespace probewarp
