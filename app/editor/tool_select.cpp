// The default tool: chooses probes, drags their discs, turns their knobs, pulls their reach.
#include "editor/tools.h"

namespace probewarp {

void press_select(Editor& editor, const PointerEvent& event) {
    const Hit hit = hit_test(editor, event.at);
    editor.selected = hit.probe;
    const Probe* probe = find_probe(editor.document, hit.probe);
    if (!probe) return;
    if (probe->locked) {
        editor.notice = probe->name + " is locked. Unlock it in the list to move it.";
        return;
    }
    switch (hit.part) {
        case Part::disc:
            begin(editor, Gesture::Kind::move, event, "Move " + probe->name).probe = probe->id;
            break;
        case Part::reach:
            begin(editor, Gesture::Kind::reach, event, "Reach of " + probe->name).probe = probe->id;
            break;
        case Part::knob: {
            Gesture& gesture = begin(editor, Gesture::Kind::turn, event, "Turn " + probe->name);
            gesture.probe = probe->id;
            gesture.raw_angle = probe->angle;
            break;
        }
        case Part::none:
            break;
    }
}

}  // namespace probewarp
