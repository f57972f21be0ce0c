// What a name means that a hand typed, picked or dropped: a folder to enter, a file, or why it is neither.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace probewarp {

/// Bytes of a name that every usual file system takes.
inline constexpr std::size_t most_name_bytes = 255;

struct MeantPath {
    std::filesystem::path path;  ///< normal; empty where there is trouble
    bool is_folder = false;
    std::string trouble;  ///< a sentence; empty: none
};

/// What was typed into a dialog that lists `folder`. "~" is home. `endings`: lower case with the dot, at
/// least one; where one saves, a name with none of them gets the first. An existing folder is a folder,
/// whatever its name; a name of nothing, of spaces, of dots or of an ending alone is trouble, as is a folder
/// that is not there, and where one opens a file that is not there.
MeantPath meant_path(std::string_view typed, const std::filesystem::path& folder,
                     std::span<const std::string> endings, bool saving);

/// The path with "~" at its beginning as home.
std::filesystem::path without_tilde(std::string_view typed);

/// Whether the name before the path's ending is more than spaces and dots.
bool has_stem(const std::filesystem::path& path);

/// `stem` and `ending` as one name; a stem too long for most_name_bytes is cut between two characters.
std::string fitting_name(std::string_view stem, std::string_view ending);

/// The file that a dropped URI means, as GLFW hands it on: percent signs decoded, "file://host" taken away.
/// Empty where it is on no disk of this machine.
std::optional<std::filesystem::path> dropped_path(std::string_view dropped);

/// A path in a text field. A field holds UTF-8 of 16-bit characters, a path any bytes: until the text is
/// edited exactly what was put is meant, and after that at least its folder, as long as that stays.
struct PathField {
    std::string text;  ///< what the field shows and edits
    void put(const std::filesystem::path& path);
    /// Shows the name only, and means the path.
    void put_name(const std::filesystem::path& path);
    /// What the text means: the path that was put, its folder with another name, or the text as it stands.
    std::filesystem::path meant() const;

  private:
    std::filesystem::path exact_;
    std::string shown_;  ///< exact_ as text
};

}  // namespace probewarp
