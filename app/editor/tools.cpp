#include "editor/tools.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace probewarp {

std::span<const Tool> tools() {
    static constexpr std::array<Tool, 3> all{
        {{"select", "Move and turn probes", "Double-click adds a probe · drag moves · knob turns", 'V',
          &press_select, nullptr},
         {"add", "Add a probe", "Click the picture to put a probe · keep holding to move it", 'A', &press_add,
          nullptr},
         {"zoom", "Zoom and pan", "Click zooms in · Alt+click zooms out · drag pans", 'Z', &press_zoom,
          &click_zoom}}};
    return all;
}

const Tool& find_tool(std::string_view name) {
    const auto all = tools();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Tool& tool) { return tool.name == name; });
    assert(found != all.end());
    return *found;
}

Gesture& begin(Editor& editor, Gesture::Kind kind, const PointerEvent& event, std::string label) {
    Gesture gesture;
    gesture.kind = kind;
    gesture.before = editor.document;
    gesture.pressed = event;
    gesture.last = event.at;
    gesture.start_corner = editor.view.corner;
    gesture.label = std::move(label);
    return editor.gesture.emplace(std::move(gesture));
}

}  // namespace probewarp
