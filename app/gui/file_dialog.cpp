#include "gui/file_dialog.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <imgui_stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <utility>

#include "editor/clicks.h"
#include "gui/app.h"
#include "gui/dialogs.h"
#include "gui/shown_text.h"
#include "gui/widgets.h"
#include "io/lower_case.h"
#include "io/printable.h"

namespace probewarp {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_entries = 5000;

std::string size_text(std::uintmax_t bytes) {
    if (bytes < 1000) return fmt::format("{} B", bytes);
    if (bytes < 1000000) return fmt::format("{} kB", (bytes + 500) / 1000);
    return fmt::format("{:.1f} MB", double(bytes) / 1e6);
}

void list_folder(FileDialog& dialog) {
    dialog.entries.clear();
    dialog.trouble.clear();
    ++dialog.listing;
    dialog.scrolled = false;
    std::error_code error;
    for (fs::directory_iterator at(dialog.folder, fs::directory_options::skip_permission_denied, error), end;
         !error && at != end && dialog.entries.size() < most_entries; at.increment(error)) {
        std::error_code ignored;
        const std::string label = at->path().filename().string();
        if (label.starts_with('.')) continue;
        const bool is_folder = at->is_directory(ignored);
        const std::string ending = lower_ending(at->path());
        if (!is_folder &&
            std::find(dialog.endings.begin(), dialog.endings.end(), ending) == dialog.endings.end())
            continue;
        dialog.entries.push_back(
            {at->path(), label,
             is_folder ? "" : size_text(at->is_regular_file(ignored) ? at->file_size(ignored) : 0),
             is_folder});
    }
    if (error)
        dialog.trouble =
            fmt::format("{} cannot be listed: {}.", printable(dialog.folder.native()), error.message());
    std::sort(dialog.entries.begin(), dialog.entries.end(), [](const auto& a, const auto& b) {
        return a.is_folder != b.is_folder ? a.is_folder : lower_case(a.label) < lower_case(b.label);
    });
}

/// Lists another folder. What was picked in the old one is no more; a name that is to be saved stays.
void go_to(FileDialog& dialog, const fs::path& folder) {
    dialog.folder = folder.lexically_normal();
    if (dialog.use == FileUse::open)
        dialog.name = {};
    else
        dialog.name.put(dialog.name.meant().filename());
    dialog.focus_wanted = true;
    list_folder(dialog);
}

void finish(App& app, const fs::path& path) {
    FileDialog& dialog = app.file_dialog;
    dialog.open = false;
    app.last_folder = path.parent_path();
    const auto chosen = dialog.chosen;
    chosen(app, path);
}

MeantPath meant(const FileDialog& dialog) {
    return meant_path(dialog.name.meant().native(), dialog.folder, dialog.endings,
                      dialog.use != FileUse::open);
}

bool would_replace(const FileDialog& dialog, const MeantPath& path) {
    std::error_code ignored;
    return dialog.use == FileUse::save && !path.is_folder && path.trouble.empty() &&
           fs::exists(path.path, ignored);
}

/// Takes what is typed or picked. `replaces`: the person saw that it replaces a file, and pressed what says
/// so.
void accept(App& app, bool replaces) {
    FileDialog& dialog = app.file_dialog;
    const MeantPath path = meant(dialog);
    dialog.trouble = path.trouble;
    if (!path.trouble.empty()) return;
    if (path.is_folder) {
        dialog.name.put(dialog.proposed);
        return go_to(dialog, path.path);
    }
    if (!replaces && would_replace(dialog, path))
        return ask_before_replacing(app, path.path, [path = path.path](App& a) { finish(a, path); });
    finish(app, path.path);
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

/// Counts a click on an entry in. Returns whether it means the list that is there: a click that follows one
/// on an earlier list falls on what has come to lie under the pointer since. `twice` becomes whether it is
/// the second on this entry.
bool count_click(App& app, const fs::path& entry, bool& twice) {
    FileDialog& dialog = app.file_dialog;
    ClickChain& clicks = dialog.clicks;
    const ImVec2 at = ImGui::GetIO().MousePos;
    const bool follows = clicks.last >= 0 && ImGui::GetTime() - clicks.last <= double_click_seconds &&
                         std::hypot(at.x - clicks.place.x, at.y - clicks.place.y) <= app.px(6);
    if (!follows) clicks = {.listing = dialog.listing};
    clicks.last = ImGui::GetTime();
    clicks.place = at;
    twice = clicks.on == entry;
    clicks.on = twice ? fs::path() : entry;
    return clicks.listing == dialog.listing;
}

void click_entry(App& app, std::size_t at) {
    FileDialog& dialog = app.file_dialog;
    const FileDialog::Entry entry = dialog.entries[at];
    bool twice = false;
    dialog.focus_wanted = true;  // so that Return takes what is picked, and what is typed goes on
    if (!count_click(app, entry.path, twice)) return;
    if (entry.is_folder) return go_to(dialog, entry.path);
    dialog.name.put_name(entry.path);
    dialog.trouble.clear();
    if (twice) accept(app, false);
}

void draw_entry(App& app, const FileDialog::Entry& entry, ImVec2 at, float right) {
    const float middle = at.y + (app.px(28) - ImGui::GetStyle().ItemSpacing.y) / 2;
    const float y = std::round(middle - ImGui::GetFontSize() / 2);
    draw_icon(app.fonts.icons_small, {at.x + app.px(16), middle},
              entry.is_folder ? app.theme.accent : app.theme.muted,
              entry.is_folder ? icon::folder : icon::image);
    const float detail = ImGui::CalcTextSize(entry.detail.c_str()).x;
    ImGui::GetWindowDrawList()->AddText({right - detail - app.px(12), y}, app.theme.muted,
                                        entry.detail.c_str());
    const float left = at.x + app.px(32), gap = detail > 0 ? app.px(28) : app.px(12);
    draw_shown(app, {left, y}, right - detail - gap - left, app.theme.text, entry.label);
}

void draw_entries(App& app, float height) {
    FileDialog& dialog = app.file_dialog;
    ImGui::PushStyleColor(ImGuiCol_ChildBg, app.theme.canvas);
    ImGui::BeginChild("##entries", {0, height}, false);
    if (!std::exchange(dialog.scrolled, true)) ImGui::SetScrollY(0);
    ImGui::SetCursorPosY(app.px(4));
    std::size_t clicked = dialog.entries.size();
    const float row = app.px(28) - ImGui::GetStyle().ItemSpacing.y;
    ImGuiListClipper clipper;
    clipper.Begin(int(dialog.entries.size()), app.px(28));
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const FileDialog::Entry& entry = dialog.entries[std::size_t(i)];
            ImGui::PushID(i);
            const ImVec2 at = ImGui::GetCursorScreenPos();
            const float right = at.x + ImGui::GetContentRegionAvail().x;
            const bool picked = !entry.is_folder && dialog.name.meant() == entry.path;
            // By the press: until the release another item may have taken the mouse, the name's field for
            // one.
            const bool by_key =
                ImGui::Selectable("##entry", picked, 0, {0, row}) && !ImGui::IsMouseReleased(0);
            if (by_key || (ImGui::IsItemHovered() && ImGui::IsMouseClicked(0))) clicked = std::size_t(i);
            draw_entry(app, entry, at, right);
            ImGui::PopID();
        }
    if (dialog.entries.empty()) {
        ImGui::SetCursorPos({app.px(16), app.px(12)});
        ImGui::TextDisabled("Nothing here that can be used");
    }
    ImGui::EndChild();
    ImGui::PopStyleColor();
    if (clicked < dialog.entries.size()) click_entry(app, clicked);
}

void draw_folder_row(App& app) {
    FileDialog& dialog = app.file_dialog;
    if (icon_button(app, "##up", icon::up, "The folder above")) go_to(dialog, dialog.folder.parent_path());
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    draw_wrapped(app, dialog.folder.native(), 1);
}

void draw_name_field(App& app) {
    FileDialog& dialog = app.file_dialog;
    row_label(app, "Name", 64);
    if (std::exchange(dialog.focus_wanted, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1);
    const bool entered =
        ImGui::InputText("##name", &dialog.name.text,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    app.glyphs.ask(dialog.name.text);
    if (ImGui::IsItemEdited()) dialog.trouble.clear();
    if (!entered) return;
    accept(app, false);
    dialog.focus_wanted = dialog.focus_wanted || (dialog.open && !app.doubt);
}

/// The sentence at the lower left: what is the matter, or what would be replaced.
void draw_remark(App& app, const MeantPath& path, bool replaces) {
    const FileDialog& dialog = app.file_dialog;
    const std::string remark =
        !dialog.trouble.empty() ? dialog.trouble
        : replaces
            ? fmt::format("{} is there already: {}.", path.path.filename().string(), age_and_size(path.path))
            : std::string();
    ImGui::PushStyleColor(ImGuiCol_Text, replaces ? app.theme.warning : app.theme.text);
    draw_wrapped(app, remark, 2, app.px(216));
    ImGui::PopStyleColor();
}

void draw_answers(App& app) {
    FileDialog& dialog = app.file_dialog;
    const ImVec2 at = ImGui::GetCursorPos(), button{app.px(100), app.px(28)};
    const MeantPath path = meant(dialog);
    const bool replaces = would_replace(dialog, path);
    draw_remark(app, path, replaces);
    ImGui::SetCursorPos({ImGui::GetContentRegionMax().x - app.px(208), at.y});
    const bool escaped = !app.doubt && ImGui::IsKeyPressed(GLFW_KEY_ESCAPE);
    if (ImGui::Button("Cancel", button) || escaped) dialog.open = false;
    ImGui::SameLine();
    const char* action = replaces ? "Replace" : dialog.action.c_str();
    if (accent_button(app, action, button, nullptr, !dialog.name.text.empty())) accept(app, replaces);
}

}  // namespace

std::string age_and_size(const fs::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return {};
    std::tm when{};
    ::localtime_r(&status.st_mtim.tv_sec, &when);
    return fmt::format("{} of {:%d %B %Y, %H:%M}", size_text(std::uintmax_t(status.st_size)), when);
}

void ask_for_file(App& app, std::string title, std::string action, FileUse use,
                  std::vector<std::string> endings, const fs::path& start,
                  std::function<void(App&, const fs::path&)> chosen) {
    FileDialog& dialog = app.file_dialog;
    dialog = {};
    dialog.open = dialog.focus_wanted = true;
    dialog.use = use;
    dialog.title = std::move(title);
    dialog.action = std::move(action);
    dialog.endings = std::move(endings);
    dialog.chosen = std::move(chosen);
    // The second click of a double-click on what opens the dialog means none of its entries.
    dialog.clicks = {.last = ImGui::GetTime(), .place = ImGui::GetIO().MousePos};
    std::error_code ignored;
    const bool is_folder = fs::is_directory(start, ignored);
    fs::path folder = is_folder ? start : start.parent_path();
    if (!fs::is_directory(folder, ignored)) folder = std::getenv("HOME") ? std::getenv("HOME") : "/";
    go_to(dialog, fs::absolute(folder, ignored));
    if (!is_folder) dialog.proposed = start.filename();
    dialog.name.put(dialog.proposed);
    app.wake();
}

void draw_file_dialog(App& app) {
    FileDialog& dialog = app.file_dialog;
    const std::string id = dialog.title + "###file";
    if (dialog.open && !ImGui::IsPopupOpen(id.c_str())) ImGui::OpenPopup(id.c_str());
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize(
        {std::min(app.px(720), display.x - app.px(24)), std::min(app.px(520), display.y - app.px(24))});
    if (!ImGui::BeginPopupModal(
            id.c_str(), nullptr,
            ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings))
        return;
    keep_messages_off(app);
    draw_folder_row(app);
    const float list_height = ImGui::GetContentRegionAvail().y - app.px(92);
    draw_places(app, app.px(130), list_height);
    ImGui::SameLine();
    draw_entries(app, list_height);
    ImGui::Spacing();
    draw_name_field(app);
    ImGui::Spacing();
    draw_answers(app);
    draw_doubt(app);
    if (!dialog.open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace probewarp
