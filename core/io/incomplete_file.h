// The error of a file of which only a part can be read.
#pragma once

#include "model/error.h"

namespace probewarp {

/// A file that ends too soon or is damaged at its end, of which what comes before can be opened all the same
/// where one asks for it: DecodeOptions::salvage.
struct IncompleteFile : Error {
    using Error::Error;
};

}  // namespace probewarp
