// Text from outside as the window shows it: names, paths, and messages that hold them. What is drawn of them
// goes through shown(), so that it stays on its line and its characters have glyphs.
#pragma once

#include <imgui.h>

#include <string>
#include <string_view>

namespace probewarp {

struct App;

/// `text` without control characters and in the order in which it is drawn; its glyphs are there from the
/// next frame on.
std::string shown(App& app, std::string_view text);

/// `text` in `font` at most `width` wide, by an ellipsis in its middle: beginning and ending are what tells
/// files apart. Empty where not even the ellipsis fits.
std::string shortened(const std::string& text, float width, ImFont* font);

/// Draws shown(text) in the present font at a place of the window, shortened; then the whole is its tooltip.
/// Returns how wide it is.
float draw_shown(App& app, ImVec2 at, float width, ImU32 ink, std::string_view text);

/// Draws shown(text) at the cursor in at most `lines` lines down to the window's right margin less `right`;
/// where it is shortened for that the whole is its tooltip.
void draw_wrapped(App& app, std::string_view text, int lines, float right = 0);

}  // namespace probewarp
