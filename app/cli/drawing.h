// What `probewarp render` has one of, however many pictures it renders: what draws them, the progress.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/output_kinds.h"
#include "cli/timings.h"
#include "exporting/picture_file.h"
#include "io/file.h"
#include "render/context.h"
#include "render/renderer.h"

namespace probewarp {

/// What all pictures of one command get alike.
struct RenderPlan {
    const RenderOptions& options;
    OutputFormat format;  ///< of a picture
    PictureFile file;
};

/// A bar that shows how far a render is, once it has taken a second and where somebody watches.
class Progress {
  public:
    explicit Progress(bool quiet);
    ~Progress() { clear(); }
    void show(double part);  ///< [0, 1]
    void clear();

  private:
    bool on_, shown_ = false;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Where a picture goes: a file, or standard output, which gets everything at the end.
class Output {
  public:
    /// path: none for standard output
    Output(const std::optional<std::filesystem::path>& path, Timings& timings);
    void write(const FileParts& parts);
    /// Forgets what was written.
    void restart();
    void finish();

  private:
    Timings& timings_;
    std::optional<FileWriter> file_;  ///< empty: standard output
    FileParts kept_;                  ///< for that
};

/// An offscreen context and what draws in it.
struct OffscreenRenderer {
    std::unique_ptr<Context> context;  // first in, last out
    Renderer renderer;

    /// Throws Error where there is no context.
    explicit OffscreenRenderer(const std::string& backend) : context(open_context(backend)) {}
};

/// Draws one deformed document after the other: the processor, or where it cannot a graphics driver, on the
/// thread that made it.
class Drawer {
  public:
    /// The plan must outlive it.
    explicit Drawer(const RenderPlan& plan) : plan_(plan) {}

    /// Draws, while what is drawn already is being encoded and written; finish() of what it returns is still
    /// to be written. show: called with the part that is done. Throws Error.
    std::unique_ptr<ImageEncoding> draw(const Deformation& deformation, Output& output,
                                        const std::function<void(double)>& show);

  private:
    void hold(const Deformation& deformation);

    const RenderPlan& plan_;
    std::optional<OffscreenRenderer> offscreen_;  ///< once there was need of it
};

}  // namespace probewarp
