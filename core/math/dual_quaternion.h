// Unit dual quaternions: the rigid transformations of space as eight real numbers.
// Source: Kavan, Collins, O'Sullivan, Zara, "Dual Quaternions for Rigid Transformation Blending"
// (TCD-CS-2006-46), here "Kavan".
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numbers>

#include "math/dual.h"
#include "math/dual_complex.h"
#include "math/sinc.h"
#include "math/transformation.h"

namespace probewarp {

template <class T>
using Quaternion = glm::qua<T>;

template <class T>
struct DualQuaternionLog;

/// q0 + qe e with quaternions q0, qe, where e e = 0 and e commutes (Kavan section 3).
/// A unit (|q| = 1, that is |q0| = 1 and <q0, qe> = 0) is a rigid transformation; q and -q are the same one.
template <class T>
struct DualQuaternion {
    using Scalar = T;
    using Point = glm::vec<3, T>;
    using Log = DualQuaternionLog<T>;

    Quaternion<T> q0{T(1), T(0), T(0), T(0)};
    Quaternion<T> qe{T(0), T(0), T(0), T(0)};

    friend bool operator==(const DualQuaternion&, const DualQuaternion&) = default;
};

template <class T>
glm::vec<3, T> vector_part(const Quaternion<T>& q) {
    return {q.x, q.y, q.z};
}

template <class T>
Quaternion<T> quaternion(T scalar, const glm::vec<3, T>& vector) {
    return {scalar, vector.x, vector.y, vector.z};
}

template <class T>
T inner(const Quaternion<T>& a, const Quaternion<T>& b) {
    return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
DualQuaternion<T> operator+(const DualQuaternion<T>& p, const DualQuaternion<T>& q) {
    return {p.q0 + q.q0, p.qe + q.qe};
}

template <class T>
DualQuaternion<T> operator-(const DualQuaternion<T>& p) {
    return {-p.q0, -p.qe};
}

template <class T>
DualQuaternion<T> operator*(T s, const DualQuaternion<T>& p) {
    return {p.q0 * s, p.qe * s};
}

/// A dual number commutes with a dual quaternion.
template <class T>
DualQuaternion<T> operator*(const Dual<T>& s, const DualQuaternion<T>& p) {
    return {p.q0 * s.real, p.qe * s.real + p.q0 * s.dual};
}

/// (p0 + pe e)(q0 + qe e) = p0 q0 + (p0 qe + pe q0) e: first q, then p.
template <class T>
DualQuaternion<T> operator*(const DualQuaternion<T>& p, const DualQuaternion<T>& q) {
    return {p.q0 * q.q0, p.q0 * q.qe + p.qe * q.q0};
}

/// ~q0 + ~qe e: the quaternions' conjugate.
template <class T>
DualQuaternion<T> conj(const DualQuaternion<T>& q) {
    return {glm::conjugate(q.q0), glm::conjugate(q.qe)};
}

/// q0 - qe e: the dual numbers' conjugate.
template <class T>
DualQuaternion<T> dual_conj(const DualQuaternion<T>& q) {
    return {q.q0, -q.qe};
}

/// |q| = sqrt(q ~q) = |q0| + <q0, qe> / |q0| e, a dual number. Requires q0 != 0.
template <class T>
Dual<T> norm(const DualQuaternion<T>& q) {
    return sqrt(Dual<T>{inner(q.q0, q.q0), T(2) * inner(q.q0, q.qe)});
}

/// <p0, q0>, the dot product of the parts that turn: below 0 where p and -q are nearer than p and q.
template <class T>
T rotation_dot(const DualQuaternion<T>& p, const DualQuaternion<T>& q) {
    return inner(p.q0, q.q0);
}

/// q / |q|. Requires q0 != 0.
template <class T>
DualQuaternion<T> normalised(const DualQuaternion<T>& q) {
    return inverse(norm(q)) * q;
}

/// The inverse of a unit: ~q.
template <class T>
DualQuaternion<T> inverse(const DualQuaternion<T>& q) {
    return conj(q);
}

/// The action of a unit on a point of space: the vector of q (1 + v e) ~(dual_conj q), that is
/// q0 v ~q0 + 2 qe ~q0, with the products by 0 left out.
template <class T>
glm::vec<3, T> act(const DualQuaternion<T>& q, const glm::vec<3, T>& v) {
    const auto a = vector_part(q.q0), b = vector_part(q.qe);
    const auto half = glm::cross(a, glm::cross(a, v) + v * q.q0.w + b) + b * q.q0.w - a * q.qe.w;
    return v + half + half;
}

/// The turn by `angle` radians about the axis through the origin (right-handed). Requires |axis| = 1. The
/// angle is unwrapped: t and t + 2 pi act alike but are q and -q, and blend differently.
template <class T>
DualQuaternion<T> rotation(T angle, const glm::vec<3, T>& axis) {
    return {quaternion(std::cos(angle / T(2)), axis * std::sin(angle / T(2))),
            quaternion(T(0), glm::vec<3, T>(T(0)))};
}

/// The shift by d: 1 + (d/2) e.
template <class T>
DualQuaternion<T> translation(const glm::vec<3, T>& d) {
    return {quaternion(T(1), glm::vec<3, T>(T(0))), quaternion(T(0), d * T(0.5))};
}

/// An element r + d e of the Lie algebra, both without a scalar part: r is the axis times half the angle.
template <class T>
struct DualQuaternionLog {
    glm::vec<3, T> r{T(0)};
    glm::vec<3, T> d{T(0)};

    friend bool operator==(const DualQuaternionLog&, const DualQuaternionLog&) = default;
};

template <class T>
DualQuaternionLog<T> operator+(const DualQuaternionLog<T>& x, const DualQuaternionLog<T>& y) {
    return {x.r + y.r, x.d + y.d};
}

template <class T>
DualQuaternionLog<T> operator*(T s, const DualQuaternionLog<T>& x) {
    return {x.r * s, x.d * s};
}

/// r, d: a basis of the algebra.
template <class T>
std::array<T, 6> coordinates(const DualQuaternionLog<T>& x) {
    return {x.r.x, x.r.y, x.r.z, x.d.x, x.d.y, x.d.z};
}

template <class T>
DualQuaternionLog<T> from_coordinates(const std::array<T, 6>& x) {
    return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
}

/// cos(|x|) + sinc(|x|) x with the dual norm |x| = h + (r . d)/h e (Kavan section 3.2), multiplied out so
/// that nothing is divided by h.
template <class T>
DualQuaternion<T> exp(const DualQuaternionLog<T>& x) {
    using std::cos, std::sqrt;
    const T h = sqrt(glm::dot(x.r, x.r)), along = glm::dot(x.r, x.d);
    return {quaternion(cos(h), x.r * sinc(h)),
            quaternion(-sinc(h) * along, x.d * sinc(h) + x.r * (sinc_slope(h) * along))};
}

/// The logarithm of the whole turn -1 + b e. About any line but one along the shift no whole turn shifts, so
/// that is the axis; without a shift every axis will do, and -i is what the plane's logarithm has.
template <class T>
DualQuaternionLog<T> log_of_whole_turn(const glm::vec<3, T>& b) {
    const T length = glm::length(b);
    const auto axis = length > T(0) ? b / length : glm::vec<3, T>(T(-1), T(0), T(0));
    return {axis * T(std::numbers::pi), axis * -length};
}

/// The inverse of exp for a unit, with |r| in [0, pi]; every unit has a logarithm. Near a whole turn (q0 near
/// -1) that also shifts across its axis, the axis is far away: d grows without bound as 1 / |vector of q0|,
/// and its rounding with it.
template <class T>
DualQuaternionLog<T> log(const DualQuaternion<T>& q) {
    using std::atan2, std::sqrt;
    const auto a = vector_part(q.q0), b = vector_part(q.qe);
    const T w = q.q0.w, s = sqrt(glm::dot(a, a));  // cos h, sin h
    if (w < T(0) && s <= std::numeric_limits<T>::epsilon()) return log_of_whole_turn(b);
    const T h = atan2(s, w);
    const T by_sinc = w < T(0) ? h / s : T(1) / sinc(h);  // near h = pi, s is exact and sin(h) is not
    // r . d: a . b = sinc(h) cos(h) (r . d) knows it where sin(h) is small, qe.w = -sinc(h) (r . d)
    // elsewhere.
    const T along = (w * glm::dot(a, b) - s * s * q.qe.w) * by_sinc;
    const auto r = a * by_sinc;
    return {r, (b - r * (sinc_slope(h) * along)) * by_sinc};
}

/// A rigid transformation of space as a screw motion: a turn about a line and a shift along it (Kavan section
/// 3.2, Chasles' theorem).
template <class T>
struct Screw {
    T angle{};                     ///< radians, in [0, 2 pi]
    T pitch{};                     ///< the shift along the axis
    glm::vec<3, T> axis{0, 0, 1};  ///< its direction, a unit vector
    glm::vec<3, T> moment{0};      ///< c x axis for any point c of the axis; at right angles to it
};

/// Of a unit: q and -q turn by angles that add up to 2 pi, about opposite axes. A pure shift turns by 0 about
/// the line through the origin along it; 1, which moves nothing, has the z axis.
template <class T>
Screw<T> screw(const DualQuaternion<T>& q) {
    const DualQuaternionLog<T> x = log(q);
    const T h = glm::length(x.r), shift = glm::length(x.d);
    if (h == T(0) && shift == T(0)) return {};
    if (h == T(0)) return {T(0), T(2) * shift, x.d / shift, glm::vec<3, T>(T(0))};
    const auto axis = x.r / h;
    const T along = glm::dot(x.d, axis);
    return {T(2) * h, T(2) * along, axis, (x.d - axis * along) / h};
}

/// exp of (angle/2 + pitch/2 e)(axis + moment e).
template <class T>
DualQuaternion<T> from_screw(const Screw<T>& s) {
    return exp(DualQuaternionLog<T>{s.axis * (s.angle / T(2)),
                                    s.axis * (s.pitch / T(2)) + s.moment * (s.angle / T(2))});
}

/// p0 + p1 e -> p0 + p1 j e (MKO section 4): the plane as the points (0, x, y) of space, spanned by j and k,
/// turning about i. A homomorphism that commutes with the action: act(embed(p), embed(v)) = embed(act(p, v)).
template <class T>
DualQuaternion<T> embed(const DualComplex<T>& p) {
    // (a + b i) j = a j + b k
    return {{p.p0.real(), p.p0.imag(), T(0), T(0)}, {T(0), T(0), p.p1.real(), p.p1.imag()}};
}

/// The point x + y i of the plane as (x + y i) j.
template <class T>
glm::vec<3, T> embed(const std::complex<T>& v) {
    return {T(0), v.real(), v.imag()};
}

}  // namespace probewarp
