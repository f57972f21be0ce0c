// Which cells of a grid over a picture are near a pixel: along one side, since rows and columns go alike.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace probewarp {

/// The cells [first, last] along one side that come within `margin` pixels of pixel `at`: one that only
/// touches does not. Multiplied before divided, so that whole quotients are exact.
inline std::array<int, 2> cells_near(int at, double margin, int cells, int size) {
    const int first = int(std::floor((at - margin) * cells / size));
    const int last = int(std::ceil((at + 1 + margin) * cells / size)) - 1;
    return {std::clamp(first, 0, cells - 1), std::clamp(last, 0, cells - 1)};
}

}  // namespace probewarp
