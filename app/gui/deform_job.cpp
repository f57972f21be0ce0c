#include "gui/deform_job.h"

#include <chrono>
#include <new>
#include <system_error>
#include <utility>

#include "editor/painting.h"
#include "gui/app.h"

namespace probewarp {

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The binding that the document's weights are settled on: its own, or during a stroke the one that this
/// began on. Null where there is none yet.
std::shared_ptr<const Binding> present_binding(const Editor& editor) {
    const auto& binding = editor.deformation.binding;
    const bool serves =
        is_stroking(editor) ? fits(binding.get(), editor.document) : is_bound(binding.get(), editor.document);
    return serves ? binding : nullptr;
}

Deformation work_out(DeformJob& job, const std::shared_ptr<const Binding>& present,
                     const std::shared_ptr<const Binding>& before) {
    struct WakeUp {
        ~WakeUp() { glfwPostEmptyEvent(); }
    } wake_up;
    const auto binding = present ? present : make_binding(job.document, before, &job.given_up);
    job.bound = true;
    const auto start = Clock::now();
    Deformation made;
    pose(made, job.document, binding);
    job.milliseconds = milliseconds_since(start);
    return made;
}

void start(App& app) {
    auto job = std::make_unique<DeformJob>();
    const auto present = present_binding(app.editor);
    job->document = app.editor.document;
    job->binds = !present;
    job->since = ImGui::GetTime();
    const auto work = [&job = *job, present, before = app.last_binding] {
        return work_out(job, present, before);
    };
    try {
        job->result = std::async(std::launch::async, work);
    } catch (const std::system_error&) {  // there is no thread for it: the window waits
        std::packaged_task<Deformation()> here(work);
        job->result = here.get_future();
        here();
    }
    app.deform_job = std::move(job);
}

/// The job failed: it is not tried again before something changes that may help.
void remember_failure(App& app, const DeformJob& job, const std::string& reason) {
    app.failure = {job.document, !job.bound, reason};
    say(app, Tone::error, reason);
}

/// Takes what the job has, where it is there within `patience`.
void finish(App& app, std::chrono::milliseconds patience) {
    if (app.deform_job->result.wait_for(patience) != std::future_status::ready) return;
    const std::unique_ptr<DeformJob> ended = std::move(app.deform_job);
    app.wake();
    try {
        app.editor.next_deformation = ended->result.get();
        // The cache of another one may still be in use by a job that was abandoned.
        if (ended->binds) app.last_binding = app.editor.next_deformation->binding;
        app.deform_milliseconds = ended->milliseconds;
    } catch (const GivenUp&) {
    } catch (const std::bad_alloc&) {
        remember_failure(app, *ended, "There is not enough memory for the weights; choose a coarser mesh.");
    } catch (const std::exception& error) {
        remember_failure(app, *ended, error.what());
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
bool fails(const App& app) {
    if (!app.failure) return false;
    const Document &failed = app.failure->document, &present = app.editor.document;
    return app.failure->binding ? binds_alike(failed, present) : unposed(failed) == unposed(present);
}

bool wants_job(const App& app) {
    const Editor& editor = app.editor;
    if (!has_picture(editor) || defers_deformation(editor) || editor.next_deformation) return false;
    if (present_binding(editor)) {
        if (settles_at_once(editor)) return false;
    } else if (is_stroking(editor)) {
        return false;  // a stroke keeps the mesh that it began on
    }
    // One that cannot be interrupted where it is may still have all its memory: not one more each time.
    return app.abandoned_jobs.size() < 2 && !fails(app);
}

/// What was replaced or undone meanwhile is not worth waiting for; a probe that is still being dragged is.
bool is_outdated(const DeformJob& job, const Editor& editor) {
    if (!same_means(job.document, editor.document)) return true;
    if (job.binds) return false;
    return !present_binding(editor) || settles_at_once(editor);
}

}  // namespace

std::string why_not_deformed(const App& app) {
    if (is_deformed(app.editor)) return {};
    return fails(app) ? "The weights cannot be worked out: " + app.failure->reason
                      : "The weights are still being worked out.";
}

void update_deformation(App& app) {
    Editor& editor = app.editor;
    if (app.deform_job) {
        if (is_outdated(*app.deform_job, editor))
            abandon(app);
        else
            finish(app, 0ms);
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
