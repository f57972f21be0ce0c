// Names for files that are no pictures to us: what they are, and what a person can do about it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/bytes.h"

namespace probewarp {

/// "is a WebP picture, which cannot be read; expected PNG, ..., so convert it to PNG first": a clause for an
/// Error about a file that no reader claims, by its first bytes. Nothing where nobody knows what it is.
std::optional<std::string> unread_format(Bytes file);

/// Such a clause about a ZIP archive, by its mimetype or the names of its members. Nothing where it may be a
/// project.
std::optional<std::string> unread_archive(Bytes zip);

/// The formats that are read, for messages.
inline constexpr std::string_view readable_formats = "PNG, JPEG, BMP, TGA, GIF, PSD or PNM";

}  // namespace probewarp
