// Runs the real program, as a person would, and compares the pictures it leaves.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/image.h"

namespace probewarp::test {

struct Outcome {
    int code = -1;       ///< exit code; -1 where it was killed by a signal
    std::string errors;  ///< what it wrote to standard error
};

/// Runs PROBEWARP_PROGRAM with the arguments, without a shell, and waits.
Outcome run_program(const std::vector<std::string>& arguments);

/// A fresh folder under the build's, named after the running test; what an earlier run left there is gone.
std::filesystem::path scratch_folder();

/// Reads a picture that must be there.
Image read(const std::filesystem::path& path);
void write_png(const std::filesystem::path& path, const Image& image);

struct Difference {
    int most = 0;     ///< largest difference of a sample, in 1/255
    double mean = 0;  ///< of all samples, in 1/255
};

/// Requires pictures of one size. A sample of 16 bits counts as 1/257 of itself.
Difference difference(const Image& a, const Image& b);

/// |a - b| times 16, opaque: what to look at when a picture differs.
Image difference_picture(const Image& a, const Image& b);

}  // namespace probewarp::test
