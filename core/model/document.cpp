#include "model/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "model/error.h"

namespace probewarp {

glm::dvec2 centre(const Image& image) { return {image.width / 2.0, image.height / 2.0}; }

PictureFrame frame_of(const Image& image) {
    return {centre(image), double(std::max(image.width, image.height))};
}

PaintMap map_of(const Document& document, const PaintPtr& paint) {
    const Image& image = document.picture->image;
    return paint ? *paint : new_paint_map(image.width, image.height);
}

const Probe* find_probe(const Document& document, int id) {
    const auto found = std::find_if(document.probes.begin(), document.probes.end(),
                                    [id](const Probe& probe) { return probe.id == id; });
    return found == document.probes.end() ? nullptr : &*found;
}

Probe* find_probe(Document& document, int id) {
    return const_cast<Probe*>(find_probe(std::as_const(document), id));
}

std::size_t place_of(const Document& document, int id) {
    const Probe* probe = find_probe(document, id);
    assert(probe);
    return std::size_t(probe - document.probes.data());
}

Probe new_probe(const Document& document, glm::dvec2 rest) {
    Probe probe;
    for (const Probe& other : document.probes) probe.id = std::max(probe.id, other.id);
    if (++probe.id > max_probe_id)  // a file may have begun near the end
        for (probe.id = 1; find_probe(document, probe.id);) ++probe.id;
    probe.name = fmt::format("Probe {}", probe.id);
    probe.colour = probe_colour(probe.id - 1);
    probe.rest = probe.now = rest;
    if (document.picture)
        probe.radius =
            std::max(1.0, std::max(document.picture->image.width, document.picture->image.height) / 8.0);
    return probe;
}

Document unposed(Document document) {
    for (Probe& probe : document.probes) put_to_rest(probe);
    return document;
}

bool is_painted(const Document& document) {
    return std::any_of(document.probes.begin(), document.probes.end(),
                       [](const Probe& probe) { return probe.paint != nullptr; });
}

void replace_picture(Document& document, PicturePtr picture) {
    if (document.picture) {
        const Image &from = document.picture->image, &to = picture->image;
        const double factor = double(std::max(to.width, to.height)) / std::max(from.width, from.height);
        for (Probe& probe : document.probes) {
            probe.rest = centre(to) + factor * (probe.rest - centre(from));
            probe.now = centre(to) + factor * (probe.now - centre(from));
            probe.radius *= factor;
        }
    }
    document.picture = std::move(picture);
}

void check_size(const Document& document) {
    const Image& image = document.picture->image;
    const auto [columns, rows] = grid_size(image.width, image.height, document.mesh.cells);
    // A vertex at each probe besides the grid's.
    const std::size_t vertices = std::size_t(columns + 1) * std::size_t(rows + 1) + document.probes.size();
    if (vertices * document.probes.size() > max_weights)
        throw Error(
            fmt::format("{} vertices times {} probes are more than the {} weights that fit: choose a coarser "
                        "mesh or fewer probes",
                        vertices, document.probes.size(), max_weights));
}

}  // namespace probewarp
