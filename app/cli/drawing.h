// What `probewarp render` has one of, however many pictures it renders: the context, the renderer, the
// progress.
#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "cli/commands.h"
#include "io/image_encoding.h"
#include "render/context.h"
#include "render/export.h"

namespace probewarp {

/// What all pictures of one command get alike.
struct RenderPlan {
    const RenderOptions& options;
    const ImageFormat& format;
    ExportSettings settings;
    EncodeOptions encode;
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

/// A picture that is drawn, and mostly encoded.
struct Drawn {
    ExportJob job;
    ImageEncoding encoding;

    Drawn(Renderer& renderer, const Document& document, const Deformation& deformation,
          const RenderPlan& plan)
        : job(renderer, document, deformation, plan.settings),
          encoding(plan.format, job.image(), plan.encode) {}
};

/// Draws one document after the other, all on the thread that made it.
class Drawer {
  public:
    /// The plan must outlive it. Throws Error where there is no context.
    explicit Drawer(const RenderPlan& plan);

    /// Draws, while what is drawn already is being encoded. show: called with the part that is done. Throws
    /// Error.
    std::unique_ptr<Drawn> draw(const Document& document, const Deformation& deformation,
                                const std::function<void(double)>& show);

  private:
    const RenderPlan& plan_;
    std::unique_ptr<Context> context_;  // first in, last out
    Renderer renderer_;
};

}  // namespace probewarp
