// The subcommands' options as values, and the functions that carry them out. They throw Error.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace probewarp {

struct RenderOptions {
    std::string input, output;
    std::vector<std::string> probes;
    std::string probes_csv;  ///< of the iPad program; empty: none
    std::string image;       ///< another picture under the probes; empty: the input's
    std::optional<int> mesh;
    std::string weights, blend;  ///< empty: the input's
    double scale = 1;
    std::string size;
    int samples = 1;
    std::string canvas = "image";
    std::string background = "none";
    std::string backend = "auto";
    std::string deform = "processor";
    std::string format;  ///< empty: by the output's ending
    bool quiet = false;
};
void render(const RenderOptions& options);

struct InfoOptions {
    std::string input;
    std::string backend = "auto";
    bool json = false;
};
void info(const InfoOptions& options);

}  // namespace probewarp
