#include "io/project.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "io/file.h"
#include "io/image_file.h"
#include "io/naming_errors.h"
#include "io/paint_file.h"
#include "io/printable.h"
#include "io/unread_formats.h"
#include "io/zip_archive.h"

namespace probewarp {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t max_json_bytes = std::size_t{16} << 20;
constexpr int max_json_depth = 8;
constexpr std::size_t max_probes = 10000;
constexpr std::size_t max_json_objects = 2 * max_probes + 8;  // a probe and its paint, the project a few
constexpr std::size_t max_json_lists = 3 * max_probes + 8;    // rest, now and the paint's extent of each
constexpr std::size_t max_json_fields = 64;                   // of one object

std::vector<std::byte> to_bytes(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

/// Parses with a limit on depth, and without a key that stands twice in one object.
Json parse(std::span<const std::byte> bytes) {
    if (bytes.size() > max_json_bytes) throw Error("project.json is too long; expected at most 16 MiB");
    std::vector<std::set<std::string>> keys(max_json_depth + 2);
    std::size_t objects = 0, lists = 0;
    const auto watch = [&](int depth, Json::parse_event_t event, Json& parsed) {
        if (depth > max_json_depth)
            throw Error(fmt::format("project.json is nested deeper than expected: at most {} levels",
                                    max_json_depth));
        // The library takes time in the square of an outer list's objects.
        if (event == Json::parse_event_t::object_start && ++objects > max_json_objects)
            throw Error(
                fmt::format("project.json holds too much; expected at most {} objects", max_json_objects));
        if (event == Json::parse_event_t::array_start && ++lists > max_json_lists)
            throw Error(
                fmt::format("project.json holds too much; expected at most {} lists", max_json_lists));
        const auto level = std::size_t(depth);
        if (event == Json::parse_event_t::object_start) keys[level + 1].clear();
        if (event == Json::parse_event_t::key && !keys[level].insert(parsed.get<std::string>()).second)
            throw Error(fmt::format("project.json has the field \"{}\" twice; expected it once",
                                    printable(parsed.get<std::string>().substr(0, 80))));
        if (keys[level].size() > max_json_fields)
            throw Error(fmt::format("project.json has an object with too many fields; expected at most {}",
                                    max_json_fields));
        return true;
    };
    const auto* first = reinterpret_cast<const char*>(bytes.data());
    try {
        return Json::parse(first, first + bytes.size(), watch);
    } catch (const Json::parse_error& error) {
        throw Error(fmt::format("project.json is damaged at byte {}; expected JSON", error.byte));
    } catch (const Json::out_of_range&) {
        throw Error("project.json has a number that is too large; expected one that a double can hold");
    }
}

/// An object's fields, taken one by one; what is left at the end is unknown.
class Fields {
  public:
    Fields(const Json& json, std::string place) : json_(json), place_(std::move(place)) {
        if (!json.is_object()) throw wrong("", "an object");
    }

    Error wrong(const std::string& field, std::string_view expected) const {
        return Error(fmt::format("project.json: {} is wrong or missing; expected {}",
                                 place_.empty() || field.empty() ? place_ + field : place_ + "." + field,
                                 expected));
    }
    const Json& take(const char* field) {
        const auto found = json_.find(field);
        if (found == json_.end()) throw wrong(field, "it to be there");
        taken_.insert(field);
        return *found;
    }
    double number(const char* field, double least, double most) {
        return checked(take(field), field, least, most);
    }
    int whole(const char* field, int least, int most) {
        const Json& value = take(field);
        if (!value.is_number_integer() || value < least || value > most)
            throw wrong(field, fmt::format("a whole number from {} to {}", least, most));
        return value.get<int>();
    }
    bool yes(const char* field) {
        const Json& value = take(field);
        if (!value.is_boolean()) throw wrong(field, "true or false");
        return value.get<bool>();
    }
    std::string text(const char* field, std::size_t longest) {
        const Json& value = take(field);
        std::string text = value.is_string() ? value.get<std::string>() : std::string();
        if (!value.is_string() || text.size() > longest || std::any_of(text.begin(), text.end(), [](char c) {
                return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
            }))
            throw wrong(field, fmt::format("a line of text of at most {} bytes", longest));
        return text;
    }
    glm::dvec2 point(const char* field, double least = -max_probe_coordinate,
                     double most = max_probe_coordinate) {
        const Json& value = take(field);
        if (!value.is_array() || value.size() != 2) throw wrong(field, "two numbers");
        return {checked(value[0], field, least, most), checked(value[1], field, least, most)};
    }
    std::string place() const { return place_; }
    void finish() const {
        for (const auto& [key, value] : json_.items())
            if (!taken_.contains(key))
                throw Error(fmt::format(
                    "project.json has the field \"{}\"{}, which this version does not know; expected "
                    "a project of this version",
                    printable(key.substr(0, 80)), place_.empty() ? "" : " in " + place_));
    }

  private:
    double checked(const Json& value, const char* field, double least, double most) const {
        if (!value.is_number() || !(value.get<double>() >= least) || !(value.get<double>() <= most))
            throw wrong(field, fmt::format("a number from {:g} to {:g}", least, most));
        return value.get<double>();
    }

    const Json& json_;
    std::string place_;
    std::set<std::string> taken_;
};

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
    member.file = paint.text("file", 80);
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

Parsed parse_project(std::span<const std::byte> bytes) {
    const Json json = parse(bytes);
    Fields fields(json, "");
    const Json& format = fields.take("format");
    if (!format.is_number_integer() || format < 1 || format > project_format)
        throw Error(fmt::format("project.json has format {}; this version reads formats 1 to {}",
                                format.is_number_integer() ? format.dump() : "unknown", project_format));
    const int version = format.get<int>();
    Parsed parsed;
    Fields image(fields.take("image"), "image");
    parsed.image_file = image.text("file", 80);
    parsed.image_name = image.text("name", 1000);
    image.finish();
    parsed.document.mesh = mesh_from(fields.take("mesh"), version);
    parsed.document.weights = weights_from(fields, version);
    parsed.document.blend = fields.text("blend", 80);
    if (!find_blend_method(parsed.document.blend))
        throw fields.wrong("blend", "a blend method that is known");
    if (version > 1) parsed.stiffness = paint_from(fields, "stiffness");
    const Json& probes = fields.take("probes");
    if (!probes.is_array() || probes.size() > max_probes)
        throw fields.wrong("probes", fmt::format("a list of at most {} probes", max_probes));
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

Archive open_archive(std::span<const std::byte> bytes) {
    Archive archive;
    archive.members = read_zip(bytes, max_file_bytes);
    const auto& members = archive.members;
    if (members.empty() || members[0].name != "mimetype" || members[0].bytes != to_bytes(project_mimetype))
        throw Error("is not a Probewarp project; expected a ZIP archive whose first member is its mimetype");
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
