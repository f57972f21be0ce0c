// Work that would freeze the window: opening, saving and exporting run beside it, and can be given up.
#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "model/document.h"
#include "render/picture_texture.h"

namespace probewarp {

struct App;

enum class JobKind {
    background,  ///< nobody waits for it
    reading,     ///< the window waits behind a dialog; given up, its result is dropped
    writing,     ///< likewise; given up too late, the file is there, and what follows from that happens
};

/// One piece of work on a thread of its own. `finish` runs on the window's thread.
struct Job {
    std::string title;  ///< "Opening gingerbread.png"
    JobKind kind = JobKind::background;
    std::atomic<bool> done = false;  ///< the thread has ended
    std::atomic<bool> given_up = false;
    std::atomic<float> progress = -1;  ///< [0, 1]; below: nobody knows
    std::exception_ptr failure;        ///< written by the thread before done
    std::function<void(App&)> finish;  ///< written by the thread before done
    std::jthread thread;
};

/// A picture on its way to the renderer.
struct Upload {
    PicturePtr picture;
    std::vector<Image> levels;
    PictureUpload steps;
    Upload(PicturePtr p, std::vector<Image> l)
        : picture(std::move(p)), levels(std::move(l)), steps(picture->image, levels) {}
};

struct Jobs {
    std::vector<std::unique_ptr<Job>> running;
    PicturePtr preparing;               ///< the picture whose mipmaps are being made, or that is uploaded
    std::unique_ptr<Upload> uploading;  ///< handed over some rows a frame
};

/// What a thread does. It returns what the window's thread does afterwards, or nothing. Work that writes
/// looks at Job::given_up before it touches the file.
using Work = std::function<std::function<void(App&)>(Job& job)>;

/// Runs `work` on a thread, or where none can be started at once, while the window waits. What it throws is
/// said.
void start_job(App& app, std::string title, JobKind kind, Work work);

/// Begins to hand a picture to the renderer; App::uploaded is it when that is done.
void prepare_picture(App& app, PicturePtr picture);

/// Does the window's share of the work that is under way: rows of an upload, what a thread has finished.
void advance_jobs(App& app);

/// The dialog of the job that blocks, with its progress and Cancel.
void draw_progress(App& app);

bool is_busy(const App& app);

}  // namespace probewarp
