#include "model/deformation.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/refine.h"

namespace probewarp {

const Mesh& mesh_of(const Deformation& deformation) { return *deformation.binding->mesh; }

std::span<const float> weights_of(const Deformation& deformation) {
    return deformation.refined ? *deformation.refined : deformation.binding->automatic;
}

namespace {

bool same_locks(const Document& a, const Document& b) {
    return std::equal(a.probes.begin(), a.probes.end(), b.probes.begin(), b.probes.end(),
                      [](const Probe& p, const Probe& q) { return p.locked == q.locked; });
}

/// Whether the refined weights differ in single vertices at most: stiffness joins many, and a new limit meets
/// all.
bool differ_by_vertex(const Document& a, const Document& b) {
    return a.weights.most == b.weights.most && !a.stiffness && !b.stiffness;
}

/// Those vertices.
std::vector<VertexRun> changed_runs(const Document& before, const Document& after, const Mesh& mesh) {
    if (same_locks(before, after)) return repainted(before, after, mesh);
    // Who is locked matters wherever there is paint.
    Document bare = after;
    for (Probe& probe : bare.probes) probe.paint = nullptr;
    std::vector<VertexRun> runs = repainted(bare, before, mesh);
    for (const VertexRun run : repainted(bare, after, mesh)) runs.push_back(run);
    return runs;
}

Pose pose_of(const Deformation& d, const Document& document) {
    return {d.motions, d.transformations, glm::vec2(centre(document.picture->image))};
}

/// As a DeformFunction, of the tiles; without probes nothing moves.
std::size_t deform_run(Deformation& d, const Document& document, VertexRun run) {
    const std::span<const glm::vec2> rest = mesh_of(d).rest;
    if (!d.motions.empty())
        return find_blend_method(document.blend)
            ->deform(d.quick.tiles, rest, pose_of(d, document), run, d.now);
    std::copy(rest.begin(), rest.end(), d.now.begin());
    return 0;
}

/// Which vertices' weights have to be worked out anew.
struct Refining {
    bool all = false;
    std::vector<VertexRun> runs;  ///< where not all
};

/// rebound: whether the deformation has another binding than that of its source
Refining refining_for(const Deformation& d, const Document& document, bool rebound) {
    if (!is_refined(document)) return {d.refined != nullptr, {}};
    if (rebound) return {true, {}};
    if (differ_by_vertex(d.source, document)) return {false, changed_runs(d.source, document, mesh_of(d))};
    const bool same = d.refined && d.source.weights.most == document.weights.most &&
                      d.source.stiffness == document.stiffness && same_locks(d.source, document) &&
                      repainted(d.source, document, mesh_of(d)).empty();
    return {!same, {}};
}

/// Works the weights of one run out.
void refine_run(Deformation& d, const Document& document, VertexRun run) {
    const std::size_t probes = document.probes.size();
    const auto weights = std::span(*d.refined).subspan(run.first * probes, run.count * probes);
    settle_run(document, *d.binding, run, weights);
    put(d.quick.tiles, run, weights);
}

/// Works all weights out.
void refine_all(Deformation& d, const Document& document) {
    d.refined = nullptr;  // before the next are made: they are large
    if (is_refined(document))
        d.refined = std::make_shared<std::vector<float>>(refined_weights(document, *d.binding));
}

/// Lets go of the tiles, whose memory will be used again.
void untile(Deformation& d) {
    d.quick.tiles.vertices = 0;
    d.quick.others = {};
}

/// Makes sure of the tiles, where there are weights.
void tile(Deformation& d) {
    if (d.motions.empty()) d.quick = {};
    if (d.quick.tiles.vertices > 0 || d.motions.empty()) return;
    d.quick.tiles = make_tiles(weights_of(d), d.motions.size(), std::move(d.quick.tiles.weights));
}

std::vector<Motion<double>> motions_of(const Document& document) {
    std::vector<Motion<double>> all;
    for (const Probe& probe : document.probes)
        all.push_back(motion_of(probe, centre(document.picture->image)));
    return all;
}

std::vector<DualComplex<float>> transformations_of(std::span<const Motion<double>> motions) {
    std::vector<DualComplex<float>> all;
    for (const auto& motion : motions) all.push_back(cast<float>(motion.p));
    return all;
}

/// The one probe whose motion differs; empty where there is none, or more than one.
std::optional<std::size_t> only_moved(std::span<const Motion<double>> before,
                                      std::span<const Motion<double>> after) {
    if (before.size() != after.size()) return {};
    const auto [first, moved] = std::mismatch(before.begin(), before.end(), after.begin());
    if (first == before.end() || !std::equal(first + 1, before.end(), moved + 1)) return {};
    return std::size_t(first - before.begin());
}

/// Moves all vertices. `dragged`: the probe that alone was moved, if so
void deform_all(Deformation& d, const Document& document, std::optional<std::size_t> dragged) {
    OthersSum& others = d.quick.others;
    d.dragged = dragged && find_blend_method(document.blend)->summed && !d.now.empty();
    if (!d.dragged) {
        others = {};
        d.cancelled = deform_run(d, document, {0, d.now.size()});
        return;
    }
    const Pose pose = pose_of(d, document);
    if (others.values.empty() || others.probe != *dragged) others = sum_others(d.quick.tiles, pose, *dragged);
    d.cancelled = deform_dlb_dragged(d.quick.tiles, others, mesh_of(d).rest, pose, d.now);
}

/// Works the weights of some vertices out, and where the pose is the same, where these go; the others must be
/// where they belong then.
void refine_runs(Deformation& d, const Document& document, std::span<const VertexRun> runs, bool same_pose) {
    if (runs.empty()) return;
    d.quick.others = {};
    if (!d.refined || d.refined.use_count() > 1)
        d.refined = std::make_shared<std::vector<float>>(weights_of(d).begin(), weights_of(d).end());
    // A copy that was let go on another thread has read what is written to now.
    std::atomic_thread_fence(std::memory_order_acquire);
    for (const VertexRun run : runs) {
        if (same_pose) d.cancelled -= deform_run(d, document, run);
        refine_run(d, document, run);
        if (same_pose) d.cancelled += deform_run(d, document, run);
    }
}

}  // namespace

WeightsKey weights_key(const Deformation& deformation) {
    return {deformation.binding, unposed(deformation.source)};
}

std::vector<DualComplex<float>> transformations_of(const Document& document) {
    return transformations_of(motions_of(document));
}

void pose(Deformation& d, const Document& document, std::shared_ptr<const Binding> binding, Pace pace) {
    assert(fits(binding.get(), document));
    const bool dragging = pace == Pace::dragging;
    const bool rebound = d.binding != binding;
    if (!rebound && d.source == document && (dragging || !d.dragged)) return;
    auto motions = motions_of(document);
    const bool same_blend = !rebound && d.source.blend == document.blend;
    const bool same_pose = same_blend && !d.dragged && d.motions == motions;
    std::optional<std::size_t> dragged;
    if (dragging && same_blend) dragged = only_moved(d.motions, motions);
    if (!d.binding || d.binding->mesh != binding->mesh) ++d.mesh_version;
    d.binding = std::move(binding);
    d.transformations = transformations_of(motions);
    d.motions = std::move(motions);
    d.now.resize(mesh_of(d).rest.size());
    const Refining refining = refining_for(d, document, rebound);
    if (refining.all) refine_all(d, document);
    if (refining.all || rebound) untile(d);
    tile(d);
    refine_runs(d, document, refining.runs, same_pose);
    if (!same_pose || refining.all) deform_all(d, document, dragged);
    d.moved = !std::all_of(document.probes.begin(), document.probes.end(), at_rest);
    d.source = document;
    ++d.version;
}

std::size_t refining_work(const Deformation& d, const Document& document) {
    assert(fits(d.binding.get(), document));
    if (d.source == document) return 0;
    const Refining refining = refining_for(d, document, false);
    const std::size_t probes = document.probes.size(), table = d.now.size() * probes;
    std::size_t work = 0;
    if (refining.all) work = !is_refined(document) ? table / 4 : document.stiffness ? 4 * table : table;
    if (!refining.runs.empty() && !d.refined) work = table / 2;  // is copied
    for (const VertexRun run : refining.runs) work += run.count * probes;
    return work;
}

std::optional<Document> in_pose_of(const Document& weighed, const Document& posed) {
    if (weighed.picture != posed.picture ||
        !std::ranges::equal(weighed.probes, posed.probes, {}, &Probe::id, &Probe::id))
        return {};
    Document document = weighed;
    document.blend = posed.blend;
    for (std::size_t i = 0; i < posed.probes.size(); ++i) {
        const PaintPtr paint = document.probes[i].paint;
        const bool locked = document.probes[i].locked;
        document.probes[i] = posed.probes[i];
        document.probes[i].paint = paint;
        document.probes[i].locked = locked;
    }
    return document;
}

void replace(Deformation& d, Deformation made) {
    const bool same_mesh = d.binding && made.binding && d.binding->mesh == made.binding->mesh;
    made.mesh_version = d.mesh_version + (same_mesh ? 0 : 1);
    made.version = d.version + 1;
    d = std::move(made);
}

void update(Deformation& deformation, const Document& document, Pace pace) {
    auto binding = deformation.binding;
    if (!is_bound(binding.get(), document)) binding = make_binding(document, binding);
    pose(deformation, document, std::move(binding), pace);
}

std::vector<glm::vec2> positions_by(const Deformation& deformation, const BlendMethod& blend) {
    std::vector<glm::vec2> positions = mesh_of(deformation).rest;
    if (deformation.motions.empty()) return positions;
    const bool tiled = deformation.quick.tiles.vertices > 0;  // a copy is not
    const WeightTiles own =
        tiled ? WeightTiles() : make_tiles(weights_of(deformation), deformation.motions.size());
    blend.deform(tiled ? deformation.quick.tiles : own, mesh_of(deformation).rest,
                 pose_of(deformation, deformation.source), {0, positions.size()}, positions);
    return positions;
}

std::vector<double> shares_at(const Deformation& deformation, const MeshPoint& at) {
    const std::size_t probes = deformation.source.probes.size();
    std::vector<double> shares(probes);
    for (int k = 0; k < 3; ++k) {
        const auto row = weights_of(deformation).subspan(at.corners[std::size_t(k)] * probes, probes);
        double total = 0;
        for (const float w : row) total += double(w);
        for (std::size_t i = 0; i < probes; ++i) shares[i] += at.barycentric[k] * double(row[i]) / total;
    }
    return shares;
}

std::optional<PicturePose> pose_at(const Deformation& deformation, glm::dvec2 point) {
    const Mesh& mesh = mesh_of(deformation);
    const auto at = locate(mesh, deformation.now, point);
    if (!at) return {};
    const Document& document = deformation.source;
    PicturePose pose{rest_point(mesh, *at), 0};
    if (document.probes.empty()) return pose;

    const std::vector<double> shares = shares_at(deformation, *at);
    double mean = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) mean += shares[i] * document.probes[i].angle;
    const auto blended = find_blend_method(document.blend)->blend(shares, deformation.motions);
    // The blend knows the half angle, or at least the angle, up to whole turns of it; the probes' mean angle
    // says which one is meant.
    const bool knows_half = blended.half != std::complex<double>(0);
    const double angle = knows_half ? 2 * std::arg(blended.half) : std::arg(1.0 + blended.less_one);
    const double turn = (knows_half ? 4 : 2) * std::numbers::pi;
    pose.angle = angle + turn * std::round((mean - angle) / turn);
    return pose;
}

}  // namespace probewarp
