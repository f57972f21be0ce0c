#include "editor/tools.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "editor/painting.h"

namespace probewarp {

std::span<const Tool> tools() {
    static constexpr std::array<Tool, 5> all{
        {{"select", "Move and turn probes", "Double-click adds a probe · drag moves · knob turns", 'V',
          &press_select, nullptr},
         {"add", "Add a probe", "Click the picture to put a probe · keep holding to move it", 'A', &press_add,
          nullptr},
         {"brush", "Paint the chosen probe's weights",
          "Drag paints · Ctrl inverts · Shift+drag sizes · [ ] size · 1 to 0 strength · Alt+click chooses a "
          "probe",
          'B', &press_brush, nullptr},
         {"pin", "Paint where the picture stays rigid",
          "Drag paints stiffness · Ctrl takes it away · Shift+drag sizes · [ ] size · 1 to 0 strength", 'P',
          &press_brush, nullptr},
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

void choose_tool(Editor& editor, const Tool& tool) {
    const bool painted = is_painting_tool(editor);
    editor.tool = &tool;
    const bool paints = is_painting_tool(editor);
    if (paints && !painted && editor.shown_weights == ShownWeights::none) {
        editor.shown_weights = ShownWeights::chosen;
        editor.shown_by_brush = true;
    } else if (!paints && painted && editor.shown_by_brush) {
        editor.shown_weights = ShownWeights::none;
        editor.shown_by_brush = false;
    }
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
