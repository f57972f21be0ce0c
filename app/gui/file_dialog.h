// The dialog that chooses a file to open or to save: places, folders, and a field to type a path into.
#pragma once

#include <imgui.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gui/file_names.h"

namespace probewarp {

struct App;

/// What the chosen file is for.
enum class FileUse {
    open,
    save,  ///< at once: before one is replaced, that is asked
    name,  ///< later, by a dialog that asks for itself
};

/// Clicks of the left button that belong together: each soon after the one before it, at the same place.
struct ClickChain {
    double last = -1;            ///< seconds of ImGui's clock; negative: there was none
    ImVec2 place{0, 0};          ///< of the last, window pixels
    int listing = 0;             ///< FileDialog::listing at the first
    std::filesystem::path on{};  ///< what the last but one was on; empty at the first
};

struct FileDialog {
    bool open = false;
    FileUse use = FileUse::open;
    std::string title, action;         ///< "Open", and the word on its button
    std::vector<std::string> endings;  ///< lower case with the dot; files with others are not listed
    std::function<void(App&, const std::filesystem::path&)> chosen;

    std::filesystem::path folder;
    PathField name;                  ///< what is typed or picked: a file's name or a whole path
    std::filesystem::path proposed;  ///< the name to save by unless another is typed; may be empty
    struct Entry {
        std::filesystem::path path;
        std::string label, detail;
        bool is_folder = false;
    };
    std::vector<Entry> entries;
    int listing = 0;  ///< counts the folders that were listed
    ClickChain clicks;
    std::string trouble;  ///< why the folder cannot be listed or the name not be taken
    bool focus_wanted = false, scrolled = false;
};

/// Opens the dialog at `start`: a folder, or a file whose name is proposed.
void ask_for_file(App& app, std::string title, std::string action, FileUse use,
                  std::vector<std::string> endings, const std::filesystem::path& start,
                  std::function<void(App&, const std::filesystem::path&)> chosen);

void draw_file_dialog(App& app);

/// "12 kB of 3 May 2026, 14:05": what stands at the path; empty where nothing can be said.
std::string age_and_size(const std::filesystem::path& path);

}  // namespace probewarp
