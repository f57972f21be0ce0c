// The window's colours and sizes (look.md): one struct, two values.
#pragma once

#include <imgui.h>

#include "model/probe.h"
#include "render/renderer.h"

namespace probewarp {

struct Theme {
    bool is_light = false;
    ImU32 canvas, panel, raised, line;  ///< what text stands on, and the lines between
    ImU32 over;                         ///< what is raised, under the pointer
    ImU32 text, soft, muted;            ///< ink: of what is chosen, of the rest, of hints
    ImU32 dim;                          ///< ink of what is disabled, 3 : 1; never of a hint
    ImU32 accent, accent_over, accent_pressed, on_accent;
    ImU32 warning;
    ImU32 check_light, check_dark;
};

const Theme& dark_theme();
const Theme& light_theme();

/// `colour` with its opacity multiplied by `part`.
ImU32 faded(ImU32 colour, float part);
/// Part way from one colour to another.
ImU32 mixed(ImU32 from, ImU32 to, float part);
ImU32 to_u32(Colour colour, float alpha = 1);
DisplayColours display_colours(const Theme& theme);

/// Hands the theme to ImGui, every size multiplied by `scale`.
void apply_theme(const Theme& theme, float scale);

/// Of what is disabled: even muted ink keeps 3 : 1 on a panel.
inline constexpr float disabled_opacity = 0.75f;

/// Of two opaque colours, by WCAG 2.1: from 1 to 21. Text needs 4.5 on what it stands on.
double contrast(ImU32 one, ImU32 other);

/// On the picture, in both themes: what lies under its labels, at label_opacity, their text, and hints.
namespace on_picture {
inline constexpr ImU32 night = IM_COL32(0x0d, 0x0f, 0x12, 255), text = IM_COL32(0xdf, 0xe3, 0xea, 255),
                       hint = IM_COL32(0xc3, 0xc9, 0xd3, 255);
inline constexpr float label_opacity = 0.9f;
}  // namespace on_picture

/// The layout's sizes at scale 1, pixels.
namespace look {
inline constexpr float menu = 32, status = 26, tools = 48, panel = 308, row = 28, field = 26,
                       slider_number = 52;
}

}  // namespace probewarp
