#include "gui/jobs.h"

#include <algorithm>
#include <chrono>
#include <new>

#include "gui/app.h"
#include "gui/shown_text.h"
#include "gui/widgets.h"
#include "raster/mipmaps.h"

namespace probewarp {

void start_job(App& app, std::string title, JobKind kind, Work work) {
    auto job = std::make_unique<Job>();
    job->title = std::move(title);
    job->kind = kind;
    job->thread = std::jthread([&job = *job, work = std::move(work)] {
        try {
            job.finish = work(job);
        } catch (const std::bad_alloc&) {
            job.error = "There is not enough memory.";
        } catch (const std::exception& error) {
            job.error = error.what();
        }
        job.done = true;
        glfwPostEmptyEvent();
    });
    app.jobs.running.push_back(std::move(job));
    app.wake();
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
    } catch (const std::exception& error) {
        say(app, Tone::error, error.what());
        return app.jobs.uploading.reset();
    }
    if (!steps.done()) return;
    app.renderer->set_picture(steps.take());
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
        if (!job->error.empty())
            say(app, Tone::error, job->error);
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
