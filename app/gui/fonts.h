// The window's fonts: Inter for text, Material Design for icons, rasterised for the present scale.
#pragma once

#include <imgui.h>

namespace probewarp {

struct Fonts {
    ImFont *text = nullptr, *strong = nullptr, *small = nullptr, *large = nullptr;
    ImFont *icons = nullptr, *icons_small = nullptr;
};

/// Fills and rasterises ImGui's atlas, which nobody else may use meanwhile; needs no window. Where a font
/// file is missing the next best one is used.
Fonts load_fonts(float scale);

/// Icons of the Material Design font (Debian's fonts-materialdesignicons-webfont), UTF-8.
namespace icon {
inline constexpr const char *undo = "\uF54C", *redo = "\uF44F", *export_ = "\uF207", *select = "\uF1B4",
                            *add = "\uF651", *zoom = "\uF349", *eye = "\uF208", *eye_off = "\uF209",
                            *grid = "\uF2C1", *down = "\uF140", *right = "\uF142", *plus = "\uF415",
                            *lock = "\uF33E", *lock_open = "\uF33F", *close = "\uF156", *copy = "\uF18F",
                            *folder = "\uF24B", *image = "\uF2E9", *home = "\uF2DC", *up = "\uF05D",
                            *alert = "\uF028", *info = "\uF2FC", *done = "\uF5E0", *palette = "\uF3D8",
                            *brush = "\uF0E3", *pin = "\uF403";
/// Every one of the above.
inline constexpr const char* all =
    "\uF54C\uF44F\uF207\uF1B4\uF651\uF349\uF208\uF209\uF2C1\uF140\uF142\uF415\uF33E\uF33F\uF156\uF18F\uF24B"
    "\uF2E9\uF2DC\uF05D\uF028\uF2FC\uF5E0\uF3D8\uF0E3\uF403";
}  // namespace icon

}  // namespace probewarp
