// The dialog that chooses a file to open or to save: places, folders, and a field to type a path into.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace probewarp {

struct App;

struct FileDialog {
    bool open = false, saving = false;
    std::string title, action;         ///< "Open", and the word on its button
    std::vector<std::string> endings;  ///< lower case with the dot; files with others are not listed
    std::function<void(App&, const std::filesystem::path&)> chosen;

    std::filesystem::path folder;
    std::string name;  ///< what is typed: a file's name or a whole path
    struct Entry {
        std::filesystem::path path;
        std::string label, detail;
        bool is_folder = false;
    };
    std::vector<Entry> entries;
    std::string trouble;  ///< why the folder cannot be listed or the name not be taken
    bool overwrite_asked = false;
    bool focus_wanted = false;
};

/// Opens the dialog at `start`: a folder, or a file whose name is proposed.
void ask_for_file(App& app, std::string title, std::string action, bool saving,
                  std::vector<std::string> endings, const std::filesystem::path& start,
                  std::function<void(App&, const std::filesystem::path&)> chosen);

void draw_file_dialog(App& app);

}  // namespace probewarp
