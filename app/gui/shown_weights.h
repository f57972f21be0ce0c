// The weights shown over the picture.
#pragma once

#include <vector>

#include "editor/editor.h"
#include "render/renderer.h"

namespace probewarp {

/// What is to be shown: decides whether the overlay must be made anew.
struct OverlayKey {
    ShownWeights weights = ShownWeights::none;
    bool pins = false;   ///< the stiffness instead of a probe's weights: while the pin is at work
    PaintPtr stiffness;  ///< what is shown then
    int probe = 0;       ///< id
    bool iso_lines = false;
    float opacity = 0;
    friend bool operator==(const OverlayKey&, const OverlayKey&) = default;
};
OverlayKey overlay_key(const Editor& editor);

OverlayStyle overlay_style(const OverlayKey& key);

/// #vertices of the editor's deformation; empty where nothing is to be shown.
std::vector<OverlayVertex> overlay_vertices(const Editor& editor, const OverlayKey& key);

}  // namespace probewarp
