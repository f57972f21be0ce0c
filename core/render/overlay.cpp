#include "render/overlay.h"

#include <algorithm>

#include "model/over_blocks.h"
#include "model/refine.h"

namespace probewarp {

std::vector<OverlayVertex> weight_overlay(const Deformation& deformation, int probe) {
    const auto& probes = deformation.source.probes;
    const auto weights = weights_of(deformation);
    const std::size_t count = deformation.now.size();
    std::vector<OverlayVertex> vertices(count, OverlayVertex{});
    if (probes.empty()) return vertices;
    std::vector<glm::vec3> colours;
    for (const Probe& p : probes) colours.push_back(glm::vec3(p.colour.r, p.colour.g, p.colour.b) / 255.0f);
    const auto own = std::size_t(std::ranges::find(probes, probe, &Probe::id) - probes.begin());
    over_blocks({0, count}, count, probes.size(), [&](VertexRun run) {
        for (std::size_t v = run.first; v < run.first + run.count; ++v) {
            const auto row = weights.subspan(v * probes.size(), probes.size());
            glm::vec3 colour{0};
            float total = 0;
            for (std::size_t i = 0; i < row.size(); ++i) {
                colour += row[i] * colours[i];
                total += row[i];
            }
            vertices[v].colour = colour / total;
            if (own < row.size()) vertices[v].value = row[own] / total;
        }
        return std::size_t{0};
    });
    return vertices;
}

std::vector<OverlayVertex> stiffness_overlay(const Deformation& deformation, const PaintMap* stiffness) {
    std::vector<OverlayVertex> vertices(deformation.now.size(), OverlayVertex{});
    if (!stiffness) return vertices;
    const PictureFrame frame = frame_of(deformation.source.picture->image);
    const auto values = stiffness_at(*stiffness, frame, mesh_of(deformation).rest);
    for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v].value = values[v];
    return vertices;
}

}  // namespace probewarp
