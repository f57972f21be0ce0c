// The one error that reaches a person: a sentence that names the file, what is wrong, and what was expected.
#pragma once

#include <stdexcept>
#include <string>

namespace probewarp {

struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A file that ends too soon or is damaged at its end, of which what comes before can be opened all the same
/// where one asks for it: DecodeOptions::salvage.
struct IncompleteFile : Error {
    using Error::Error;
};

}  // namespace probewarp
