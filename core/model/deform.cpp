#include "model/deform.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "math/planar_blend.h"

namespace probewarp {

namespace {

/// 2 s0 (i Im(s0) v + s1) / |s0|^2.
glm::vec2 displacement(float a, float b, float c, float d, glm::vec2 v) {
    const float x = c - b * v.y, y = d + b * v.x;
    const float scale = 2.0f / (a * a + b * b);
    return {scale * (a * x - b * y), scale * (a * y + b * x)};
}

/// Deforms by any blend, vertex by vertex, in double.
template <Similarity<double> (*blend)(std::span<const float>, std::span<const Motion<double>>)>
std::size_t deform_by(std::span<const glm::vec2> rest, std::span<const float> weights, const Pose& pose,
                      std::span<glm::vec2> now) {
    const std::size_t probes = pose.motions.size();
    assert(now.size() == rest.size() && weights.size() == rest.size() * probes);
    if (probes == 0) {
        std::copy(rest.begin(), rest.end(), now.begin());
        return 0;
    }
    std::size_t cancelled = 0;
    for (std::size_t v = 0; v < rest.size(); ++v) {
        const Similarity<double> map = blend(weights.subspan(v * probes, probes), pose.motions);
        const auto place = to_complex(glm::dvec2(rest[v] - pose.centre));
        now[v] = rest[v] + glm::vec2(to_vec(map.less_one * place + map.shift));
        cancelled += map.cancelled;
    }
    return cancelled;
}

}  // namespace

std::size_t deform_dlb(std::span<const glm::vec2> rest, std::span<const float> weights, const Pose& pose,
                       std::span<glm::vec2> now) {
    const std::span transformations = pose.transformations;
    const std::size_t probes = transformations.size();
    assert(now.size() == rest.size() && weights.size() == rest.size() * probes);
    if (probes == 0) {
        std::copy(rest.begin(), rest.end(), now.begin());
        return 0;
    }
    std::size_t cancelled = 0;
    for (std::size_t v = 0; v < rest.size(); ++v) {
        const float* w = weights.data() + v * probes;
        float a = 0, b = 0, c = 0, d = 0, total = 0;
        for (std::size_t i = 0; i < probes; ++i) {
            const auto& p = transformations[i];
            a += w[i] * p.p0.real();
            b += w[i] * p.p0.imag();
            c += w[i] * p.p1.real();
            d += w[i] * p.p1.imag();
            total += std::abs(w[i]);
        }
        const float least = cancelled_share<float> * total;
        if (!(a * a + b * b >= least * least)) {
            const auto& p = transformations[heaviest(std::span(w, probes))];
            a = p.p0.real(), b = p.p0.imag(), c = p.p1.real(), d = p.p1.imag();
            ++cancelled;
        }
        now[v] = rest[v] + displacement(a, b, c, d, rest[v] - pose.centre);
    }
    return cancelled;
}

std::span<const BlendMethod> blend_methods() {
    static constexpr std::array<BlendMethod, 8> methods{{
        {"dlb", "DLB, as turned",
         "The usual choice: quick, rigid, and each probe turns the picture the way it was turned itself.",
         &deform_dlb, &planar_dlb},
        {"dlb-shortest", "DLB, shortest way",
         "When only matters where a probe points, not how it got there: turns go the short way round.",
         &deform_by<planar_dlb_shortest>, &planar_dlb_shortest},
        {"dib", "DIB, the exact mean",
         "When a turn is to spread evenly between probes: the exact mean of their motions; not for whole "
         "turns.",
         &deform_by<planar_dib>, &planar_dib},
        {"log-linear", "Logarithm at the centre",
         "When the picture is to swirl about its own centre; probes' whole turns are beyond it.",
         &deform_by<planar_log_linear>, &planar_log_linear},
        {"spiral", "Spiral", "For twirls: any number of turns, spread evenly with the weights.",
         &deform_by<spiral>, &spiral},
        {"linear", "Linear",
         "To match programs that blend matrices: what lies between probes turned apart shrinks.",
         &deform_by<planar_linear>, &planar_linear},
        {"mls-rigid", "Moving least squares, rigid",
         "When probes are dragged, not turned: how they moved to each other turns the picture.",
         &deform_by<mls_rigid>, &mls_rigid},
        {"mls-similarity", "Moving least squares, similar",
         "The same, and what probes are pulled apart from each other grows.", &deform_by<mls_similarity>,
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
