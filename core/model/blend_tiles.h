// The other blends by vector units, in double, from weights in tiles. As deform_tiles.h, one program holds
// the code for every instruction set.
#pragma once

#include "model/deform.h"

namespace probewarp {

// Each is the blend of the same name in planar_blend.h up to a double's rounding. What is near to having no
// answer is decided by that function itself, vertex by vertex.
DeformFunction deform_dlb_shortest;
DeformFunction deform_dib;
DeformFunction deform_log_linear;
DeformFunction deform_spiral;
DeformFunction deform_linear;
DeformFunction deform_mls_rigid;
DeformFunction deform_mls_similarity;

}  // namespace probewarp
