#include "model/refine.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <deque>

#include "model/over_blocks.h"
#include "model/sum_of.h"

namespace probewarp {

bool is_limited(const Document& document) {
    const std::size_t most = std::size_t(document.weights.most);
    return most > 0 && most < document.probes.size();
}

bool is_refined(const Document& document) {
    return document.stiffness || is_limited(document) || is_painted(document);
}

namespace {

/// Adds the vertices of the grid within a rectangle of the picture, row by row.
void add_runs(const Mesh& mesh, glm::dvec2 least, glm::dvec2 most, std::vector<VertexRun>& runs) {
    const glm::dvec2 cell{mesh.size.x / mesh.columns, mesh.size.y / mesh.rows};
    const auto place = [](double x, int last) { return std::size_t(std::clamp(x, 0.0, double(last))); };
    const std::size_t left = place(std::floor(least.x / cell.x), mesh.columns),
                      right = place(std::ceil(most.x / cell.x), mesh.columns),
                      top = place(std::floor(least.y / cell.y), mesh.rows),
                      bottom = place(std::ceil(most.y / cell.y), mesh.rows);
    for (std::size_t y = top; y <= bottom; ++y) {
        const auto* row = mesh.grid.data() + y * (std::size_t(mesh.columns) + 1);
        VertexRun run;
        // The grid's vertices are numbered along the row, so those that are there follow each other.
        for (std::size_t x = left; x <= right; ++x) {
            if (row[x] == no_vertex) continue;
            if (run.count++ == 0) run.first = row[x];
        }
        if (run.count > 0) runs.push_back(run);
    }
}

/// Adds the vertices under the tiles that two maps (either may be null) do not share.
void add_differences(const PaintMap* before, const PaintMap* after, const PictureFrame& frame,
                     const Mesh& mesh, std::vector<VertexRun>& runs) {
    const PaintMap& map = after ? *after : *before;
    const std::size_t across = std::size_t(tiles_along(map.width));
    for (std::size_t i = 0; i < map.tiles.size(); ++i) {
        if ((before ? before->tiles[i] : nullptr) == (after ? after->tiles[i] : nullptr)) continue;
        const glm::dvec2 corner = double(paint_tile_side) * glm::dvec2(i % across, i / across);
        // Sampling reaches half a texel beyond the tile.
        add_runs(mesh, to_picture(map, frame, corner - 1.0),
                 to_picture(map, frame, corner + double(paint_tile_side + 1)), runs);
    }
}

void merge(std::vector<VertexRun>& runs) {
    std::sort(runs.begin(), runs.end(),
              [](const VertexRun& a, const VertexRun& b) { return a.first < b.first; });
    std::size_t last = 0;
    for (std::size_t i = 1; i < runs.size(); ++i) {
        VertexRun& run = runs[last];
        if (runs[i].first <= run.first + run.count)
            run.count = std::max(run.count, runs[i].first + runs[i].count - run.first);
        else
            runs[++last] = runs[i];
    }
    if (!runs.empty()) runs.resize(last + 1);
}

}  // namespace

std::vector<VertexRun> repainted(const Document& before, const Document& after, const Mesh& mesh) {
    assert(before.probes.size() == after.probes.size());
    const PictureFrame frame = frame_of(after.picture->image);
    std::vector<VertexRun> runs;
    for (std::size_t i = 0; i < after.probes.size(); ++i) {
        const PaintMap *from = before.probes[i].paint.get(), *to = after.probes[i].paint.get();
        if (from == to) continue;
        if (from && to && !same_texels(*from, *to)) return {{0, mesh.rest.size()}};
        add_differences(from, to, frame, mesh, runs);
    }
    if (runs.empty()) return runs;
    // The probes' own vertices are few, and come after the grid's.
    const auto grid = std::size_t(
        std::count_if(mesh.grid.begin(), mesh.grid.end(), [](std::uint32_t v) { return v != no_vertex; }));
    if (grid < mesh.rest.size()) runs.push_back({grid, mesh.rest.size() - grid});
    merge(runs);
    return runs;
}

std::vector<std::uint32_t> anchored_vertices(const Mesh& mesh) {
    std::vector<std::uint32_t> anchored = mesh.anchors;
    std::erase(anchored, no_vertex);
    std::sort(anchored.begin(), anchored.end());
    return anchored;
}

void open_anchor(const Binding& binding, std::span<const std::uint32_t> anchored, std::size_t vertex,
                 float covered, std::span<float> row) {
    // The cell's corners are all of its vertices that may be nobody's own.
    std::array<std::uint32_t, 4> corners{};
    std::size_t count = 0;
    for (const std::uint32_t v : grid_corners(*binding.mesh, binding.mesh->rest[vertex]))
        if (v != no_vertex && !std::ranges::binary_search(anchored, v)) corners[count++] = v;
    const float own = (count > 0 ? 1 - covered : 1) / float(sum_of(row));
    for (float& w : row) w *= own;
    for (std::size_t k = 0; k < count; ++k) {
        const auto corner = std::span(binding.automatic).subspan(corners[k] * row.size(), row.size());
        const float total = float(sum_of(corner)) * float(count);
        for (std::size_t i = 0; i < row.size(); ++i) row[i] += covered * corner[i] / total;
    }
}

namespace {

/// What settling vertices needs of a document.
struct Settling {
    const Document& document;
    const Binding& binding;
    PictureFrame frame;
    std::vector<std::uint8_t> locked;     ///< #probes
    std::vector<std::uint32_t> anchored;  ///< as anchored_vertices gives them
};

/// weights: run.count x #probes
void settle_painted(const Settling& settling, VertexRun run, std::span<float> weights) {
    const std::span<const Probe> probes = settling.document.probes;
    std::vector<Paint> paint(probes.size());
    for (std::size_t k = 0; k < run.count; ++k) {
        const auto vertex = std::uint32_t(run.first + k);
        const glm::dvec2 place = settling.binding.mesh->rest[vertex];
        float covered = 0;
        for (std::size_t i = 0; i < probes.size(); ++i) {
            const PaintMap* map = probes[i].paint.get();
            paint[i] = map ? sample(*map, to_texels(*map, settling.frame, place)) : Paint{};
            covered = std::max(covered, paint[i].coverage);
        }
        if (covered == 0) continue;  // where nothing is painted the weights stay as they are
        const auto row = weights.subspan(k * probes.size(), probes.size());
        if (std::ranges::binary_search(settling.anchored, vertex))
            open_anchor(settling.binding, settling.anchored, vertex, covered, row);
        settle(row, paint, settling.locked, row);
    }
}

}  // namespace

void settle_run(const Document& document, const Binding& binding, VertexRun run, std::span<float> weights) {
    const std::size_t probes = document.probes.size();
    assert(weights.size() == run.count * probes);
    if (probes == 0) return;
    Settling settling{
        document, binding, frame_of(document.picture->image), {}, anchored_vertices(*binding.mesh)};
    for (const Probe& probe : document.probes) settling.locked.push_back(probe.locked);
    const bool painted = is_painted(document), limited = is_limited(document) && !document.stiffness;
    using Range = oneapi::tbb::blocked_range<std::size_t>;
    constexpr std::size_t as_many_as = 8;  // a weight is about as much work as that many of a deformation
    const std::size_t grain = least_weights / (probes * as_many_as) + 1;
    oneapi::tbb::parallel_for(Range(0, run.count, grain), [&](const Range& range) {
        const VertexRun part{run.first + range.begin(), range.size()};
        const auto automatic = std::span(binding.automatic).subspan(part.first * probes, part.count * probes);
        const auto rows = weights.subspan(range.begin() * probes, part.count * probes);
        std::copy(automatic.begin(), automatic.end(), rows.begin());
        if (painted) settle_painted(settling, part, rows);
        if (limited) keep_heaviest(std::size_t(document.weights.most), probes, rows);
    });
}

std::vector<float> stiffness_at(const PaintMap& paint, const PictureFrame& frame,
                                std::span<const glm::vec2> vertices) {
    std::vector<float> stiffness(vertices.size());
    constexpr std::size_t as_many_as = 16;  // a look at the paint is about as much work as that many weights
    over_blocks({0, vertices.size()}, vertices.size(), as_many_as, [&](VertexRun run) {
        for (std::size_t v = run.first; v < run.first + run.count; ++v) {
            const Paint at = sample(paint, to_texels(paint, frame, glm::dvec2(vertices[v])));
            stiffness[v] = at.value * at.coverage;
        }
        return std::size_t{0};
    });
    return stiffness;
}

namespace {

/// The vertices beside each vertex, one list after the other.
struct Neighbours {
    std::vector<std::size_t> first;  ///< #vertices + 1
    std::vector<std::uint32_t> all;

    explicit Neighbours(const Mesh& mesh) : first(mesh.rest.size() + 1), all(mesh.triangles.size() * 2) {
        for (const std::uint32_t v : mesh.triangles) first[v + 1] += 2;
        for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
        std::vector<std::size_t> next(first.begin(), first.end() - 1);
        for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
            for (std::size_t k = 0; k < 3; ++k)
                for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3})
                    all[next[mesh.triangles[i + k]]++] = mesh.triangles[i + other];
    }
    std::span<const std::uint32_t> of(std::size_t v) const {
        return std::span(all).subspan(first[v], first[v + 1] - first[v]);
    }
};

/// The region of each stiff vertex, from 0, and -1 for the others; returns how many there are. Grown from
/// where the stiffness is at least `core` first, so that two stiff regions that touch softly stay two.
int stiff_regions(const Neighbours& neighbours, std::span<const float> stiffness, std::vector<int>& region) {
    int regions = 0;
    region.assign(stiffness.size(), -1);
    std::deque<std::uint32_t> edge;
    const auto grow = [&](float least, std::deque<std::uint32_t>& front, std::deque<std::uint32_t>* beyond) {
        while (!front.empty()) {
            const std::uint32_t v = front.front();
            front.pop_front();
            if (beyond) beyond->push_back(v);
            for (const std::uint32_t other : neighbours.of(v))
                if (region[other] < 0 && stiffness[other] > 0 && stiffness[other] >= least) {
                    region[other] = region[v];
                    front.push_back(other);
                }
        }
    };
    for (const float least : {0.5f, 0.0f}) {
        for (std::uint32_t v = 0; v < stiffness.size(); ++v) {
            if (region[v] >= 0 || stiffness[v] <= 0 || stiffness[v] < least) continue;
            region[v] = regions++;
            std::deque<std::uint32_t> front{v};
            grow(least, front, least > 0 ? &edge : nullptr);
        }
        if (least > 0) grow(0, edge, nullptr);  // the soft rims join before what is soft alone
    }
    return regions;
}

}  // namespace

void stiffen(const Mesh& mesh, std::span<const float> stiffness, std::size_t probes,
             std::span<float> weights) {
    assert(stiffness.size() == mesh.rest.size() && weights.size() == stiffness.size() * probes);
    std::vector<int> region;
    const int regions = stiff_regions(Neighbours(mesh), stiffness, region);
    if (regions == 0) return;
    std::vector<double> mean(std::size_t(regions) * probes), mass(std::size_t(regions), 0.0);
    for (std::size_t v = 0; v < region.size(); ++v) {
        if (region[v] < 0) continue;
        const auto row = weights.subspan(v * probes, probes);
        const double part = double(stiffness[v]) / sum_of(row);
        const std::size_t r = std::size_t(region[v]);
        for (std::size_t i = 0; i < probes; ++i) mean[r * probes + i] += part * double(row[i]);
        mass[r] += double(stiffness[v]);
    }
    for (std::size_t v = 0; v < region.size(); ++v) {
        if (region[v] < 0) continue;
        const auto row = weights.subspan(v * probes, probes);
        const double s = double(stiffness[v]), own = (1 - s) / sum_of(row);
        const std::size_t r = std::size_t(region[v]);
        for (std::size_t i = 0; i < probes; ++i)
            row[i] = float(own * double(row[i]) + s * mean[r * probes + i] / mass[r]);
    }
}

std::vector<float> refined_weights(const Document& document, const Binding& binding) {
    const std::size_t probes = document.probes.size();
    const VertexRun all{0, binding.mesh->rest.size()};
    std::vector<float> weights(all.count * probes);
    settle_run(document, binding, all, weights);
    if (document.stiffness) {
        const auto stiffness =
            stiffness_at(*document.stiffness, frame_of(document.picture->image), binding.mesh->rest);
        stiffen(*binding.mesh, stiffness, probes, weights);
        if (is_limited(document)) keep_heaviest(std::size_t(document.weights.most), probes, weights);
    }
    return weights;
}

}  // namespace probewarp
