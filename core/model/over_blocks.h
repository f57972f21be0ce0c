// Work on a mesh's vertices, shared between threads where there is enough of it.
#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <functional>

#include "model/weight_tiles.h"

namespace probewarp {

/// What one thread takes at least: to wake another costs about as long as this many weights do.
inline constexpr std::size_t least_weights = std::size_t{1} << 15;

/// Adds up what `part` returns for parts of the run, which it is widened to whole blocks of (but for the
/// mesh's end). The parts may come from several threads and in any order. probes: the work a vertex is
template <class Part>
std::size_t over_blocks(VertexRun run, std::size_t vertices, std::size_t probes, Part part) {
    assert(run.first + run.count <= vertices);
    if (run.count == 0) return 0;
    const std::size_t first = run.first / tile_block;
    const std::size_t end = (run.first + run.count + tile_block - 1) / tile_block;
    const auto of_blocks = [&](std::size_t from, std::size_t to) {
        const std::size_t begin = from * tile_block;
        return part(VertexRun{begin, std::min(to * tile_block, vertices) - begin});
    };
    const std::size_t grain = std::max<std::size_t>(1, least_weights / (tile_block * probes));
    if (end - first < 2 * grain || oneapi::tbb::this_task_arena::max_concurrency() == 1)
        return of_blocks(first, end);
    using Range = oneapi::tbb::blocked_range<std::size_t>;
    return oneapi::tbb::parallel_reduce(
        Range(first, end, grain), std::size_t{0},
        [&](const Range& range, std::size_t sum) { return sum + of_blocks(range.begin(), range.end()); },
        std::plus<>());
}

}  // namespace probewarp
