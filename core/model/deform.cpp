#include "model/deform.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "math/planar_blend.h"
#include "model/blend_tiles.h"
#include "model/deform_tiles.h"

namespace probewarp {

namespace {

/// 2 s0 (i Im(s0) v + s1) / |s0|^2.
glm::vec2 displacement(float a, float b, float c, float d, glm::vec2 v) {
    const float x = c - b * v.y, y = d + b * v.x;
    const float scale = 2.0f / (a * a + b * b);
    return {scale * (a * x - b * y), scale * (a * y + b * x)};
}

/// The place of the largest |w_i|, the first of equals.
std::size_t heaviest_of(const float* weights, std::size_t stride, std::size_t probes) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < probes; ++i)
        if (std::abs(weights[i * stride]) > std::abs(weights[best * stride])) best = i;
    return best;
}

}  // namespace

MovedVertex dlb_vertex(const float* weights, std::size_t stride, const Pose& pose, glm::vec2 rest) {
    float a = 0, b = 0, c = 0, d = 0, total = 0;
    const float* w = weights;
    for (const auto& p : pose.transformations) {
        a += *w * p.p0.real();
        b += *w * p.p0.imag();
        c += *w * p.p1.real();
        d += *w * p.p1.imag();
        total += std::abs(*w);
        w += stride;
    }
    const float least = cancelled_share<float> * total;
    // The last is for weights so small that a float does not hold their squares.
    const bool cancelled = !(a * a + b * b >= std::max(least * least, std::numeric_limits<float>::min()));
    if (cancelled) {
        const auto& p = pose.transformations[heaviest_of(weights, stride, pose.transformations.size())];
        a = p.p0.real(), b = p.p0.imag(), c = p.p1.real(), d = p.p1.imag();
    }
    return {rest + displacement(a, b, c, d, rest - pose.centre), cancelled};
}

std::size_t deform_dlb(std::span<const glm::vec2> rest, std::span<const float> weights, const Pose& pose,
                       std::span<glm::vec2> now) {
    const std::size_t probes = pose.transformations.size();
    assert(now.size() == rest.size() && weights.size() == rest.size() * probes);
    if (probes == 0) {
        std::copy(rest.begin(), rest.end(), now.begin());
        return 0;
    }
    std::size_t cancelled = 0;
    for (std::size_t v = 0; v < rest.size(); ++v) {
        const MovedVertex moved = dlb_vertex(weights.data() + v * probes, 1, pose, rest[v]);
        now[v] = moved.now;
        cancelled += moved.cancelled;
    }
    return cancelled;
}

std::span<const BlendMethod> blend_methods() {
    static constexpr std::array<BlendMethod, 8> methods{{
        {"dlb", "DLB, as turned",
         "The usual choice: quick, rigid, and each probe turns the picture the way it was turned itself.",
         true, &deform_dlb, &planar_dlb},
        {"dlb-shortest", "DLB, shortest way",
         "When only matters where a probe points, not how it got there: turns go the short way round.", false,
         &deform_dlb_shortest, &planar_dlb_shortest},
        {"dib", "DIB, the exact mean",
         "When a turn is to spread evenly between probes: the exact mean of their motions; not for whole "
         "turns.",
         false, &deform_dib, &planar_dib},
        {"log-linear", "Logarithm at the centre",
         "When the picture is to swirl about its own centre; probes' whole turns are beyond it.", false,
         &deform_log_linear, &planar_log_linear},
        {"spiral", "Spiral", "For twirls: any number of turns, spread evenly with the weights.", false,
         &deform_spiral, &spiral},
        {"linear", "Linear",
         "To match programs that blend matrices: what lies between probes turned apart shrinks.", false,
         &deform_linear, &planar_linear},
        {"mls-rigid", "Moving least squares, rigid",
         "When probes are dragged, not turned: how they moved to each other turns the picture.", false,
         &deform_mls_rigid, &mls_rigid},
        {"mls-similarity", "Moving least squares, similar",
         "The same, and what probes are pulled apart from each other grows.", false, &deform_mls_similarity,
         &mls_similarity},
    }};
    return methods;
}

const BlendMethod* find_blend_method(std::string_view name) {
    const auto methods = blend_methods();
    const auto found =
        std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.name == name; });
    return found == methods.end() ? nullptr : &*found;
}

}  // namespace probewarp
