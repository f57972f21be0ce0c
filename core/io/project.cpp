#include "io/project.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>

#include "io/file.h"
#include "io/image_file.h"
#include "io/lower_case.h"
#include "io/naming_errors.h"
#include "io/paint_file.h"
#include "io/printable.h"
#include "io/project_fields.h"
#include "io/unread_formats.h"
#include "io/zip_archive.h"

namespace probewarp {

namespace {

std::vector<std::byte> to_bytes(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

Colour colour_from(Fields& fields) {
    const std::string text = fields.text("colour", 7);
    if (text.size() != 7 || text[0] != '#' ||
        text.find_first_not_of("0123456789abcdef", 1) != std::string::npos)
        throw fields.wrong("colour", "#rrggbb in lower case");
    const unsigned long value = std::strtoul(text.c_str() + 1, nullptr, 16);
    return {std::uint8_t(value >> 16), std::uint8_t(value >> 8), std::uint8_t(value)};
}

/// Where a map of paint is in the archive.
struct PaintMember {
    std::string file;
    glm::dvec2 extent{0};
};

Json paint_json(const PaintPtr& paint, const std::string& file) {
    if (!paint) return nullptr;
    return {{"file", file}, {"extent", {paint->extent.x, paint->extent.y}}};
}

/// Empty where the field is null.
std::optional<PaintMember> paint_from(Fields& fields, const char* field) {
    const Json& json = fields.take(field);
    if (json.is_null()) return {};
    Fields paint(json, fields.place().empty() ? field : fields.place() + "." + field);
    PaintMember member;
    member.file = paint.file("file");
    member.extent = paint.point("extent", 1e-6, 1e6);
    paint.finish();
    return member;
}

constexpr const char* stiffness_file = "stiffness.png";
std::string paint_file(const Probe& probe) { return fmt::format("paint/{}.png", probe.id); }

Json to_json(const Probe& probe) {
    return {{"id", probe.id},
            {"name", probe.name},
            {"colour", to_hex(probe.colour)},
            {"rest", {probe.rest.x, probe.rest.y}},
            {"now", {probe.now.x, probe.now.y}},
            {"angle_radians", probe.angle},
            {"radius", probe.radius},
            {"locked", probe.locked},
            {"visible", probe.visible},
            {"paint", paint_json(probe.paint, paint_file(probe))}};
}

/// `paint` becomes the place of the probe's paint.
Probe probe_from(const Json& json, const std::string& place, int format, std::optional<PaintMember>& paint) {
    Fields fields(json, place);
    Probe probe;
    probe.id = fields.whole("id", 1, max_probe_id);
    probe.name = fields.text("name", 200);
    probe.colour = colour_from(fields);
    probe.rest = fields.point("rest");
    probe.now = fields.point("now");
    probe.angle = fields.number("angle_radians", -max_probe_angle, max_probe_angle);
    probe.radius = fields.number("radius", min_probe_radius, max_probe_coordinate);
    probe.locked = fields.yes("locked");
    probe.visible = fields.yes("visible");
    if (format > 1) paint = paint_from(fields, "paint");
    fields.finish();
    return probe;
}

/// A project holds names as one line of text, and a file's name may be anything.
std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '_';
    return text;
}

/// The place of the picture's bytes in the archive: "image" with its format's usual ending.
std::string image_member(const Picture& picture) {
    return fmt::format("image{}", find_image_format(picture.format)->extensions[0]);
}

/// Everything but the picture and the paint, and the names of their members and of the file the picture came
/// from.
struct Parsed {
    Document document;
    std::string image_file, image_name;
    std::vector<std::optional<PaintMember>> paint;  ///< #probes
    std::optional<PaintMember> stiffness;
};

MeshSettings mesh_from(const Json& json, int format) {
    Fields fields(json, "mesh");
    MeshSettings mesh;
    mesh.cells = fields.whole("cells", min_cells, max_cells);
    mesh.from_alpha = format > 1 && fields.yes("from_alpha");  // format 1 had the whole grid
    if (format > 1) {
        mesh.threshold = fields.whole("threshold", 0, 254);
        mesh.margin = fields.number("margin", 0, max_mesh_margin);
    }
    fields.finish();
    return mesh;
}

WeightSettings weights_from(Fields& fields, int format) {
    WeightSettings weights;
    if (format == 1) {
        weights.scheme = fields.text("weights", 80);
        if (!find_weight_scheme(weights.scheme))
            throw fields.wrong("weights", "a weight scheme that is known");
        return weights;
    }
    Fields inner(fields.take("weights"), "weights");
    weights.scheme = inner.text("scheme", 80);
    if (!find_weight_scheme(weights.scheme)) throw inner.wrong("scheme", "a weight scheme that is known");
    weights.exponent = inner.number("exponent", min_exponent, max_exponent);
    weights.falloff = inner.number("falloff", 0, max_falloff);
    weights.most = inner.whole("most", 0, max_most);
    inner.finish();
    return weights;
}

int format_from(Fields& fields) {
    const Json& format = fields.take("format");
    const std::string known = fmt::format("this version reads formats 1 to {}", project_format);
    if (format.is_number_integer() && format > project_format)
        throw Error(fmt::format(
            "was saved by a newer version of Probewarp, in format {}; {}: update Probewarp to open it",
            format.dump(), known));
    if (!format.is_number_integer() || format < 1)
        throw fields.wrong("format", "a whole number without quotes, as " + known);
    return format.get<int>();
}

Parsed parse_project(std::span<const std::byte> bytes) {
    const Json json = parse_project_json(bytes);
    Fields fields(json, "");
    const int version = format_from(fields);
    Parsed parsed;
    Fields image(fields.take("image"), "image");
    parsed.image_file = image.file("file");
    parsed.image_name = image.text("name", 1000);
    image.finish();
    parsed.document.mesh = mesh_from(fields.take("mesh"), version);
    parsed.document.weights = weights_from(fields, version);
    parsed.document.blend = fields.text("blend", 80);
    if (!find_blend_method(parsed.document.blend))
        throw fields.wrong("blend", "a blend method that is known");
    if (version > 1) parsed.stiffness = paint_from(fields, "stiffness");
    const Json& probes = fields.take("probes");
    if (!probes.is_array() || probes.size() > max_project_probes)
        throw fields.wrong("probes", fmt::format("a list of at most {} probes", max_project_probes));
    std::set<int> ids;
    for (std::size_t i = 0; i < probes.size(); ++i) {
        parsed.document.probes.push_back(
            probe_from(probes[i], fmt::format("probes[{}]", i), version, parsed.paint.emplace_back()));
        if (!ids.insert(parsed.document.probes.back().id).second)
            throw Error(fmt::format("project.json: probes[{}].id stands twice; expected ids to differ", i));
    }
    fields.finish();
    return parsed;
}

/// The members of a project's archive, and those that project.json names.
struct Archive {
    std::vector<ZipMember> members;
    std::set<std::string> named{"mimetype", "project.json"};

    std::vector<std::byte>& bytes_of(const std::string& name) {
        const auto found = std::ranges::find(members, name, &ZipMember::name);
        if (found == members.end())
            throw Error(fmt::format("has no member {}; expected it in a project", printable(name)));
        return found->bytes;
    }
};

/// The folder that all names lie in, with its slash; empty where they share none.
std::string shared_folder(std::span<const std::string> names) {
    if (names.empty()) return {};
    const std::string folder = names[0].substr(0, names[0].find('/') + 1);
    const bool shared =
        std::ranges::all_of(names, [&](const std::string& name) { return name.starts_with(folder); });
    return shared ? folder : std::string();
}

/// What stands before every name of a project that was unpacked and zipped again with the folder it lay in,
/// or with that one's folder too.
std::string wrapping_folders(std::vector<std::string> names) {
    constexpr int most = 4;  // a name may hold thousands
    std::string wrapping;
    for (int i = 0; i < most; ++i) {
        const std::string folder = shared_folder(names);
        for (std::string& name : names) name.erase(0, folder.size());
        wrapping += folder;
    }
    return wrapping;
}

/// Some other program's file, or one that is no project any more: said before anything else is found wrong
/// with it. wrapping: what stands before every name
void check_kind(std::span<const std::string> names, const std::string& wrapping) {
    const auto has = [&](const char* name) { return std::ranges::count(names, wrapping + name) > 0; };
    if (has("mimetype") && has("project.json")) return;
    throw Error(
        fmt::format("is a ZIP archive without {}, so it is not a Probewarp project; expected a "
                    "picture or a project",
                    has("project.json") ? "a member mimetype"
                    : has("mimetype")   ? "a member project.json"
                                        : "the members mimetype and project.json"));
}

Archive open_archive(std::span<const std::byte> bytes) {
    const std::vector<std::string> names = zip_names(bytes);
    const std::string wrapping = wrapping_folders(names);
    check_kind(names, wrapping);
    Archive archive;
    archive.members = read_zip(bytes, max_file_bytes);
    for (ZipMember& member : archive.members) member.name.erase(0, wrapping.size());
    const std::vector<std::byte>& type = archive.bytes_of("mimetype");
    if (type != to_bytes(project_mimetype))
        throw Error(fmt::format(
            "is not a Probewarp project, as its mimetype is \"{}\"; expected {}",
            printable({reinterpret_cast<const char*>(type.data()), std::min<std::size_t>(type.size(), 80)}),
            project_mimetype));
    return archive;
}

/// Null where there is no member.
PaintPtr read_paint(Archive& archive, const std::optional<PaintMember>& member, PaintBudget& budget) {
    if (!member) return nullptr;
    if (!archive.named.insert(member->file).second)
        throw Error(fmt::format("project.json names {} twice; expected a file for each", member->file));
    try {
        const std::vector<std::byte>& png = archive.bytes_of(member->file);
        return std::make_shared<const PaintMap>(decode_paint(png, member->extent, budget));
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", member->file, error.what()));
    }
}

/// What a project holds: the document without its picture, and that one's file.
struct Opened {
    Document document;
    std::vector<std::byte> image;
    std::string image_file, image_name;
};

Opened open_project(std::vector<std::byte> bytes) {
    if (const auto what = unread_archive(bytes)) throw Error(*what);
    settle_streamed_members(bytes);
    Archive archive = open_archive(bytes);
    bytes = {};  // the picture's pixels need the room
    Parsed parsed = parse_project(archive.bytes_of("project.json"));
    std::vector<std::byte>& image = archive.bytes_of(parsed.image_file);
    archive.named.insert(parsed.image_file);
    PaintBudget budget;
    for (std::size_t i = 0; i < parsed.paint.size(); ++i)
        parsed.document.probes[i].paint = read_paint(archive, parsed.paint[i], budget);
    parsed.document.stiffness = read_paint(archive, parsed.stiffness, budget);
    for (const ZipMember& member : archive.members)
        if (!archive.named.contains(member.name))
            throw Error(fmt::format(
                "has a member {} that this version does not know; expected a project of this version",
                member.name));
    return {std::move(parsed.document), std::move(image), parsed.image_file, parsed.image_name};
}

}  // namespace

std::vector<std::byte> encode_project(const Document& document) {
    Json probes = Json::array();
    for (const Probe& probe : document.probes) probes.push_back(to_json(probe));
    const Picture& picture = *document.picture;
    const Json json{{"format", project_format},
                    {"image", {{"file", image_member(picture)}, {"name", one_line(picture.name)}}},
                    {"mesh",
                     {{"cells", document.mesh.cells},
                      {"from_alpha", document.mesh.from_alpha},
                      {"threshold", document.mesh.threshold},
                      {"margin", document.mesh.margin}}},
                    {"weights",
                     {{"scheme", document.weights.scheme},
                      {"exponent", document.weights.exponent},
                      {"falloff", document.weights.falloff},
                      {"most", document.weights.most}}},
                    {"blend", document.blend},
                    {"stiffness", paint_json(document.stiffness, stiffness_file)},
                    {"probes", std::move(probes)}};
    const std::vector<std::byte> text =
        to_bytes(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    parse_project(text);  // a save that would not open again must fail now, while the document is still there
    // The picture is stored as it is: its own format has compressed it already, or it is quick to write.
    std::vector<ZipMember> members{{"mimetype", to_bytes(project_mimetype), true},
                                   {"project.json", text, false},
                                   {image_member(picture), picture.original, true}};
    PaintBudget budget;
    const auto add_paint = [&](const PaintPtr& paint, const std::string& file) {
        if (!paint) return;
        budget.texels += std::size_t(paint->width) * std::size_t(paint->height);
        budget.painted += painted_texels(*paint);
        members.push_back({file, encode_paint(*paint), true});
    };
    for (const Probe& probe : document.probes) add_paint(probe.paint, paint_file(probe));
    add_paint(document.stiffness, stiffness_file);
    budget.check();
    return write_zip(members);
}

Document decode_project(std::vector<std::byte> bytes, const std::string& name, Pixels pixels,
                        const DecodeOptions& options) {
    Opened opened = naming_errors(name, [&] { return open_project(std::move(bytes)); });
    Document& document = opened.document;
    Picture picture = decode_picture(std::move(opened.image), fmt::format("{}: {}", name, opened.image_file),
                                     pixels, options);
    picture.name = opened.image_name;
    document.picture = std::make_shared<Picture>(std::move(picture));
    naming_errors(name, [&] { check_size(document); });
    return std::move(document);
}

bool is_project_path(const std::filesystem::path& path) { return lower_ending(path) == project_extension; }

bool is_project(std::span<const std::byte> bytes) { return is_zip(bytes); }

Document read_document(const std::filesystem::path& path, Pixels pixels, const DecodeOptions& options) {
    std::vector<std::byte> bytes = read_file(path);
    if (is_project(bytes)) return decode_project(std::move(bytes), path.string(), pixels, options);
    Document document;
    Picture picture = decode_picture(std::move(bytes), path.string(), pixels, options);
    picture.name = one_line(path.filename().string());
    document.picture = std::make_shared<Picture>(std::move(picture));
    return document;
}

}  // namespace probewarp
