// A picture's mipmaps: each has half the size of the one before.
#pragma once

#include <limits>
#include <vector>

#include "model/image.h"

namespace probewarp {

/// Pixels.
struct Extent {
    int width, height;
};

/// Of the next mipmap.
Extent half(Extent of);

/// Those from half the image's size on, each pixel the alpha-weighted mean of four; at most so many.
std::vector<Image> smaller_levels(const Image& image, int most = std::numeric_limits<int>::max());

}  // namespace probewarp
