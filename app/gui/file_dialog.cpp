#include "gui/file_dialog.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cstdlib>

#include "gui/app.h"
#include "gui/widgets.h"

namespace probewarp {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_entries = 5000;

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

std::string size_text(std::uintmax_t bytes) {
    if (bytes < 1000) return fmt::format("{} B", bytes);
    if (bytes < 1000000) return fmt::format("{} kB", (bytes + 500) / 1000);
    return fmt::format("{:.1f} MB", double(bytes) / 1e6);
}

void list_folder(FileDialog& dialog) {
    dialog.entries.clear();
    dialog.trouble.clear();
    std::error_code error;
    for (fs::directory_iterator at(dialog.folder, fs::directory_options::skip_permission_denied, error), end;
         !error && at != end && dialog.entries.size() < most_entries; at.increment(error)) {
        std::error_code ignored;
        const std::string label = at->path().filename().string();
        if (label.starts_with('.')) continue;
        const bool is_folder = at->is_directory(ignored);
        const std::string ending = lower(at->path().extension().string());
        if (!is_folder &&
            std::find(dialog.endings.begin(), dialog.endings.end(), ending) == dialog.endings.end())
            continue;
        dialog.entries.push_back(
            {at->path(), label,
             is_folder ? "" : size_text(at->is_regular_file(ignored) ? at->file_size(ignored) : 0),
             is_folder});
    }
    if (error)
        dialog.trouble = fmt::format("{} cannot be listed: {}.", dialog.folder.string(), error.message());
    std::sort(dialog.entries.begin(), dialog.entries.end(), [](const auto& a, const auto& b) {
        return a.is_folder != b.is_folder ? a.is_folder : lower(a.label) < lower(b.label);
    });
}

void go_to(FileDialog& dialog, const fs::path& folder) {
    dialog.folder = folder.lexically_normal();
    dialog.overwrite_asked = false;
    list_folder(dialog);
}

/// What the field means: relative to the folder, "~" for home, with the usual ending when one saves without.
fs::path meant(const FileDialog& dialog) {
    std::string name = dialog.name;
    const char* home = std::getenv("HOME");
    if (home && name.starts_with("~/")) name = home + name.substr(1);
    fs::path path = dialog.folder / name;
    const std::string ending = lower(path.extension().string());
    const bool known =
        std::find(dialog.endings.begin(), dialog.endings.end(), ending) != dialog.endings.end();
    if (dialog.saving && !known) path += dialog.endings.front();
    return path.lexically_normal();
}

void accept(App& app) {
    FileDialog& dialog = app.file_dialog;
    if (dialog.name.empty()) return;
    const fs::path path = meant(dialog);
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        dialog.name.clear();
        go_to(dialog, path);
        return;
    }
    if (!dialog.saving && !fs::exists(path, ignored)) {
        dialog.trouble = "There is no such file.";
        return;
    }
    if (dialog.saving && fs::exists(path, ignored) && !dialog.overwrite_asked) {
        dialog.overwrite_asked = true;
        dialog.trouble = fmt::format("{} exists. Press {} once more to replace it.", path.filename().string(),
                                     dialog.action);
        return;
    }
    dialog.open = false;
    ImGui::CloseCurrentPopup();
    dialog.chosen(app, path);
}

void draw_places(App& app, float width, float height) {
    FileDialog& dialog = app.file_dialog;
    ImGui::BeginChild("##places", {width, height});
    const char* home = std::getenv("HOME");
    std::vector<std::pair<std::string, fs::path>> places;
    if (home) places.emplace_back("Home", home);
    for (const char* name : {"Desktop", "Pictures", "Downloads", "Documents"})
        if (home) places.emplace_back(name, fs::path(home) / name);
    places.emplace_back("Samples", samples_folder());
    places.emplace_back("Computer", "/");
    std::error_code ignored;
    for (const auto& [label, path] : places) {
        if (path.empty() || !fs::is_directory(path, ignored)) continue;
        if (ImGui::Selectable(label.c_str(), dialog.folder == path, 0, {0, app.px(24)})) go_to(dialog, path);
    }
    ImGui::EndChild();
}

void draw_entries(App& app, float height) {
    FileDialog& dialog = app.file_dialog;
    ImGui::PushStyleColor(ImGuiCol_ChildBg, app.theme.canvas);
    ImGui::BeginChild("##entries", {0, height}, false);
    ImGui::SetCursorPosY(app.px(4));
    fs::path entered;
    ImGuiListClipper clipper;
    clipper.Begin(int(dialog.entries.size()), app.px(28));
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const FileDialog::Entry& entry = dialog.entries[std::size_t(i)];
            ImGui::PushID(i);
            const ImVec2 at = ImGui::GetCursorScreenPos();
            const float right = at.x + ImGui::GetContentRegionAvail().x;
            if (ImGui::Selectable("##entry", !entry.is_folder && dialog.name == entry.label,
                                  ImGuiSelectableFlags_AllowDoubleClick,
                                  {0, app.px(28) - ImGui::GetStyle().ItemSpacing.y})) {
                if (entry.is_folder)
                    entered = entry.path;
                else {
                    dialog.name = entry.label;
                    dialog.overwrite_asked = false;
                    dialog.trouble.clear();
                    if (ImGui::IsMouseDoubleClicked(0)) accept(app);
                }
            }
            const float middle = at.y + (app.px(28) - ImGui::GetStyle().ItemSpacing.y) / 2;
            draw_icon(app.fonts.icons_small, {at.x + app.px(16), middle},
                      entry.is_folder ? app.theme.accent : app.theme.muted,
                      entry.is_folder ? icon::folder : icon::image);
            ImDrawList* list = ImGui::GetWindowDrawList();
            list->AddText({at.x + app.px(32), std::round(middle - ImGui::GetFontSize() / 2)}, app.theme.text,
                          entry.label.c_str());
            const float width = ImGui::CalcTextSize(entry.detail.c_str()).x;
            list->AddText({right - width - app.px(12), std::round(middle - ImGui::GetFontSize() / 2)},
                          app.theme.muted, entry.detail.c_str());
            ImGui::PopID();
        }
    if (dialog.entries.empty()) {
        ImGui::SetCursorPos({app.px(16), app.px(12)});
        ImGui::TextDisabled("Nothing here that can be used");
    }
    ImGui::EndChild();
    ImGui::PopStyleColor();
    if (!entered.empty()) go_to(dialog, entered);
}

}  // namespace

void ask_for_file(App& app, std::string title, std::string action, bool saving,
                  std::vector<std::string> endings, const fs::path& start,
                  std::function<void(App&, const fs::path&)> chosen) {
    FileDialog& dialog = app.file_dialog;
    dialog = {};
    dialog.open = dialog.focus_wanted = true;
    dialog.saving = saving;
    dialog.title = std::move(title);
    dialog.action = std::move(action);
    dialog.endings = std::move(endings);
    dialog.chosen = std::move(chosen);
    std::error_code ignored;
    const bool is_folder = fs::is_directory(start, ignored);
    dialog.name = is_folder ? "" : start.filename().string();
    fs::path folder = is_folder ? start : start.parent_path();
    if (!fs::is_directory(folder, ignored)) folder = std::getenv("HOME") ? std::getenv("HOME") : "/";
    go_to(dialog, fs::absolute(folder, ignored));
    app.wake();
}

void draw_file_dialog(App& app) {
    FileDialog& dialog = app.file_dialog;
    const std::string id = dialog.title + "###file";
    if (dialog.open && !ImGui::IsPopupOpen(id.c_str())) ImGui::OpenPopup(id.c_str());
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize(
        {std::min(app.px(720), display.x * 0.95f), std::min(app.px(520), display.y * 0.95f)});
    if (!ImGui::BeginPopupModal(
            id.c_str(), nullptr,
            ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings))
        return;
    if (icon_button(app, "##up", icon::up, "The folder above")) go_to(dialog, dialog.folder.parent_path());
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(dialog.folder.c_str());
    const float list_height = ImGui::GetContentRegionAvail().y - app.px(92);
    draw_places(app, app.px(130), list_height);
    ImGui::SameLine();
    draw_entries(app, list_height);
    ImGui::Spacing();
    row_label(app, "Name", 64);
    if (dialog.focus_wanted) ImGui::SetKeyboardFocusHere();
    dialog.focus_wanted = false;
    ImGui::SetNextItemWidth(-1);
    const bool entered = ImGui::InputText(
        "##name", &dialog.name, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemEdited()) dialog.trouble.clear(), dialog.overwrite_asked = false;
    if (entered) {
        accept(app);
        dialog.focus_wanted = dialog.open;
    }
    ImGui::Spacing();
    ImGui::PushTextWrapPos(ImGui::GetContentRegionMax().x - app.px(224));
    ImGui::TextUnformatted(dialog.trouble.c_str());
    ImGui::PopTextWrapPos();
    ImGui::SameLine(ImGui::GetContentRegionMax().x - app.px(208));
    if (ImGui::Button("Cancel", {app.px(100), app.px(28)}) || ImGui::IsKeyPressed(GLFW_KEY_ESCAPE)) {
        dialog.open = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::SameLine();
    if (accent_button(app, dialog.action.c_str(), {app.px(100), app.px(28)}, nullptr, !dialog.name.empty()))
        accept(app);
    if (!dialog.open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace probewarp
