// Text for messages out of bytes from outside: a file's name, or a word inside it, may hold anything, and a
// message goes to terminals and windows.
#pragma once

#include <new>
#include <string>
#include <string_view>

#include "model/error.h"

namespace probewarp {

/// `text` with every control character and every byte that is not UTF-8 replaced by '?'.
std::string printable(std::string_view text);

/// Runs `step`, whose errors become "NAME: what is wrong; what is expected".
template <class Step>
auto naming_errors(const std::string& name, const Step& step) {
    try {
        return step();
    } catch (const Error& error) {
        throw Error(printable(name) + ": " + printable(error.what()));
    } catch (const std::bad_alloc&) {
        throw Error(printable(name) + ": needs more memory than there is; expected a smaller picture");
    }
}

}  // namespace probewarp
