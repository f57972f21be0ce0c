#include "gui/jobs.h"

#include <algorithm>
#include <chrono>
#include <new>

#include "gui/app.h"
#include "gui/widgets.h"
#include "render/mipmaps.h"

namespace probewarp {

void start_job(App& app, std::string title, JobKind kind, Work work) {
    auto job = std::make_unique<Job>();
    job->title = std::move(title);
    job->kind = kind;
    job->thread = std::jthread([&job = *job, work = std::move(work)] {
        try {
            job.finish = work(job.given_up);
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

/// Does steps for a part of a frame's time, so that the window and Cancel stay alive. False where one failed.
template <class Steps>
bool advance(App& app, Steps& steps) {
    using Clock = std::chrono::steady_clock;
    const auto until = Clock::now() + std::chrono::milliseconds(30);
    app.wake();
    try {
        while (!steps.done() && Clock::now() < until) steps.step();
        return true;
    } catch (const std::exception& error) {
        say(app, Tone::error, error.what());
        return false;
    }
}

void advance_upload(App& app) {
    const bool good = advance(app, app.jobs.uploading->steps);
    if (good && !app.jobs.uploading->steps.done()) return;
    const std::unique_ptr<Upload> upload = std::move(app.jobs.uploading);
    if (!good) return;
    app.renderer->set_picture(upload->steps.take());
    app.uploaded = upload->picture;
    app.jobs.preparing.reset();
}

void advance_export(App& app) {
    if (!advance(app, *app.jobs.exporting)) return app.jobs.exporting.reset();
    if (!app.jobs.exporting->done()) return;
    Image image = app.jobs.exporting->take();
    app.jobs.exporting.reset();
    app.jobs.exported(app, std::move(image));
}

}  // namespace

void advance_jobs(App& app) {
    if (app.jobs.uploading && !app.jobs.exporting) advance_upload(app);
    if (app.jobs.exporting) advance_export(app);
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
    start_job(app, "", JobKind::background, [picture](const auto&) -> std::function<void(App&)> {
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
    return app.jobs.exporting || std::any_of(app.jobs.running.begin(), app.jobs.running.end(),
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
    const auto job = std::find_if(app.jobs.running.begin(), app.jobs.running.end(),
                                  [](const auto& j) { return waits_for(*j); });
    const bool exports = app.jobs.exporting != nullptr;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({app.px(360), 0});
    ImGui::Begin("##progress", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::TextUnformatted(exports ? app.jobs.export_title.c_str() : (*job)->title.c_str());
    // A thread's progress is not known: its bar goes to and fro.
    const float to_and_fro = float(0.5 + 0.5 * std::sin(ImGui::GetTime() * 3));
    ImGui::ProgressBar(exports ? float(app.jobs.exporting->progress()) : to_and_fro, {-1, app.px(6)}, "");
    if (ImGui::Button("Cancel", {app.px(96), app.px(28)})) {
        if (exports) {
            app.jobs.exporting.reset();
            say(app, Tone::hint, "Cancelled.");
        } else {
            (*job)->given_up = true;  // said when the thread has ended
        }
    }
    ImGui::End();
}

}  // namespace probewarp
