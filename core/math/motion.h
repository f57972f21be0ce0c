// A rigid motion of the plane that remembers how many turns it made: what a probe does to the picture.
#pragma once

#include <cmath>
#include <complex>

#include "math/dual_complex.h"
#include "math/sinc.h"

namespace probewarp {

/// V(x) = (e^{ix} - 1) / (ix) = e^{ix/2} sinc(x/2): exp maps the algebra's (angle, l) to the motion
/// v -> e^{i angle} v + V(angle) l. Zero at whole turns other than none.
template <class T>
std::complex<T> left_jacobian(T x) {
    return sinc(x / T(2)) * std::polar(T(1), x / T(2));
}

/// e^{ix} - 1, exact near 0.
template <class T>
std::complex<T> turn_less_one(T x) {
    return std::complex<T>(T(0), T(2) * std::sin(x / T(2))) * std::polar(T(1), x / T(2));
}

/// v -> e^{i angle} (v - rest) + now, that is v + less_one v + shift. The angle is unwrapped, in radians.
template <class T>
struct Motion {
    T angle{};
    std::complex<T> rest, now;
    // What the blends want of it, worked out once.
    DualComplex<T> p;          ///< as turned: p0 = e^{i angle/2}
    std::complex<T> less_one;  ///< e^{i angle} - 1; exactly 0 without a turn
    std::complex<T> shift;     ///< exactly 0 where nothing moves

    friend bool operator==(const Motion&, const Motion&) = default;
};

template <class T>
Motion<T> motion(T angle, std::complex<T> rest, std::complex<T> now) {
    const std::complex<T> less_one = turn_less_one(angle);
    return {angle,    rest,
            now,      translation(now - rest) * rotation(angle, rest),
            less_one, (now - rest) - less_one * rest};
}

/// a v + b as v + less_one v + shift: what a blend makes of the plane. Rigid where |1 + less_one| = 1.
template <class T>
struct Similarity {
    std::complex<T> less_one;  ///< a - 1
    std::complex<T> shift;     ///< b
    bool cancelled = false;    ///< the weights had no blend: this is the heaviest motion
    /// e^{i angle/2} times any length, as turned: it tells turns apart that differ by 2 pi, as less_one
    /// cannot. 0 for a blend that knows only the turn.
    std::complex<T> half{};
};

template <class T>
std::complex<T> act(const Similarity<T>& s, std::complex<T> v) {
    return v + (s.less_one * v + s.shift);
}

template <class T>
Similarity<T> similarity(const Motion<T>& m) {
    return {m.less_one, m.shift, false, m.p.p0};
}

/// Of a unit DCN: p0^2 v + 2 p0 p1, with p0^2 - 1 = 2i Im(p0) p0.
template <class T>
Similarity<T> similarity(const DualComplex<T>& p) {
    return {std::complex<T>(T(0), T(2) * p.p0.imag()) * p.p0, T(2) * (p.p0 * p.p1), false, p.p0};
}

}  // namespace probewarp
