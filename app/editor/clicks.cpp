#include "editor/clicks.h"

#include <cmath>
#include <utility>

namespace probewarp {

bool is_double_click(ClickCounter& clicks, const PointerEvent& event, EventTime time, double scale) {
    const auto first = std::exchange(clicks.first, std::nullopt);
    if (event.button != Button::left) return false;
    if (first) {
        const glm::dvec2 way = event.at - first->event.at;
        if (time.earliest - first->time.latest <= double_click_seconds &&
            std::hypot(way.x, way.y) < double_click_slack * scale)
            return true;
    }
    clicks.first = {event, time};
    return false;
}

}  // namespace probewarp
