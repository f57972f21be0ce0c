// `probewarp render --report`: what was written and where it lies, for scripts: a JSON object a line.
#pragma once

#include <filesystem>
#include <string>

#include "cli/output_kinds.h"
#include "exporting/export.h"

namespace probewarp {

/// On any output: the files, the picture, the mesh, and what of it is folded or cancelled.
/// view: of a picture; null for another output
std::string report_of(const std::filesystem::path& output, const OutputFormat& format,
                      const Deformation& deformation, const View* view);

}  // namespace probewarp
