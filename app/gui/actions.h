// What the window does when the editor asks: files in, files out, questions before anything is lost.
#pragma once

#include <filesystem>
#include <functional>

namespace probewarp {

struct App;

/// Carries out what the editor asked for since the last frame.
void handle_requests(App& app);

/// Opens a picture or a project in place of the present document, after asking where work would be lost.
void open_path(App& app, const std::filesystem::path& path);

/// Runs `then` at once, or after the person has saved or thrown away what is not saved.
void after_saving(App& app, const char* what, std::function<void(App&)> then);

/// Ends what the hand is at: a field's number is kept, a drag is taken back.
void end_gesture(App& app);

/// Whether the path means a Wavefront OBJ.
bool is_obj(const std::filesystem::path& path);

/// The path that the export dialog's text means: "~" is home, a bare name is beside the project.
std::filesystem::path export_path(const App& app);

/// Renders and writes the picture as the export dialog says.
void export_to(App& app, const std::filesystem::path& path);

/// The name that the window shows: the project's, else the picture's.
std::string document_name(const App& app);

}  // namespace probewarp
