// What a command can write, and which of its options mean something for that: an option that is given is
// obeyed or refused, never passed over.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "io/image_file.h"

namespace probewarp {

struct RenderOptions;
struct WeightsOptions;

enum class Kind { image, mesh, project };

struct OutputFormat {
    Kind kind = Kind::image;
    const ImageFormat* image = nullptr;  ///< of Kind::image
};

/// By --format, or else by the output's ending. Throws UsageError where that cannot be written.
OutputFormat output_format(const RenderOptions& options);

/// "PNG", "OBJ", "a project": what a person reads. For scripts: "png", "obj", "probewarp".
std::string label_of(const OutputFormat& format);
std::string name_of(const OutputFormat& format);

/// Throws UsageError where an option was given that means nothing for this output.
void check_options(const RenderOptions& options, const OutputFormat& format);
void check_options(const WeightsOptions& options);

/// All files that `probewarp render` writes where the output is `path`.
std::vector<std::filesystem::path> written_files(const std::filesystem::path& path,
                                                 const OutputFormat& format);

}  // namespace probewarp
