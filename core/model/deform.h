// Deforming: every vertex is moved by the blend of the probes' transformations. The program's inner loop.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <string_view>

#include "math/dual_complex.h"

namespace probewarp {

/// Moves every vertex and returns how many had weights that cancel (those follow their heaviest probe).
/// Nothing is allocated. Without probes nothing moves.
/// rest, now:      #vertices, image pixels; now may be rest
/// weights:        #vertices x #probes, row-major, defined up to a factor per vertex, not all zero
/// transformations: #probes unit DCNs about `centre` (image pixels)
using DeformFunction = std::size_t (*)(std::span<const glm::vec2> rest, std::span<const float> weights,
                                       std::span<const DualComplex<float>> transformations, glm::vec2 centre,
                                       std::span<glm::vec2> now);

struct BlendMethod {
    std::string_view name;   ///< what the command line and the project file call it
    std::string_view label;  ///< what the window calls it
    DeformFunction deform;
    /// The blend itself at one place, in double: #probes weights and DCNs in, a unit DCN out.
    DualComplex<double> (*blend)(std::span<const double> weights, std::span<const DualComplex<double>> p);
};

/// The methods, the default first.
std::span<const BlendMethod> blend_methods();

/// The method of that name, or null.
const BlendMethod* find_blend_method(std::string_view name);

/// Deforms by DLB without a square root: with s = sum w_i p_i the vertex moves by 2 s0 (i Im(s0) v + s1) /
/// |s0|^2, which is (s0^2 v + 2 s0 s1) / |s0|^2 - v, written so that it is exactly 0 where no probe moved.
std::size_t deform_dlb(std::span<const glm::vec2> rest, std::span<const float> weights,
                       std::span<const DualComplex<float>> transformations, glm::vec2 centre,
                       std::span<glm::vec2> now);

}  // namespace probewarp
