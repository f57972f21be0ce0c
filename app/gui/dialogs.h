// The dialogs: questions, the export's settings, levels of weights, about.
#pragma once

namespace probewarp {

struct App;

void draw_questions(App& app);
void draw_export_dialog(App& app);
void draw_levels_dialog(App& app);
void draw_about(App& app);

}  // namespace probewarp
