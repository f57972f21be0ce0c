// `probewarp info`: what a picture or a project holds, and what would render it.
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/commands.h"
#include "io/printable.h"
#include "io/project.h"
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
            {"radius", probe.radius}};
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
              {"mesh",
               {{"cells", document.cells},
                {"columns", deformation.mesh.columns},
                {"rows", deformation.mesh.rows},
                {"vertices", deformation.mesh.rest.size()},
                {"triangles", deformation.mesh.triangles.size() / 3}}},
              {"weights", document.weights},
              {"blend", document.blend},
              {"cancelled_vertices", deformation.cancelled},
              {"probes", std::move(probes)},
              {"renderer", renderer_of(o.backend)}};
    if (picture.image.resolution)
        json["pixels_per_metre"] = {picture.image.resolution->x, picture.image.resolution->y};
    return json;
}

void print_text(const Json& json) {
    const auto text = [&json](const char* field) { return printable(json[field].get<std::string>()); };
    fmt::print("{}: {} ({}), {} x {} pixels, {} bits{}\n", text("file"), text("picture"), text("format"),
               json["width"].get<int>(), json["height"].get<int>(), json["bits"].get<int>(),
               json["alpha"].get<bool>() ? ", with transparency" : "");
    fmt::print("mesh: {} x {} cells, {} vertices\n", json["mesh"]["columns"].get<int>(),
               json["mesh"]["rows"].get<int>(), json["mesh"]["vertices"].get<std::size_t>());
    fmt::print("weights: {}; blend: {}; vertices whose weights cancel: {}\n", text("weights"), text("blend"),
               json["cancelled_vertices"].get<std::size_t>());
    fmt::print("probes: {}\n", json["probes"].size());
    for (const Json& p : json["probes"])
        fmt::print("  {}: {:g}, {:g} now at {:g}, {:g}, turned {:g} degrees, reach {:g}\n",
                   printable(p["name"].get<std::string>()), p["rest"][0].get<double>(),
                   p["rest"][1].get<double>(), p["now"][0].get<double>(), p["now"][1].get<double>(),
                   p["angle_degrees"].get<double>(), p["radius"].get<double>());
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
