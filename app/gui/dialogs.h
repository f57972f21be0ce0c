// The dialogs: questions, the export's settings, levels of weights, about.
#pragma once

#include <filesystem>
#include <functional>

namespace probewarp {

struct App;

/// Asks over the open dialog whether the file may go; the safe answer is what Return means.
void ask_before_replacing(App& app, const std::filesystem::path& path, std::function<void(App&)> then);

/// Draws App::doubt, within the dialog that it is about.
void draw_doubt(App& app);

void draw_questions(App& app);
void draw_export_dialog(App& app);
void draw_levels_dialog(App& app);
void draw_about(App& app);

}  // namespace probewarp
