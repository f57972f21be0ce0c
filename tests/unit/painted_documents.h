// Small painted maps and documents, and what their shares are, for the tests of what is done to paint.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "model/share_lookup.h"
#include "pictures.h"

namespace probewarp::testing {

/// A map over a picture of that size, a texel a pixel.
inline PaintMap map_of(int width, int height) {
    return empty_paint_map(width, height, glm::dvec2(width, height) / double(std::max(width, height)));
}

/// The map with edit(x, y) in each texel.
template <class Edit>
PaintMap painted(PaintMap map, Edit edit) {
    edit_texels(map, 0, 0, map.width, map.height, [&](int x, int y, Paint) { return edit(x, y); });
    return map;
}

inline PaintPtr shared(PaintMap map) { return std::make_shared<const PaintMap>(std::move(map)); }

inline Deformation deformation_of(const Document& document) {
    Deformation deformation;
    update(deformation, document);
    return deformation;
}

inline Document three_probes(int cells = 4) {
    Document document = blank_document(40, 30, cells);
    for (const glm::dvec2 rest : {glm::dvec2(8, 9), {30, 12}, {18, 25}}) add_probe(document, rest, rest);
    return document;
}

inline std::vector<float> looked_up(const Deformation& deformation, glm::dvec2 point) {
    std::vector<float> shares(deformation.source.probes.size());
    ShareLookup(deformation).at(point, shares);
    return shares;
}

}  // namespace probewarp::testing
