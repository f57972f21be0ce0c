#include "io/same_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <system_error>

namespace probewarp {

namespace fs = std::filesystem;

std::optional<fs::path> follow_links(fs::path path) {
    for (int hops = 0; hops < 40; ++hops) {  // 40: as many as Linux follows
        std::error_code no_link;
        const fs::path target = fs::read_symlink(path, no_link);
        if (no_link) return path;
        path = target.is_absolute() ? target : path.parent_path() / target;
    }
    return {};
}

FileIdentity identity_of(const fs::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0) return {status.st_dev, status.st_ino, {}};
    std::error_code ignored;
    const fs::path absolute = fs::absolute(follow_links(path).value_or(path), ignored);
    fs::path folder = fs::weakly_canonical(absolute, ignored);
    if (folder.empty()) folder = absolute.lexically_normal();
    fs::path below;
    while (::stat(folder.c_str(), &status) != 0 && folder.has_relative_path()) {
        below = below.empty() ? folder.filename() : folder.filename() / below;
        folder = folder.parent_path();
    }
    return {status.st_dev, status.st_ino, below.native()};
}

bool is_same_file(const fs::path& a, const fs::path& b) { return identity_of(a) == identity_of(b); }

std::string why_not_written(std::span<const UsedFile> read, std::span<const UsedFile> written) {
    std::map<FileIdentity, const UsedFile*> inputs, outputs;
    for (const UsedFile& file : read) inputs.emplace(identity_of(file.path), &file);
    for (const UsedFile& file : written) {
        const FileIdentity identity = identity_of(file.path);
        if (const auto input = inputs.find(identity); input != inputs.end())
            return fmt::format("{}: this is {}; expected another file", file.name, input->second->name);
        if (const auto [other, fresh] = outputs.emplace(identity, &file); !fresh)
            return fmt::format("{}: this is the same file as {}; expected another file", file.name,
                               other->second->name);
    }
    return {};
}

const UsedFile* find_open_file(std::span<const UsedFile> files, int descriptor) {
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return nullptr;
    const FileIdentity identity{status.st_dev, status.st_ino, {}};
    const auto found = std::find_if(files.begin(), files.end(),
                                    [&](const UsedFile& file) { return identity_of(file.path) == identity; });
    return found == files.end() ? nullptr : &*found;
}

}  // namespace probewarp
