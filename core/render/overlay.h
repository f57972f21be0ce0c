// The weights as the colours of an overlay.
#pragma once

#include <vector>

#include "model/deformation.h"
#include "render/renderer.h"

namespace probewarp {

/// At each vertex of the mesh the share of the probe of that id (0 where there is none), and the mix of all
/// probes' colours by their shares: #vertices.
std::vector<OverlayVertex> weight_overlay(const Deformation& deformation, int probe);

/// The stiffness paint (null: none) at each vertex, as values: #vertices.
std::vector<OverlayVertex> stiffness_overlay(const Deformation& deformation, const PaintMap* stiffness);

}  // namespace probewarp
