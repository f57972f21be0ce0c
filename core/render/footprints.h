// How much smaller a deformed mesh draws the picture than it is, so that what shrinks nowhere goes without
// mipmaps.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "model/deformation.h"
#include "render/renderer.h"

namespace probewarp {

/// A triangle that may want mipmaps: where it is, and the picture's pixels that one target pixel spans at
/// most.
struct Footprint {
    glm::vec2 least, most;  ///< the box around it, image pixels
    double pixels = 1;
};

/// The triangles within `view` that shaders/mesh.frag may draw from a mipmap, and perhaps a few more.
std::vector<Footprint> shrunk_triangles(const Deformation& deformation, const View& view);

/// The mipmaps that drawing these can touch: 0 where there are none.
int wanted_levels(const std::vector<Footprint>& shrunk);

bool any_within(const std::vector<Footprint>& shrunk, const View& view);

}  // namespace probewarp
