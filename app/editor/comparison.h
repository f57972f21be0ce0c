// Two blends of the same pose side by side: the document's own at the left of a divider that one drags,
// another one at its right. A way of looking only: it is no part of the document.
#pragma once

#include <optional>
#include <span>

#include "editor/editor.h"

namespace probewarp {

/// Compares with the blend of that name, or with none where it is empty.
void compare_with(Editor& editor, std::string_view blend);

/// Canvas pixels from its left; empty where nothing is compared.
std::optional<double> divider(const Editor& editor);

/// Whether that place of the canvas shows the other blend.
bool is_compared(const Editor& editor, glm::dvec2 at);
/// Whether the pointer is on the divider, to take hold of it.
bool is_on_divider(const Editor& editor, glm::dvec2 at);
void drag_divider(Editor& editor, const PointerEvent& event);

/// Where the other blend moves the vertices of the deformation: #vertices, image pixels. Worked out anew
/// where the deformation or the blend has changed. Requires a comparison and a deformation.
std::span<const glm::vec2> compared_positions(Editor& editor);

}  // namespace probewarp
