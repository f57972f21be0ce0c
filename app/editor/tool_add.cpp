// Puts a probe with one press; holding on drags it away at once.
#include "editor/tools.h"

namespace probewarp {

void press_add(Editor& editor, const PointerEvent& event) {
    Document before = editor.document;
    const int id = put_probe(editor, event.at);
    if (id == 0) return;
    Gesture& gesture =
        begin(editor, Gesture::Kind::move, event, "Add " + find_probe(editor.document, id)->name);
    gesture.before = std::move(before);
    gesture.probe = id;
}

}  // namespace probewarp
