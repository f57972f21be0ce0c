#include "model/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/error.h"

namespace probewarp {

glm::dvec2 centre(const Image& image) { return {image.width / 2.0, image.height / 2.0}; }

const Probe* find_probe(const Document& document, int id) {
    const auto found = std::find_if(document.probes.begin(), document.probes.end(),
                                    [id](const Probe& probe) { return probe.id == id; });
    return found == document.probes.end() ? nullptr : &*found;
}

Probe* find_probe(Document& document, int id) {
    return const_cast<Probe*>(find_probe(std::as_const(document), id));
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
    const auto [columns, rows] = grid_size(image.width, image.height, document.cells);
    const std::size_t vertices = std::size_t(columns + 1) * std::size_t(rows + 1);
    if (vertices * document.probes.size() > max_weights)
        throw Error(
            fmt::format("{} vertices times {} probes are more than the {} weights that fit: choose a coarser "
                        "mesh or fewer probes",
                        vertices, document.probes.size(), max_weights));
}

namespace {

bool same_weights(const Document& a, const Document& b) {
    return a.weights == b.weights && std::equal(a.probes.begin(), a.probes.end(), b.probes.begin(),
                                                b.probes.end(), [](const Probe& p, const Probe& q) {
                                                    return p.rest == q.rest && p.radius == q.radius;
                                                });
}

}  // namespace

void update(Deformation& deformation, const Document& document) {
    assert(document.picture);
    const Document& before = deformation.source;
    const bool new_picture = before.picture != document.picture;
    const bool new_mesh = new_picture || before.cells != document.cells;
    const bool new_weights = new_mesh || !same_weights(before, document);
    if (!new_weights && before == document) return;

    check_size(document);
    const Image& image = document.picture->image;
    if (new_mesh) {
        deformation.mesh = grid_mesh(image.width, image.height, document.cells);
        ++deformation.mesh_version;
    }
    if (new_weights)
        deformation.weights =
            weight_table(*find_weight_scheme(document.weights), document.probes, deformation.mesh.rest);
    const glm::dvec2 middle = centre(image);
    deformation.transformations.clear();
    for (const Probe& probe : document.probes)
        deformation.transformations.push_back(cast<float>(transformation(probe, middle)));
    deformation.now.resize(deformation.mesh.rest.size());
    deformation.cancelled = find_blend_method(document.blend)
                                ->deform(deformation.mesh.rest, deformation.weights,
                                         deformation.transformations, glm::vec2(middle), deformation.now);
    deformation.source = document;
    ++deformation.version;
}

std::optional<PicturePose> pose_at(const Deformation& deformation, glm::dvec2 point) {
    const auto at = locate(deformation.mesh, deformation.now, point);
    if (!at) return {};
    const Document& document = deformation.source;
    PicturePose pose{rest_point(deformation.mesh, *at), 0};
    if (document.probes.empty()) return pose;

    std::vector<float> weights(document.probes.size());
    find_weight_scheme(document.weights)->at(document.probes, pose.rest, weights);
    const glm::dvec2 middle = centre(document.picture->image);
    std::vector<DualComplex<double>> transformations;
    double mean = 0, total = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        transformations.push_back(transformation(document.probes[i], middle));
        mean += double(weights[i]) * document.probes[i].angle;
        total += double(weights[i]);
    }
    const std::vector<double> shares(weights.begin(), weights.end());
    const auto blended = find_blend_method(document.blend)->blend(shares, transformations);
    // The blend knows the half angle up to whole turns of it; the probes' mean angle says which one is meant.
    const double half = std::arg(blended.p0), turn = 2 * std::numbers::pi;
    pose.angle = 2 * (half + turn * std::round((mean / total / 2 - half) / turn));
    return pose;
}

}  // namespace probewarp
