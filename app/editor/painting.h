// Painting with the brush and the pin: strokes on the canvas, and the keys that change the brush.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "editor/editor.h"

namespace probewarp {

/// One stroke while it lasts.
struct PaintStroke {
    /// What is painted on one map.
    struct Layer {
        int probe = 0;  ///< id; 0: the stiffness
        PaintMap map;
        Stroke stroke;
        std::vector<float> shares;  ///< #vertices: the probe's before the stroke
    };
    std::shared_ptr<const Binding> binding;
    Layer layer;
    std::optional<Layer> mirrored;  ///< where the other side is another probe's
    Brush brush;                    ///< as it was when the stroke began
    bool inverted = false;          ///< likewise: Ctrl was held
    glm::dvec2 last{0};             ///< image pixels: where the last dab fell
    std::vector<glm::vec2> still;   ///< #vertices, image pixels: as shown_positions says
};

/// Where the canvas shows the mesh's vertices: #vertices, image pixels. While a stroke is painted under shown
/// weights the picture stands still, or it would slip away under the brush; otherwise it is deformed as one
/// goes.
std::span<const glm::vec2> shown_positions(const Editor& editor);

inline constexpr double min_brush_radius = 0.5, max_brush_radius = 20000;  // image pixels

/// A sixteenth of the picture's longer side.
double default_brush_radius(const Image& image);

/// Whether a stroke is being painted.
bool is_stroking(const Editor& editor);

/// The brush or the pin.
bool is_painting_tool(const Editor& editor);
/// Whether strokes paint stiffness rather than a probe's weights.
bool paints_stiffness(const Editor& editor);
bool is_brush_gesture(Gesture::Kind kind);

void drag_brush(Editor& editor, const PointerEvent& event);
void release_brush(Editor& editor);

MirrorAxis mirror_axis(const Editor& editor);
/// Where the axis is taken hold of, canvas pixels: above the picture's top edge.
glm::dvec2 axis_grip(const Editor& editor);

/// Whether the deformation may wait until the stroke ends: one of stiffness changes whole regions, and under
/// shown weights the picture stands still anyway.
bool defers_deformation(const Editor& editor);

/// The brush's keys: brackets size it, digits set its strength. Returns whether the key meant something.
bool press_brush_key(Editor& editor, int key);

}  // namespace probewarp
