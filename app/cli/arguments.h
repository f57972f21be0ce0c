// The command line's small languages: probes, sizes and colours as text.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "model/document.h"
#include "model/error.h"

namespace probewarp {

struct BindingOptions;
struct UsedFile;

/// What the person typed cannot be understood: exit code 2.
struct UsageError : Error {
    using Error::Error;
};

/// To be called with all files of a command before anything is written: throws UsageError where one would be
/// written over another that is read, or two to one place. What is redirected into one that is read counts
/// too.
void check_files(std::span<const UsedFile> read, std::span<const UsedFile> written);

/// "RX,RY[:X,Y[,DEG[,RADIUS]]]": a fresh probe of `document`, image pixels and degrees. Throws UsageError.
Probe parse_probe(const std::string& text, const Document& document);

/// "640x480". Throws UsageError.
std::array<int, 2> parse_size(const std::string& text);

/// "#rrggbb", "#rgb", "white", "black"; "none" is empty. Throws UsageError.
std::optional<Colour> parse_colour(const std::string& text);

/// Throws UsageError for a probe that cannot be understood, Error where the weights would be too many.
void apply(const BindingOptions& options, Document& document);

/// The place in the document of the probe of that name, or else of that number, from 1 in the probes' order;
/// empty where there is none.
std::optional<std::size_t> find_probe_named(const Document& document, const std::string& name);

/// The place that find_probe_named tells. Throws UsageError where there is none: it begins with `option` and
/// lists the names.
std::size_t probe_named(const Document& document, const std::string& name, const std::string& option);

}  // namespace probewarp
