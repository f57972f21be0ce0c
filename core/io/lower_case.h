// Lower case for names that programs read: endings, headings. Letters of ASCII only, whatever the locale.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace probewarp {

inline std::string lower_case(std::string_view text) {
    std::string lowered(text);
    for (char& c : lowered)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return lowered;
}

/// The ending of the path's name, with its dot: ".png".
inline std::string lower_ending(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

}  // namespace probewarp
