// Zooms with clicks, pans with drags.
#include "editor/tools.h"

namespace probewarp {

void press_zoom(Editor& editor, const PointerEvent& event) { begin(editor, Gesture::Kind::pan, event, {}); }

void click_zoom(Editor& editor, const PointerEvent& event) {
    zoom_canvas(editor, event.at, event.alt || event.shift ? 0.5 : 2);
}

}  // namespace probewarp
