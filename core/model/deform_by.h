// Who moves the vertices: the processor, or the graphics driver's vertex shader.
#pragma once

#include <array>
#include <string_view>

namespace probewarp {

enum class DeformBy { automatic, processor, shader };

struct DeformByName {
    std::string_view name;  ///< what the command line calls it
    DeformBy by;
};

inline constexpr std::array<DeformByName, 3> deform_by_names{
    {{"auto", DeformBy::automatic}, {"processor", DeformBy::processor}, {"shader", DeformBy::shader}}};

}  // namespace probewarp
