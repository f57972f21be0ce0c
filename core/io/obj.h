// The deformed mesh as a Wavefront OBJ.
#pragma once

#include <string>

#include "model/deformation.h"

namespace probewarp {

/// Vertices in the mesh's order as image pixels with z = 0, texture coordinates with v up, triangles; nine
/// significant digits, so that every float comes back.
std::string encode_obj(const Document& document, const Deformation& deformation);

}  // namespace probewarp
