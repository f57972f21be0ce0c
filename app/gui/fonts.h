// The window's fonts: Inter for text, Material Design for icons, rasterised for the present scale; and other
// fonts for the characters of names and messages that Inter has not, once one is to be shown.
#pragma once

#include <imgui.h>

#include <set>
#include <string_view>

namespace probewarp {

struct Fonts {
    ImFont *text = nullptr, *strong = nullptr, *small = nullptr, *large = nullptr;
    ImFont *icons = nullptr, *icons_small = nullptr;
};

using Characters = std::set<ImWchar>;

/// Which characters the atlas has beyond those that it always has: Latin, Greek, Cyrillic and signs.
struct Glyphs {
    Characters loaded;  ///< in the atlas, or in none of the fonts
    Characters asked;   ///< since the last update

    /// Asks for the characters of a text that is shown in this frame: UTF-8.
    void ask(std::string_view text);
    /// Forgets what was asked for. Returns whether something of it is not loaded; `loaded` then has it, and
    /// what is seldom shown goes where more than most_characters(scale) would be loaded.
    bool update(float scale);
};

/// How many characters the atlas may take besides the usual ones: few megabytes of pixels, and a fraction of
/// a second.
std::size_t most_characters(float scale);

/// Fills and rasterises ImGui's atlas, which nobody else may use meanwhile; needs no window. Where a font
/// file is missing the next best one is used.
Fonts load_fonts(float scale);
/// With `more` in the fonts for text, each from the first font that has it; one that is in none is drawn as
/// a sign for what is missing. Characters stand one after the other: nothing is joined or turned round, as
/// Arabic script would want it.
Fonts load_fonts_with(float scale, const Characters& more);

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
