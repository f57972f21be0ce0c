// `probewarp info`: what a picture or a project holds, and what would render it.
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/commands.h"
#include "io/printable.h"
#include "io/project.h"
#include "model/deformation.h"
#include "render/context.h"

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

std::string renderer_of(const std::string& backend) {
    try {
        const auto context = open_context(backend);
        return renderer_name();
    } catch (const Error& error) {
        return fmt::format("none: {}", error.what());
    }
}

Json description(const InfoOptions& o) {
    const Document document = read_document(o.input);
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
              {"icc_bytes", picture.image.icc.size()},
              {"pixels_per_metre", nullptr},
              {"mesh", json_of(document.mesh, *deformation.binding)},
              {"weights", json_of(document.weights)},
              {"blend", document.blend},
              {"cancelled_vertices", deformation.cancelled},
              {"stiffness", document.stiffness && !is_blank(*document.stiffness)},
              {"probes", std::move(probes)},
              {"renderer", renderer_of(o.backend)}};
    if (picture.image.resolution)
        json["pixels_per_metre"] = {picture.image.resolution->x, picture.image.resolution->y};
    return json;
}

void print_mesh(const Json& mesh) {
    fmt::print("mesh: {} x {} cells, {} vertices; ", mesh["columns"].get<int>(), mesh["rows"].get<int>(),
               mesh["vertices"].get<std::size_t>());
    if (mesh["from_alpha"].get<bool>())
        fmt::print("where alpha is above {}, and {:g} pixels around\n", mesh["threshold"].get<int>(),
                   mesh["margin"].get<double>());
    else
        fmt::print("whatever the alpha\n");
    const int lone = mesh["lone_islands"].get<int>();
    fmt::print("islands: {}{}\n", mesh["islands"].get<int>(),
               lone == 0 ? "" : fmt::format("; without a probe, so that they follow the nearest: {}", lone));
}

void print_weights(const Json& weights) {
    const double falloff = weights["falloff"].get<double>();
    const int most = weights["most"].get<int>();
    fmt::print("weights: {}, exponent {:g}, falloff {}, probes a vertex may follow: {}\n",
               printable(weights["scheme"].get<std::string>()), weights["exponent"].get<double>(),
               falloff > 0 ? fmt::format("{:g} reaches", falloff) : "none",
               most > 0 ? fmt::format("{}", most) : "all");
}

void print_text(const Json& json) {
    const auto text = [&json](const char* field) { return printable(json[field].get<std::string>()); };
    fmt::print("{}: {} ({}), {} x {} pixels, {} bits{}\n", text("file"), text("picture"), text("format"),
               json["width"].get<int>(), json["height"].get<int>(), json["bits"].get<int>(),
               json["alpha"].get<bool>() ? ", with transparency" : "");
    print_mesh(json["mesh"]);
    print_weights(json["weights"]);
    fmt::print(
        "blend: {}; vertices for which it has no answer, so that they follow their heaviest probe: {}\n",
        text("blend"), json["cancelled_vertices"].get<std::size_t>());
    fmt::print("stiffness: {}\n", json["stiffness"].get<bool>() ? "painted" : "none");
    fmt::print("probes: {}\n", json["probes"].size());
    for (const Json& p : json["probes"])
        fmt::print("  {}: {:g}, {:g} now at {:g}, {:g}, turned {:g} degrees, reach {:g}{}\n",
                   printable(p["name"].get<std::string>()), p["rest"][0].get<double>(),
                   p["rest"][1].get<double>(), p["now"][0].get<double>(), p["now"][1].get<double>(),
                   p["angle_degrees"].get<double>(), p["radius"].get<double>(),
                   p["painted"].get<bool>() ? ", painted" : "");
    fmt::print("renderer: {}\n", text("renderer"));
}

}  // namespace

void info(const InfoOptions& o) {
    const Json json = description(o);
    if (o.json)
        fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    else
        print_text(json);
}

}  // namespace probewarp
