#include "gui/jobs.h"

#include <algorithm>
#include <chrono>
#include <system_error>

#include "gui/app.h"
#include "gui/shown_text.h"
#include "gui/widgets.h"
#include "raster/mipmaps.h"

namespace probewarp {

namespace {

void carry_out(Job& job, const Work& work) {
    try {
        job.finish = work(job);
    } catch (...) {
        job.failure = std::current_exception();
    }
    job.done = true;
    glfwPostEmptyEvent();
}

}  // namespace

void start_job(App& app, std::string title, JobKind kind, Work work) {
    app.jobs.running.push_back(std::make_unique<Job>());
    Job& job = *app.jobs.running.back();
    job.title = std::move(title);
    job.kind = kind;
    app.wake();
    try {
        job.thread = std::jthread([&job, work] { carry_out(job, work); });
    } catch (const std::system_error&) {  // the system has none left
        carry_out(job, work);
    } catch (...) {
        app.jobs.running.pop_back();
        throw;
    }
}

namespace {

/// Hands rows over for a part of a frame's time, so that the window and Cancel stay alive.
void advance_upload(App& app) {
    using Clock = std::chrono::steady_clock;
    const auto until = Clock::now() + std::chrono::milliseconds(30);
    PictureUpload& steps = app.jobs.uploading->steps;
    app.wake();
    try {
        while (!steps.done() && Clock::now() < until) steps.step();
        if (!steps.done()) return;
        app.renderer->set_picture(steps.take());
    } catch (const std::exception& error) {
        app.jobs.uploading.reset();
        return say(app, Tone::error, error.what());
    }
    app.uploaded = app.jobs.uploading->picture;
    app.jobs.uploading.reset();
    app.jobs.preparing.reset();
}

}  // namespace

void advance_jobs(App& app) {
    if (app.jobs.uploading) advance_upload(app);
    for (std::size_t i = 0; i < app.jobs.running.size();) {
        if (!app.jobs.running[i]->done) {
            ++i;
            continue;
        }
        const std::unique_ptr<Job> job = std::move(app.jobs.running[i]);
        app.jobs.running.erase(app.jobs.running.begin() + std::ptrdiff_t(i));
        app.wake();
        if (job->given_up && (job->kind != JobKind::writing || !job->finish)) {
            say(app, Tone::hint, "Cancelled.");
            continue;
        }
        if (job->failure)
            say(app, Tone::error, failure_text(job->failure));
        else if (job->finish)
            job->finish(app);
    }
}

void prepare_picture(App& app, PicturePtr picture) {
    if (app.jobs.preparing == picture) return;
    app.jobs.preparing = picture;
    start_job(app, "", JobKind::background, [picture](Job&) -> std::function<void(App&)> {
        auto levels = std::make_shared<std::vector<Image>>(smaller_levels(picture->image));
        return [picture, levels](App& a) {
            if (picture != a.editor.document.picture) {  // another was opened meanwhile
                if (a.jobs.preparing == picture) a.jobs.preparing.reset();
                return;
            }
            try {
                a.jobs.uploading = std::make_unique<Upload>(picture, std::move(*levels));
            } catch (const std::exception& error) {
                say(a, Tone::error, error.what());
            }
        };
    });
}

namespace {

bool waits_for(const Job& job) { return job.kind != JobKind::background && !job.given_up; }

}  // namespace

bool is_busy(const App& app) {
    return std::any_of(app.jobs.running.begin(), app.jobs.running.end(),
                       [](const auto& job) { return waits_for(*job); });
}

void draw_progress(App& app) {
    if (!is_busy(app)) {
        app.busy_since = -1;
        return;
    }
    app.wake();
    if (app.busy_since < 0) app.busy_since = ImGui::GetTime();
    if (ImGui::GetTime() - app.busy_since < 0.15) return;  // what is over at once needs no dialog
    Job& job = **std::find_if(app.jobs.running.begin(), app.jobs.running.end(),
                              [](const auto& j) { return waits_for(*j); });
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({app.px(360), 0});
    ImGui::Begin("##progress", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_AlwaysAutoResize);
    keep_messages_off(app);
    draw_wrapped(app, job.title, 2);
    // Where nobody knows how far it is the bar goes to and fro.
    const float to_and_fro = float(0.5 + 0.5 * std::sin(ImGui::GetTime() * 3)), progress = job.progress;
    ImGui::ProgressBar(progress < 0 ? to_and_fro : progress, {-1, app.px(6)}, "");
    if (ImGui::Button("Cancel", {app.px(96), app.px(28)}))
        job.given_up = true;  // said when the thread has ended
    ImGui::End();
}

}  // namespace probewarp
