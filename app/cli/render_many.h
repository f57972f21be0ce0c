// `probewarp render` of many pictures under the same probes.
#pragma once

#include <functional>

#include "cli/drawing.h"
#include "cli/timings.h"

namespace probewarp {

/// Whether the options ask for it: pictures, and {name} in the output.
bool is_many(const RenderOptions& options);

/// `base`, the input's document, on another picture as the options want it.
using PoseOn = std::function<Document(const Document& base, PicturePtr picture)>;

/// Returns the exit code: 1 where a picture failed, each with its sentence on standard error; all others are
/// written. Throws UsageError, before anything is written, where two pictures would go to one place or one
/// over what is read, and Error where there is no context or no folder.
int render_many(const RenderPlan& plan, const Document& base, const PoseOn& pose_on, Timings& timings);

}  // namespace probewarp
