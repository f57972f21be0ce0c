#include "model/deform.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "math/blend.h"

namespace probewarp {

namespace {

/// 2 s0 (i Im(s0) v + s1) / |s0|^2.
glm::vec2 displacement(float a, float b, float c, float d, glm::vec2 v) {
    const float x = c - b * v.y, y = d + b * v.x;
    const float scale = 2.0f / (a * a + b * b);
    return {scale * (a * x - b * y), scale * (a * y + b * x)};
}

}  // namespace

std::size_t deform_dlb(std::span<const glm::vec2> rest, std::span<const float> weights,
                       std::span<const DualComplex<float>> transformations, glm::vec2 centre,
                       std::span<glm::vec2> now) {
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
        now[v] = rest[v] + displacement(a, b, c, d, rest[v] - centre);
    }
    return cancelled;
}

std::span<const BlendMethod> blend_methods() {
    static constexpr std::array<BlendMethod, 1> methods{
        {{"dlb", "DLB: keeps shapes rigid", &deform_dlb,
          [](auto weights, auto p) { return dlb(weights, p).p; }}}};
    return methods;
}

const BlendMethod* find_blend_method(std::string_view name) {
    const auto methods = blend_methods();
    const auto found =
        std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.name == name; });
    return found == methods.end() ? nullptr : &*found;
}

}  // namespace probewarp
