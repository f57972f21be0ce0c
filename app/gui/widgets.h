// The window's own widgets, in the look of look.md: what ImGui has no word for.
#pragma once

#include <imgui.h>

#include <string>

#include "gui/app.h"
#include "gui/number_field.h"

namespace probewarp {

/// Draws an icon (or any text of `font`) about its middle.
void draw_icon(ImFont* font, ImVec2 middle, ImU32 colour, const char* symbol);

/// A square button without a frame. A `why_not` dims it and is its tooltip.
bool icon_button(App& app, const char* id, const char* symbol, const char* tooltip, bool on = false,
                 const std::string& why_not = {});

/// The program's blue button.
bool accent_button(App& app, const char* label, ImVec2 size, const char* symbol = nullptr,
                   bool enabled = true);

/// A foldable heading; returns whether it is open. `*add` becomes true where its plus was clicked.
/// `id` tells it from others, whatever the title says.
bool section(App& app, const char* id, const char* title, bool& open, bool* add = nullptr);

/// A label at the left of a row; the widget follows on the same line.
void row_label(App& app, const char* text, float width);

/// A slim slider with a round grip over [least, most], and its value at the right as a field without a frame.
/// Returns whether it changed.
bool slider_field(App& app, const char* id, double& value, const char* unit, float width, double least,
                  double most);

/// The slider's own part: a track with a grip at `part` in [0, 1]. Returns whether the hand set it.
bool slim_slider(App& app, const char* id, double& part, float width);

/// A box with its label, framed as the fields are; `first` of its row. Returns whether it was clicked.
bool check_box(App& app, const char* label, bool& on, bool first = true);

/// The line between two sections of the panel.
void begin_section_gap(App& app);

/// ImGui::BeginCombo with the program's chevron.
bool begin_combo(App& app, const char* id, const char* shown, float width);

void tooltip(const char* text);
/// The tooltip's box, in lines that the window has room for.
void show_tooltip(const std::string& text);
/// Of an item of a list: beside the list, so that it hides none of the others.
void list_tooltip(const App& app, const std::string& text);

}  // namespace probewarp
