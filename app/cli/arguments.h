// The command line's small languages: probes, sizes and colours as text.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "model/document.h"
#include "model/error.h"

namespace probewarp {

/// What the person typed cannot be understood: exit code 2.
struct UsageError : Error {
    using Error::Error;
};

/// "RX,RY[:X,Y[,DEG[,RADIUS]]]": a fresh probe of `document`, image pixels and degrees. Throws UsageError.
Probe parse_probe(const std::string& text, const Document& document);

/// "640x480". Throws UsageError.
std::array<int, 2> parse_size(const std::string& text);

/// "#rrggbb", "#rgb", "white", "black"; "none" is empty. Throws UsageError.
std::optional<Colour> parse_colour(const std::string& text);

}  // namespace probewarp
