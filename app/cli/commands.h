// The subcommands' options as values, and the functions that carry them out. They throw Error.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/incomplete_file.h"
#include "model/document.h"
#include "model/error.h"

namespace probewarp {

/// One line on standard error.
void print_failure(const std::string& message);

/// The error's sentence, with the option that opens such a file.
std::string with_salvage_hint(const IncompleteFile& error);

/// What a command may set of the input's mesh and weights; empty: as the input has it.
struct BindingOptions {
    std::vector<std::string> probes;  ///< put down on top of the input's
    std::optional<int> mesh;          ///< cells
    std::string alpha_threshold;      ///< 0 to 254; "none": the mesh covers the whole picture
    std::optional<double> alpha_margin;
    std::string weights;  ///< the scheme
    std::optional<double> exponent, falloff;
    std::optional<int> most;
};

struct RenderOptions : BindingOptions {
    std::string input, output;
    std::string probes_csv;  ///< of the iPad program; empty: none
    /// Other pictures under the probes; empty: the input's. Several: the output holds {name} for each one's.
    std::vector<std::string> images;
    std::string blend;  ///< empty: the input's
    double scale = 1;
    std::string size;
    int samples = 1;
    std::string canvas = "image";
    std::string background = "none";
    std::string backend = "auto";
    std::string deform = "auto";
    std::string format;  ///< empty: by the output's ending
    std::string heat;    ///< whose weights lie over the picture: a probe, or "all"; empty: nobody's
    std::optional<double> opacity;  ///< of the heat map
    bool iso_lines = false;
    std::string compression = "default";  ///< of PNG
    bool timings = false;                 ///< told on standard error
    bool quiet = false;
    bool report = false;                       ///< what was written, as JSON on standard output
    bool salvage = false;                      ///< as DecodeOptions has it
    std::set<std::string, std::less<>> given;  ///< the options that the person wrote: "--scale"
};
/// Returns the exit code: 1 where some of several pictures failed, each with its sentence on standard error.
int render(const RenderOptions& options);

struct WeightsOptions : BindingOptions {
    std::string input;
    std::string output;                ///< a folder; empty: no weights are written
    std::string size;                  ///< empty: the picture's own
    std::vector<std::string> imports;  ///< NAME=FILE.png
    std::string save;                  ///< a project; empty: none
    bool quiet = false;
    bool salvage = false;  ///< as DecodeOptions has it
};
void weights(const WeightsOptions& options);

struct InfoOptions {
    std::string input;
    std::string backend = "auto";
    bool json = false;
    bool salvage = false;  ///< as DecodeOptions has it
};
void info(const InfoOptions& options);

}  // namespace probewarp
