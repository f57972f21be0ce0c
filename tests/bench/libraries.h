// What the libraries do alone, for the files' benchmarks to compare with.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/image.h"

namespace probewarp::bench {

/// The pixels without their alpha. height x width x 3
std::vector<unsigned char> rgb_of(const Image& image);

/// Each returns the file's size in bytes. rgb: height x width x 3
std::size_t stb_png(std::span<const unsigned char> rgb, int width, int height);
/// At level 9 with all filters.
std::size_t libpng_best(std::span<const unsigned char> rgb, int width, int height);
/// At quality 95 and 4:4:4.
std::size_t libjpeg(const Image& rgba);

/// The whole file into RGBA.
void spng_open(std::span<const std::byte> file);
void libjpeg_open(std::span<const std::byte> file);

}  // namespace probewarp::bench
