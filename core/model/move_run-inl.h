// Included once for each instruction set, by the files that move vertices with vector units.
#if defined(PROBEWARP_MOVE_RUN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PROBEWARP_MOVE_RUN_INL
#undef PROBEWARP_MOVE_RUN_INL
#else
#define PROBEWARP_MOVE_RUN_INL
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "model/weight_tiles.h"

HWY_BEFORE_NAMESPACE();
namespace probewarp {
namespace HWY_NAMESPACE {
namespace {

/// Moves a run of vertices by move(v, rest, now), which moves `step` of them, the first of them `v`, and
/// returns how many are cancelled; its rest and now begin at `v`. The run begins at a whole block; step
/// divides the blocks. rest, now: #vertices of the mesh
template <class Move>
HWY_INLINE std::size_t MoveRun(VertexRun run, std::size_t step, const glm::vec2* rest, glm::vec2* now,
                               const Move& move) {
    const std::size_t end = run.first + run.count;
    std::size_t cancelled = 0, v = run.first;
    for (; v + step <= end; v += step) cancelled += move(v, rest + v, now + v);
    if (v == end) return cancelled;
    glm::vec2 last[tile_block] = {}, moved[tile_block];
    std::copy(rest + v, rest + end, last);
    cancelled += move(v, last, moved);
    std::copy(moved, moved + (end - v), now + v);
    return cancelled;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace probewarp
HWY_AFTER_NAMESPACE();

#endif
