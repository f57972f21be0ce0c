// The one error that reaches a person: a sentence that names the file, what is wrong, and what was expected.
#pragma once

#include <stdexcept>
#include <string>

namespace probewarp {

struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace probewarp
