// What the toolkit drew last: a frame that would show the same again is not drawn.
#pragma once

#include <imgui.h>

#include <cstddef>
#include <vector>

namespace probewarp {

class LastFrame {
  public:
    /// Whether `data` differs from what it was the last time. Of textures only the names count.
    bool differs(const ImDrawData& data);

  private:
    std::vector<std::byte> drawn_;
};

}  // namespace probewarp
