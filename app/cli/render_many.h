// `probewarp render` of many pictures under the same probes.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "cli/drawing.h"
#include "cli/timings.h"

namespace probewarp {

/// Whether the options ask for it: pictures, and {name} in the output.
bool is_many(const RenderOptions& options);

/// Where each picture goes. Throws UsageError where two would go to one place.
std::vector<std::filesystem::path> output_paths(const RenderOptions& options);

/// `base`, the input's document, on another picture as the options want it.
using PoseOn = std::function<Document(const Document& base, PicturePtr picture)>;

/// Returns the exit code: 1 where a picture failed, each with its sentence on standard error; all others are
/// written. Throws UsageError as output_paths does, before anything is written, and Error where there is no
/// context or no folder. What may not be written over is checked by the caller.
int render_many(const RenderPlan& plan, const Document& base, const PoseOn& pose_on, Timings& timings);

}  // namespace probewarp
