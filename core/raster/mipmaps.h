// A picture's mipmaps: each has half the size of the one before.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "model/image.h"

namespace probewarp {

/// Pixels.
struct Extent {
    int width, height;
};

/// Of the next mipmap.
Extent half(Extent of);

/// Room for those from half the image's size on; at most so many.
std::vector<Image> room_for_levels(const Image& image, int most = std::numeric_limits<int>::max());

/// Works out what of the levels follows from the image's rows from `first` to before `end`, those before
/// having been there: each pixel is the alpha-weighted mean of four.
void fill_levels(const Image& image, std::span<Image> levels, int first, int end);

/// Both at once, of the whole image.
std::vector<Image> smaller_levels(const Image& image, int most = std::numeric_limits<int>::max());

}  // namespace probewarp
