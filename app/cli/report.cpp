#include "cli/report.h"

#include <nlohmann/json.hpp>

#include "model/folds.h"

namespace probewarp {

namespace {

using Json = nlohmann::ordered_json;

void add_canvas(Json& json, const Deformation& deformation, const View& view) {
    const auto offset = exported_offset(view, deformation.source.picture->image.description);
    json["width"] = view.width;
    json["height"] = view.height;
    json["scale"] = {view.scale.x, view.scale.y};
    json["origin"] = {view.origin.x, view.origin.y};
    json["offset"] = offset ? Json(*offset) : Json();
}

}  // namespace

std::string report_of(const std::filesystem::path& output, const OutputFormat& format,
                      const Deformation& deformation, const View* view) {
    const Picture& picture = *deformation.source.picture;
    const Mesh& mesh = mesh_of(deformation);
    Json companions = Json::array();
    for (const auto& file : written_files(output, format))
        if (file != output) companions.push_back(file.string());
    Json json{{"output", output.string()},
              {"format", name_of(format)},
              {"companions", std::move(companions)},
              {"picture", picture.name},
              {"incomplete", picture.image.incomplete}};
    if (view) add_canvas(json, deformation, *view);
    json["vertices"] = mesh.rest.size();
    json["triangles"] = mesh.triangles.size() / 3;
    json["folded_triangles"] = folded_triangles(mesh, deformation.now);
    json["cancelled_vertices"] = deformation.cancelled;
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace probewarp
