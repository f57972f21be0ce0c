// The window's colours and sizes (look.md): one struct, two values.
#pragma once

#include <imgui.h>

#include "model/probe.h"
#include "render/renderer.h"

namespace probewarp {

struct Theme {
    bool is_light = false;
    ImU32 canvas, panel, raised, line, text, muted, accent, on_accent, check_light, check_dark, label,
        warning;
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

/// The layout's sizes at scale 1, pixels.
namespace look {
inline constexpr float menu = 32, status = 26, tools = 48, panel = 308, row = 28, field = 26, label = 64,
                       slider_number = 52;
}

}  // namespace probewarp
