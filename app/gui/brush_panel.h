// The panel's parts that are about weights: the brush, and what is shown over the picture.
#pragma once

namespace probewarp {

struct App;

/// For the brush or the pin that is in the hand.
void draw_brush_section(App& app);

/// The heat map's colours, the chosen probe's weight under the cursor, and how they are shown.
void draw_weights_section(App& app);

}  // namespace probewarp
