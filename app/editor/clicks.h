// Which presses of the mouse are the second of a double-click. Time is handed in.
#pragma once

#include <optional>

#include "editor/editor.h"

namespace probewarp {

/// From press to press; what is slower are two clicks.
inline constexpr double double_click_seconds = 0.5;
inline constexpr double double_click_slack = 5;  // pixels at scale 1 between the two

/// When an event happened, seconds of any clock: a busy window learns of events late, and then knows only
/// that it was not before `earliest` and not after `latest`.
struct EventTime {
    double earliest = 0, latest = 0;
};

/// The presses on the canvas so far, as far as the next one may belong to them.
struct ClickCounter {
    struct Press {
        PointerEvent event;
        EventTime time;
    };
    std::optional<Press> first;
};

/// Tells of each press; returns whether it is the second of a double-click with the left button. Where the
/// times leave it open, it is. A third press begins anew.
bool is_double_click(ClickCounter& clicks, const PointerEvent& event, EventTime time, double scale);

}  // namespace probewarp
