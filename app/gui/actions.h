// What the window does when the editor asks: files in, files out, questions before anything is lost.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace probewarp {

struct App;

/// Carries out what the editor asked for since the last frame.
void handle_requests(App& app);

/// Opens a picture or a project in place of the present document, after asking where work would be lost.
/// `others`: how many came with it and are not opened; that is said.
void open_path(App& app, const std::filesystem::path& path, std::size_t others = 0);

/// Opens what was dropped on the window, as GLFW hands it on, or says why not.
void open_dropped(App& app, std::span<const char* const> dropped);

/// Runs `then` at once, or after the person has saved or thrown away what is not saved.
void after_saving(App& app, const char* what, std::function<void(App&)> then);

/// Ends what the hand is at: a field's number is kept, a drag is taken back.
void end_gesture(App& app);

/// Whether the path leads to the project or to a picture of the document, by whatever name.
bool is_being_read(const App& app, const std::filesystem::path& path);

/// The path that the export dialog's text means: "~" is home, a bare name is beside the project.
std::filesystem::path export_path(const App& app);

/// Renders and writes the picture as the export dialog says.
void export_to(App& app, const std::filesystem::path& path);

/// The name that the window shows: the project's, else the picture's, without control characters.
std::string document_name(const App& app);

}  // namespace probewarp
