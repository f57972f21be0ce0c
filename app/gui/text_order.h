// Text in the order in which it is drawn: the toolkit draws characters from left to right, as they come.
#pragma once

#include <string>

namespace probewarp {

/// UTF-8 text in a line that runs from left to right: what runs from right to left (Hebrew, Arabic) is turned
/// round, and Arabic letters take the shapes that join them (Unicode Standard Annex 9, by FriBidi). Other
/// text comes back as it is.
std::string visual_order(const std::string& text);

}  // namespace probewarp
