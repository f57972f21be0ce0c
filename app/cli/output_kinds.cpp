#include "cli/output_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "io/obj.h"
#include "io/project.h"

namespace probewarp {

namespace {

/// The outputs for which an option means something.
enum class For { pictures, png };

struct OptionUse {
    std::string_view option;
    For use;
};

/// Of `render`; what is not here is obeyed whatever is written.
constexpr std::array<OptionUse, 11> option_uses{{
    {"--scale", For::pictures},
    {"--size", For::pictures},
    {"--samples", For::pictures},
    {"--canvas", For::pictures},
    {"--background", For::pictures},
    {"--compression", For::png},
    {"--heat", For::pictures},
    {"--opacity", For::pictures},
    {"--iso-lines", For::pictures},
    {"--backend", For::pictures},
    {"--deform", For::pictures},
}};

bool is_used(For use, const OutputFormat& format) {
    return format.kind == Kind::image && (use == For::pictures || format.image->name == "png");
}

/// "png, jpeg, bmp or tga": the formats that are written.
std::string written_formats() {
    std::vector<std::string_view> names;
    for (const ImageFormat& format : image_formats())
        if (format.encode) names.push_back(format.name);
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += fmt::format("{}{}", i == 0 ? "" : i + 1 == names.size() ? " or " : ", ", names[i]);
    return text;
}

}  // namespace

OutputFormat output_format(const RenderOptions& o) {
    if (o.output == "-" && o.format.empty()) throw UsageError("-o -: expected --format with it");
    if (o.format == "obj" || (o.format.empty() && is_obj(o.output))) return {Kind::mesh};
    if (o.format == "probewarp" || (o.format.empty() && is_project_path(o.output))) return {Kind::project};
    const ImageFormat* format = o.format.empty() ? image_format_of(o.output) : find_image_format(o.format);
    if (!format || !format->encode)
        throw UsageError(fmt::format("{} cannot be written; expected png, jpeg, bmp, tga, obj or probewarp",
                                     o.format.empty() ? o.output : "--format " + o.format));
    return {Kind::image, format};
}

std::string label_of(const OutputFormat& format) {
    if (format.kind == Kind::mesh) return "OBJ";
    return format.kind == Kind::project ? "a project" : std::string(format.image->label);
}

std::string name_of(const OutputFormat& format) {
    if (format.kind == Kind::mesh) return "obj";
    return format.kind == Kind::project ? "probewarp" : std::string(format.image->name);
}

void check_options(const RenderOptions& o, const OutputFormat& format) {
    for (const auto& [option, use] : option_uses)
        if (o.given.contains(option) && !is_used(use, format))
            throw UsageError(
                fmt::format("{}: has no meaning for {}; expected {}", option, label_of(format),
                            use == For::png ? "png" : "a picture's format: " + written_formats()));
    if (o.given.contains("--background") && o.background == "none" && format.kind == Kind::image &&
        format.image->name == "jpeg")
        throw UsageError("--background none: JPEG has no transparency; expected a colour, such as white");
    if (o.report && o.output == "-")
        throw UsageError("--report: standard output holds the file; expected another output than -");
}

void check_options(const WeightsOptions& o) {
    if (o.output.empty() && !o.size.empty())
        throw UsageError("--size: has no meaning where no maps are written; expected -o FOLDER with it");
}

std::vector<std::filesystem::path> written_files(const std::filesystem::path& path,
                                                 const OutputFormat& format) {
    if (path == "-") return {};
    if (format.kind == Kind::mesh) return obj_files(path);
    return {path};
}

}  // namespace probewarp
