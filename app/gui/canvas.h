// The canvas: the deformed picture, and over it the probes' glyphs.
#pragma once

namespace probewarp {

struct App;

/// Hands the renderer what changed in the document and draws the canvas into the given rectangle of the
/// window.
void draw_canvas(App& app, float left, float top, float width, float height);

}  // namespace probewarp
