// Deforming: every vertex is moved by the blend of the probes' motions. The table of the blends, and what the
// program's inner loop (deform_tiles.h) is held to.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <string_view>

#include "math/dual_complex.h"
#include "math/motion.h"
#include "model/weight_tiles.h"

namespace probewarp {

/// What the probes do, about `centre`.
struct Pose {
    std::span<const Motion<double>> motions;              ///< #probes
    std::span<const DualComplex<float>> transformations;  ///< #probes: the motions' DCNs, as turned
    glm::vec2 centre{0};                                  ///< image pixels
};

/// Moves a run of vertices and those of the blocks that it touches, and returns for how many of all these the
/// blend has no answer (those follow their heaviest probe; see each blend). Each comes out the same whatever
/// the run is. rest, now: #vertices of the mesh, image pixels; now may not be rest
using DeformFunction = std::size_t(const WeightTiles& tiles, std::span<const glm::vec2> rest,
                                   const Pose& pose, VertexRun run, std::span<glm::vec2> now);

struct BlendMethod {
    std::string_view name;   ///< what the command line and the project file call it
    std::string_view label;  ///< what the window calls it
    std::string_view when;   ///< one sentence: when to use it
    /// Whether it is DLB of the DCNs as they are: a dragged probe can be added to the others' sum, and the
    /// vertex shader can do it.
    bool summed;
    DeformFunction* deform;  ///< `blend` for every vertex, by vector units
    /// The blend at one place, in double: #probes weights and motions in, the map of the plane out.
    Similarity<double> (*blend)(std::span<const double> weights, std::span<const Motion<double>> motions);
};

/// The methods, the default first.
std::span<const BlendMethod> blend_methods();

/// The method of that name, or null.
const BlendMethod* find_blend_method(std::string_view name);

struct MovedVertex {
    glm::vec2 now{0};        ///< image pixels
    bool cancelled = false;  ///< the blend has no answer: the heaviest probe was followed
};

/// One vertex by DLB, as deform_dlb. weights: #probes, `stride` floats apart
MovedVertex dlb_vertex(const float* weights, std::size_t stride, const Pose& pose, glm::vec2 rest);

/// DLB of all vertices without a square root: with s = sum w_i p_i the vertex moves by 2 s0 (i Im(s0) v + s1)
/// / |s0|^2, which is (s0^2 v + 2 s0 s1) / |s0|^2 - v, written so that it is exactly 0 where no probe moved.
/// No answer where |s0| is below cancelled_share of the weights' sum. The plain function, which the quick one
/// in deform_tiles.h is held to. Without probes nothing moves. rest, now: #vertices, image pixels; now may be
/// rest
/// weights: #vertices x #probes, row-major, defined up to a factor per vertex, >= 0, not all zero
std::size_t deform_dlb(std::span<const glm::vec2> rest, std::span<const float> weights, const Pose& pose,
                       std::span<glm::vec2> now);

}  // namespace probewarp
