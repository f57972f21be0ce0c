#include "gui/file_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "io/lower_case.h"
#include "io/printable.h"

namespace probewarp {

namespace fs = std::filesystem;

namespace {

bool is_blank(std::string_view text) { return text.find_first_not_of(" .") == std::string_view::npos; }

bool is_folder(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

MeantPath trouble(std::string sentence) { return {{}, false, std::move(sentence)}; }

/// `path` without the slash at its end.
fs::path without_slash(const fs::path& path) {
    return path.has_filename() || path == path.root_path() ? path : path.parent_path();
}

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; }

/// What saving makes of a name: with one of the endings, and something before it.
MeantPath with_ending(fs::path path, std::span<const std::string> endings) {
    std::string name = path.filename().string();
    const auto is_ending = [&](const std::string& text) {
        return std::find(endings.begin(), endings.end(), lower_case(text)) != endings.end();
    };
    if (is_ending(name)) return trouble(fmt::format("The name before {} is missing.", name));
    if (!is_ending(path.extension().string())) {
        name.resize(name.find_last_not_of('.') + 1);
        name += endings.front();
        path.replace_filename(name);
        if (is_folder(path)) return trouble(fmt::format("{} is a folder.", printable(name)));
    }
    if (!has_stem(path)) return trouble("The name needs more than spaces and dots.");
    if (name.size() > most_name_bytes)
        return trouble(
            fmt::format("The name is {} bytes long; at most {} fit.", name.size(), most_name_bytes));
    return {path, false, {}};
}

}  // namespace

fs::path without_tilde(std::string_view typed) {
    const char* home = std::getenv("HOME");
    if (home && typed == "~") return home;
    if (home && typed.starts_with("~/")) return fs::path(home) / typed.substr(2);
    return typed;
}

bool has_stem(const fs::path& path) {
    const std::string name = path.filename().string();
    const auto dot = name.rfind('.');
    return !is_blank(std::string_view(name).substr(0, dot));
}

MeantPath meant_path(std::string_view typed, const fs::path& folder, std::span<const std::string> endings,
                     bool saving) {
    if (typed.empty()) return trouble("The name is missing.");
    if (is_blank(typed)) return trouble("A name needs more than spaces and dots.");
    const fs::path path = (folder / without_tilde(typed)).lexically_normal();
    if (is_folder(path)) return {without_slash(path), true, {}};
    if (!path.has_filename())
        return trouble(fmt::format("There is no folder {}.", printable(without_slash(path).native())));
    if (!is_folder(path.parent_path()))
        return trouble(fmt::format("There is no folder {}.", printable(path.parent_path().native())));
    if (is_blank(path.filename().native())) return trouble("A name needs more than spaces and dots.");
    if (saving) return with_ending(path, endings);
    std::error_code error;
    if (!fs::exists(path, error))
        return trouble(
            fmt::format("There is no file {} in this folder.", printable(path.filename().native())));
    return {path, false, {}};
}

std::string fitting_name(std::string_view stem, std::string_view ending) {
    if (stem.size() + ending.size() > most_name_bytes) {
        std::size_t cut = most_name_bytes - ending.size();
        while (cut > 0 && is_continuation(stem[cut])) --cut;
        stem = stem.substr(0, cut);
    }
    return std::string(stem).append(ending);
}

std::optional<fs::path> dropped_path(std::string_view dropped) {
    const auto colon = dropped.find(':');
    const std::string scheme = lower_case(dropped.substr(0, colon));
    if (colon == std::string_view::npos || dropped.starts_with('/')) return fs::path(dropped);
    if (scheme != "file") return {};
    std::string_view rest = dropped.substr(colon + 1);
    if (rest.starts_with("//")) {  // a host comes first, which may be empty
        const auto slash = rest.find('/', 2);
        if (slash == std::string_view::npos) return {};
        rest = rest.substr(slash);
    }
    return rest.starts_with('/') ? std::optional(fs::path(rest)) : std::nullopt;
}

namespace {

/// Text as a field gives it back: printable, and U+FFFD for what takes more than 16 bits.
std::string field_text(const fs::path& path) {
    std::string text = printable(path.native());
    for (std::size_t i = 0; i < text.size(); ++i)
        if ((static_cast<unsigned char>(text[i]) & 0xF8u) == 0xF0u) text.replace(i, 4, "\uFFFD");
    return text;
}

}  // namespace

void PathField::put(const fs::path& path) {
    exact_ = path;
    text = shown_ = field_text(path);
}

void PathField::put_name(const fs::path& path) {
    exact_ = path;
    text = shown_ = field_text(path.filename());
}

fs::path PathField::meant() const {
    if (text == shown_) return exact_;
    const auto slash = text.rfind('/');
    if (slash != std::string::npos && shown_.rfind('/') != std::string::npos &&
        text.substr(0, slash) == shown_.substr(0, shown_.rfind('/')))
        return exact_.parent_path() / text.substr(slash + 1);
    return text;
}

}  // namespace probewarp
