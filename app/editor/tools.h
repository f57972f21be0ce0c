// The tools of the tool strip: one file each, one row each.
#pragma once

#include <span>
#include <string_view>

#include "editor/editor.h"

namespace probewarp {

struct Tool {
    std::string_view name;
    std::string_view label;
    std::string_view hint;  ///< shown under the canvas
    char key;               ///< chooses it
    /// The left button went down on the canvas: select it, begin a gesture, or do something.
    void (*press)(Editor& editor, const PointerEvent& event);
    /// ... and up again without having moved. May be null.
    void (*click)(Editor& editor, const PointerEvent& event);
};

/// In the strip's order, the default first.
std::span<const Tool> tools();
const Tool& find_tool(std::string_view name);

/// Takes the tool up. The brush shows the weights while it is in the hand, unless they were shown anyway.
void choose_tool(Editor& editor, const Tool& tool);

void press_select(Editor& editor, const PointerEvent& event);
void press_add(Editor& editor, const PointerEvent& event);
void press_zoom(Editor& editor, const PointerEvent& event);
void press_brush(Editor& editor, const PointerEvent& event);
void click_zoom(Editor& editor, const PointerEvent& event);

/// Begins a gesture on the document as it stands.
Gesture& begin(Editor& editor, Gesture::Kind kind, const PointerEvent& event, std::string label);

}  // namespace probewarp
