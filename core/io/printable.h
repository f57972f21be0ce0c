// Text for messages out of bytes from outside: a file's name, or a word inside it, may hold anything, and a
// message goes to terminals and windows.
#pragma once

#include <string>
#include <string_view>

namespace probewarp {

/// `text` with every control character and every byte that is not UTF-8 replaced by '?'.
std::string printable(std::string_view text);

}  // namespace probewarp
