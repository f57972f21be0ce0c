#include "model/binding.h"

#include <algorithm>
#include <cassert>

namespace probewarp {

namespace {

template <class Same>
bool same_probes(const Document& a, const Document& b, Same same) {
    return std::equal(a.probes.begin(), a.probes.end(), b.probes.begin(), b.probes.end(), same);
}

bool same_ids(const Document& a, const Document& b) {
    return same_probes(a, b, [](const Probe& p, const Probe& q) { return p.id == q.id; });
}

bool same_rests(const Document& a, const Document& b) {
    return same_probes(a, b, [](const Probe& p, const Probe& q) { return p.rest == q.rest; });
}

bool same_grid(const Document& a, const Document& b) { return a.picture == b.picture && a.mesh == b.mesh; }

std::shared_ptr<const Mesh> mesh_for(const Document& document, std::span<const std::uint8_t> kept) {
    std::vector<glm::dvec2> rests;
    for (const Probe& probe : document.probes) rests.push_back(probe.rest);
    return std::make_shared<const Mesh>(
        probe_mesh(document.picture->image, document.mesh.cells, kept, rests));
}

}  // namespace

bool same_means(const Document& a, const Document& b) {
    // How many probes a vertex may follow is decided afterwards, with the paint.
    return same_grid(a, b) && a.weights.scheme == b.weights.scheme &&
           a.weights.exponent == b.weights.exponent && a.weights.falloff == b.weights.falloff;
}

bool binds_alike(const Document& a, const Document& b) {
    return same_means(a, b) && same_ids(a, b) && same_rests(a, b) &&
           same_probes(a, b, [](const Probe& p, const Probe& q) { return p.radius == q.radius; });
}

bool is_bound(const Binding* binding, const Document& document) {
    return binding && binds_alike(binding->source, document);
}

bool fits(const Binding* binding, const Document& document) {
    return binding && binding->source.picture == document.picture && same_ids(binding->source, document);
}

std::shared_ptr<const Binding> make_binding(const Document& document,
                                            const std::shared_ptr<const Binding>& before,
                                            const std::atomic<bool>* given_up) {
    assert(document.picture);
    check_size(document);
    auto binding = std::make_shared<Binding>();
    binding->source = document;
    const bool keep_cells = before && same_grid(before->source, document);
    const bool keep_mesh = keep_cells && same_rests(before->source, document);
    binding->kept = keep_cells ? before->kept : visible_cells(document.picture->image, document.mesh);
    binding->still =
        keep_cells ? before->still : still_cells(document.picture->image, document.mesh, binding->kept);
    binding->mesh = keep_mesh ? before->mesh : mesh_for(document, binding->kept);
    binding->islands = keep_mesh ? before->islands : islands_of(*binding->mesh);
    if (keep_cells) binding->cache = before->cache;
    if (document.probes.empty()) return binding;

    const WeightScheme& scheme = *find_weight_scheme(document.weights.scheme);
    const WeightInput input{*binding->mesh, binding->islands, document.probes, document.weights.exponent,
                            binding->cache, given_up};
    binding->automatic = scheme.table(input);
    if (scheme.in_shape) binding->followed = followed_probes(input);
    if (document.weights.falloff > 0)
        fade_weights(document.weights.falloff, document.probes, binding->mesh->rest, binding->automatic);
    return binding;
}

std::shared_ptr<const Binding> carried_over(const std::shared_ptr<const Binding>& binding,
                                            const Document& document) {
    if (!binding) return nullptr;
    Document alike = document;
    alike.picture = binding->source.picture;
    const Image &before = alike.picture->image, &now = document.picture->image;
    if (!is_bound(binding.get(), alike) || before.width != now.width || before.height != now.height ||
        binding->kept != visible_cells(now, document.mesh))
        return nullptr;
    auto other = std::make_shared<Binding>(*binding);
    other->source = document;
    other->still = still_cells(now, document.mesh, other->kept);
    return other;
}

int lone_islands(const Binding& binding) {
    return int(binding.followed.size()) -
           int(std::count(binding.followed.begin(), binding.followed.end(), no_vertex));
}

}  // namespace probewarp
