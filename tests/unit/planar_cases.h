// What the tests of the plane's blends share: every method under its name, random probes, and how far two
// maps are apart.
#pragma once

#include "generators.h"
#include "math/planar_blend.h"

namespace probewarp::testing {

/// Weights of type W, motions over T.
template <class W, class T>
struct PlanarKind {
    using Weight = W;
    using Scalar = T;
};
using PlanarKinds =
    ::testing::Types<PlanarKind<double, double>, PlanarKind<float, double>, PlanarKind<float, float>>;

template <class K>
struct PlanarCase {
    using Weight = typename K::Weight;
    using Scalar = typename K::Scalar;
    std::vector<Weight> weights;
    std::vector<Motion<Scalar>> motions;
};

template <class K>
struct PlanarMethod {
    using W = typename K::Weight;
    using T = typename K::Scalar;
    const char* name;
    Similarity<T> (*blend)(std::span<const W>, std::span<const Motion<T>>);
    bool knows_turns = true;  ///< looks at the probes' own turns, not only at where they are

    Similarity<T> operator()(const PlanarCase<K>& c) const { return blend(c.weights, c.motions); }
};

/// Blends with no preferred frame: turning every motion on either side turns the blend.
template <class K, class W = typename K::Weight, class T = typename K::Scalar>
std::vector<PlanarMethod<K>> equivariant_methods() {
    return {{"dlb", &planar_dlb<W, T>},
            {"dlb_shortest", &planar_dlb_shortest<W, T>},
            {"dib", &planar_dib<W, T>},
            {"spiral", &spiral<W, T>},
            {"linear", &planar_linear<W, T>}};
}

template <class K, class W = typename K::Weight, class T = typename K::Scalar>
std::vector<PlanarMethod<K>> mls_methods() {
    return {{"mls_similarity", &mls_similarity<W, T>, false}, {"mls_rigid", &mls_rigid<W, T>, false}};
}

template <class K, class W = typename K::Weight, class T = typename K::Scalar>
PlanarMethod<K> log_linear_method() {
    return {"log_linear", &planar_log_linear<W, T>};
}

template <class K>
std::vector<PlanarMethod<K>> all_methods() {
    auto methods = equivariant_methods<K>();
    methods.push_back(log_linear_method<K>());
    for (const auto& m : mls_methods<K>()) methods.push_back(m);
    return methods;
}

/// 1 to 6 probes within `size`, their turns within `spread` of one another's middle, which is within
/// `middle`.
template <class K>
PlanarCase<K> close_probes(double size, double middle = 1, double spread = 0.6) {
    using T = typename K::Scalar;
    PlanarCase<K> c;
    const double turn = *real(-middle, middle);
    const int count = *whole(1, 6);
    for (int i = 0; i < count; ++i) {
        c.weights.push_back(typename K::Weight(*real(0.01, 1)));
        c.motions.push_back(motion(T(turn + *real(-spread, spread)), *point<T>(size), *point<T>(size)));
    }
    return c;
}

/// The farthest apart that two maps carry a point within `size`.
template <class T>
T difference(const Similarity<T>& a, const Similarity<T>& b, double size) {
    return std::abs(a.less_one - b.less_one) * T(size) + std::abs(a.shift - b.shift);
}

/// First b, then a.
template <class T>
Similarity<T> after(const Similarity<T>& a, const Similarity<T>& b) {
    return {a.less_one + b.less_one + a.less_one * b.less_one, b.shift + a.less_one * b.shift + a.shift};
}

template <class T>
Similarity<T> undone(const Similarity<T>& a) {
    const std::complex<T> turn = T(1) + a.less_one;
    return {T(1) / turn - T(1), -a.shift / turn};
}

/// The motion of `first`, then g: its place moves, and its turn is g's more.
template <class T>
Motion<T> then(const Motion<T>& g, const Motion<T>& first) {
    return motion(g.angle + first.angle, first.rest, act(similarity(g), first.now));
}

/// The motion as a map of the plane that g moved at rest: `m` after g undone.
template <class T>
Motion<T> at_rest_moved(const Motion<T>& m, const Motion<T>& g) {
    return motion(m.angle - g.angle, act(similarity(g), m.rest), m.now);
}

}  // namespace probewarp::testing
