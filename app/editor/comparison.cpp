#include "editor/comparison.h"

#include <algorithm>
#include <cmath>

namespace probewarp {

void compare_with(Editor& editor, std::string_view blend) {
    if (blend.empty())
        editor.comparison.reset();
    else
        editor.comparison = Comparison{
            std::string(blend), editor.comparison ? editor.comparison->divider : Comparison{}.divider, 0, {}};
}

std::optional<double> divider(const Editor& editor) {
    if (!editor.comparison || !has_picture(editor)) return {};
    return std::round(editor.comparison->divider * editor.canvas_size.x);
}

bool is_compared(const Editor& editor, glm::dvec2 at) {
    const auto x = divider(editor);
    return x && at.x >= *x;
}

bool is_on_divider(const Editor& editor, glm::dvec2 at) {
    const auto x = divider(editor);
    return x && std::abs(at.x - *x) <= 6 * editor.scale;
}

void drag_divider(Editor& editor, const PointerEvent& event) {
    const double margin = 24 * editor.scale;  // so that it can be taken hold of again
    if (!editor.comparison || editor.canvas_size.x <= 2 * margin) return;
    editor.comparison->divider =
        std::clamp(event.at.x, margin, editor.canvas_size.x - margin) / editor.canvas_size.x;
}

std::span<const glm::vec2> compared_positions(Editor& editor) {
    Comparison& comparison = *editor.comparison;
    if (comparison.version != editor.deformation.version) {
        comparison.now = positions_by(editor.deformation, *find_blend_method(comparison.blend));
        comparison.version = editor.deformation.version;
    }
    return comparison.now;
}

}  // namespace probewarp
