// Project files, name.probewarp: a ZIP of `mimetype`, `project.json`, the picture's own bytes and the paint,
// so that it opens wherever it is moved. docs/project-format.md describes it.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/image_file.h"
#include "model/document.h"
#include "model/error.h"

namespace probewarp {

inline constexpr int project_format = 2;  ///< what is written; 1 is read too
inline constexpr const char* project_extension = ".probewarp";
inline constexpr const char* project_mimetype = "application/x-probewarp";

/// The document as a project file. Requires a picture. The same document gives the same bytes. Throws Error
/// where the file would not open again: a probe beyond the limits of probe.h, a name that is too long.
std::vector<std::byte> encode_project(const Document& document);

/// Throws Error: "NAME: what is wrong; what is expected". Fields that this version does not know are refused,
/// so that saving again never loses what a later version wrote.
Document decode_project(std::vector<std::byte> bytes, const std::string& name, Pixels pixels = Pixels::whole,
                        const DecodeOptions& options = {});

/// A document from a file: a project as it was saved, or a picture without probes.
/// Throws Error, or IncompleteFile where salvaging would open it.
Document read_document(const std::filesystem::path& path, Pixels pixels = Pixels::whole,
                       const DecodeOptions& options = {});

/// By the path's ending, in any case.
bool is_project_path(const std::filesystem::path& path);

/// Whether the bytes are meant as a project rather than a picture.
bool is_project(std::span<const std::byte> bytes);

}  // namespace probewarp
