// `probewarp info`: what a picture or a project holds, and what would render it.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/printing.h"
#include "io/printable.h"
#include "io/project.h"
#include "io/same_file.h"
#include "model/deformation.h"
#include "model/folds.h"
#include "model/instruction_set.h"
#include "render/context.h"
#include "render/deform_trial.h"

namespace probewarp {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Probe& probe) {
    return {{"id", probe.id},
            {"name", probe.name},
            {"rest", {probe.rest.x, probe.rest.y}},
            {"now", {probe.now.x, probe.now.y}},
            {"angle_degrees", probe.angle * 180 / std::numbers::pi},
            {"radius", probe.radius},
            {"painted", probe.paint && !is_blank(*probe.paint)}};
}

Json json_of(const MeshSettings& settings, const Binding& binding) {
    const Mesh& mesh = *binding.mesh;
    return {{"cells", settings.cells},          {"from_alpha", settings.from_alpha},
            {"threshold", settings.threshold},  {"margin", settings.margin},
            {"columns", mesh.columns},          {"rows", mesh.rows},
            {"vertices", mesh.rest.size()},     {"triangles", mesh.triangles.size() / 3},
            {"islands", binding.islands.count}, {"lone_islands", lone_islands(binding)}};
}

Json json_of(const WeightSettings& settings) {
    return {{"scheme", settings.scheme},
            {"exponent", settings.exponent},
            {"falloff", settings.falloff},
            {"most", settings.most}};
}

/// Who would deform in a window that draws as this context does.
Json deform_choice(const std::string& renderer) {
    const auto times = measured_deform_times();
    const DeformChoice choice = choose_deform(DeformBy::automatic, renderer, times);
    const auto name = std::ranges::find(deform_by_names, choice.by, &DeformByName::by)->name;
    Json json{{"by", name},
              {"why", choice.why},
              {"vertices", DeformTrial::vertices},
              {"probes", DeformTrial::probes},
              {"processor_milliseconds", nullptr},
              {"shader_milliseconds", nullptr}};
    if (!times) return json;
    json["processor_milliseconds"] = times->processor;
    json["shader_milliseconds"] = times->shader;
    return json;
}

void add_renderer(Json& json, const std::string& backend) {
    try {
        const auto context = open_context(backend);
        json["renderer"] = renderer_name();
        json["deform"] = deform_choice(renderer_name());
    } catch (const Error& error) {
        json["renderer"] = fmt::format("none: {}", error.what());
        json["deform"] = nullptr;
    }
}

/// What the file says about its colours and its pixels, beside what `description` has said always; null where
/// it does not say. Numbers as PNG's specification writes them: a gamma of 1 is linear light.
void add_description(Json& json, const Description& said) {
    constexpr double whole = 100000;
    json["gamma"] = said.gamma ? Json(*said.gamma / whole) : Json();
    json["chromaticities"] = Json();
    if (said.chromaticities)
        for (const std::uint32_t value : *said.chromaticities)
            json["chromaticities"].push_back(value / whole);
    json["srgb_intent"] = said.srgb_intent ? Json(*said.srgb_intent) : Json();
    json["cicp"] = said.cicp ? Json(*said.cicp) : Json();
    json["aspect"] = said.aspect ? Json({said.aspect->x, said.aspect->y}) : Json();
    json["exif_bytes"] = said.exif.size();
}

Json description(const InfoOptions& o) {
    const Document document = read_document(o.input, Pixels::whole, {.salvage = o.salvage});
    Deformation deformation;
    update(deformation, document);
    const Picture& picture = *document.picture;
    Json probes = Json::array();
    for (const Probe& probe : document.probes) probes.push_back(json_of(probe));
    Json json{{"file", o.input},
              {"picture", picture.name},
              {"format", picture.format},
              {"width", picture.image.width},
              {"height", picture.image.height},
              {"bits", picture.image.bits()},
              {"alpha", has_alpha(picture.image)},
              {"incomplete", picture.image.incomplete},
              {"icc_bytes", picture.image.description.icc.size()},
              {"pixels_per_metre", nullptr},
              {"mesh", json_of(document.mesh, *deformation.binding)},
              {"weights", json_of(document.weights)},
              {"blend", document.blend},
              {"cancelled_vertices", deformation.cancelled},
              {"folded_triangles", folded_triangles(mesh_of(deformation), deformation.now)},
              {"stiffness", document.stiffness && !is_blank(*document.stiffness)},
              {"probes", std::move(probes)},
              {"instruction_set", instruction_sets().front()}};
    add_renderer(json, o.backend);
    if (picture.image.description.resolution)
        json["pixels_per_metre"] = {picture.image.description.resolution->x,
                                    picture.image.description.resolution->y};
    add_description(json, picture.image.description);
    return json;
}

void print_mesh(const Json& mesh) {
    print("mesh: {} x {} cells, {} vertices; ", mesh["columns"].get<int>(), mesh["rows"].get<int>(),
          mesh["vertices"].get<std::size_t>());
    if (mesh["from_alpha"].get<bool>())
        print("where alpha is above {}, and {:g} pixels around\n", mesh["threshold"].get<int>(),
              mesh["margin"].get<double>());
    else
        print("whatever the alpha\n");
    const int lone = mesh["lone_islands"].get<int>();
    print("islands: {}{}\n", mesh["islands"].get<int>(),
          lone == 0 ? "" : fmt::format("; without a probe, so that they follow the nearest: {}", lone));
}

void print_weights(const Json& weights) {
    const double falloff = weights["falloff"].get<double>();
    const int most = weights["most"].get<int>();
    print("weights: {}, exponent {:g}, falloff {}, probes a vertex may follow: {}\n",
          printable(weights["scheme"].get<std::string>()), weights["exponent"].get<double>(),
          falloff > 0 ? fmt::format("{:g} reaches", falloff) : "none",
          most > 0 ? fmt::format("{}", most) : "all");
}

void print_deform(const Json& deform) {
    if (deform.is_null()) return;
    print("deforms by: {}; {}\n", deform["by"].get<std::string>(),
          printable(deform["why"].get<std::string>()));
    if (deform["shader_milliseconds"].is_null()) return;
    print("a step of a drag, {} vertices by {} probes: processor {:.3f} ms, shader {:.3f} ms\n",
          deform["vertices"].get<std::size_t>(), deform["probes"].get<int>(),
          deform["processor_milliseconds"].get<double>(), deform["shader_milliseconds"].get<double>());
}

void print_text(const Json& json) {
    const auto text = [&json](const char* field) { return printable(json[field].get<std::string>()); };
    print("{}: {} ({}), {} x {} pixels, {} bits{}{}\n", text("file"), text("picture"), text("format"),
          json["width"].get<int>(), json["height"].get<int>(), json["bits"].get<int>(),
          json["alpha"].get<bool>() ? ", with transparency" : "",
          json["incomplete"].get<bool>() ? ", incomplete" : "");
    print_mesh(json["mesh"]);
    print_weights(json["weights"]);
    print("blend: {}; vertices for which it has no answer, so that they follow their heaviest probe: {}\n",
          text("blend"), json["cancelled_vertices"].get<std::size_t>());
    print("triangles that lie folded over: {}\n", json["folded_triangles"].get<std::size_t>());
    print("stiffness: {}\n", json["stiffness"].get<bool>() ? "painted" : "none");
    print("probes: {}\n", json["probes"].size());
    for (const Json& p : json["probes"])
        print("  {}: {:g}, {:g} now at {:g}, {:g}, turned {:g} degrees, reach {:g}{}\n",
              printable(p["name"].get<std::string>()), p["rest"][0].get<double>(), p["rest"][1].get<double>(),
              p["now"][0].get<double>(), p["now"][1].get<double>(), p["angle_degrees"].get<double>(),
              p["radius"].get<double>(), p["painted"].get<bool>() ? ", painted" : "");
    print("instruction set: {}\n", text("instruction_set"));
    print("renderer: {}\n", text("renderer"));
    print_deform(json["deform"]);
}

}  // namespace

void info(const InfoOptions& o) {
    const UsedFile read[]{{"the input itself", o.input}};
    check_files(read, {});
    const Json json = description(o);
    if (o.json)
        print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    else
        print_text(json);
}

}  // namespace probewarp
