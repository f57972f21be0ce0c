#include "render/overlay.h"

#include "model/refine.h"

namespace probewarp {

std::vector<OverlayVertex> weight_overlay(const Deformation& deformation, int probe) {
    const auto& probes = deformation.source.probes;
    const auto weights = weights_of(deformation);
    std::vector<OverlayVertex> vertices(deformation.now.size(), OverlayVertex{});
    if (probes.empty()) return vertices;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const auto row = weights.subspan(v * probes.size(), probes.size());
        glm::vec3 colour{0};
        float total = 0;
        for (std::size_t i = 0; i < probes.size(); ++i) {
            const Colour c = probes[i].colour;
            colour += row[i] / 255 * glm::vec3(c.r, c.g, c.b);
            total += row[i];
            if (probes[i].id == probe) vertices[v].value = row[i];
        }
        vertices[v].colour = colour / total;
        vertices[v].value /= total;
    }
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
