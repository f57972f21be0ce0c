// What stands around the canvas: menu bar, tool strip, panel, status bar.
#pragma once

namespace probewarp {

struct App;

void draw_menu_bar(App& app);
void draw_tool_strip(App& app);
void draw_panel(App& app);
void draw_status_bar(App& app);

/// In the stead of all these and of the canvas where they cannot be drawn: the menus, so that the document
/// can be saved, and a way back.
void draw_makeshift(App& app);

}  // namespace probewarp
