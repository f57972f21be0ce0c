// Anti-commutative dual complex numbers (DCN): the rigid transformations of the plane as four real numbers.
// Source of every formula: Matsuda, Kaji, Ochiai, "Anti-commutative Dual Complex Numbers and 2D Rigid
// Transformation" (arXiv 1601.01754), here "MKO"; numbers in brackets are its sections and equations.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <glm/vec2.hpp>
#include <numbers>

#include "math/sinc.h"
#include "math/transformation.h"

namespace probewarp {

template <class T>
struct DualComplexLog;

/// p0 + p1 e with complex p0, p1, where e e = 0 and e z = ~z e (MKO section 3).
/// A unit DCN (|p0| = 1) is a rigid transformation; p and -p are the same one.
template <class T>
struct DualComplex {
    using Scalar = T;
    using Point = std::complex<T>;
    using Log = DualComplexLog<T>;

    std::complex<T> p0{T(1)};
    std::complex<T> p1{T(0)};

    friend constexpr bool operator==(const DualComplex&, const DualComplex&) = default;
};

template <class T>
DualComplex<T> operator+(const DualComplex<T>& p, const DualComplex<T>& q) {
    return {p.p0 + q.p0, p.p1 + q.p1};
}

template <class T>
DualComplex<T> operator-(const DualComplex<T>& p) {
    return {-p.p0, -p.p1};
}

template <class T>
DualComplex<T> operator*(T s, const DualComplex<T>& p) {
    return {s * p.p0, s * p.p1};
}

/// (p0 + p1 e)(q0 + q1 e) = p0 q0 + (p1 ~q0 + p0 q1) e: first q, then p (MKO 3.1).
template <class T>
DualComplex<T> operator*(const DualComplex<T>& p, const DualComplex<T>& q) {
    return {p.p0 * q.p0, p.p1 * std::conj(q.p0) + p.p0 * q.p1};
}

/// ~(p0 + p1 e) = ~p0 + p1 e.
template <class T>
DualComplex<T> conj(const DualComplex<T>& p) {
    return {std::conj(p.p0), p.p1};
}

/// |p| = |p0|.
template <class T>
T norm(const DualComplex<T>& p) {
    return std::abs(p.p0);
}

/// Re(p0 ~q0), the dot product of the parts that turn: |p|^2 with itself; below 0 where p and -q are nearer
/// than p and q.
template <class T>
T rotation_dot(const DualComplex<T>& p, const DualComplex<T>& q) {
    return p.p0.real() * q.p0.real() + p.p0.imag() * q.p0.imag();
}

/// p / |p|. Requires p0 != 0.
template <class T>
DualComplex<T> normalised(const DualComplex<T>& p) {
    return (T(1) / norm(p)) * p;
}

/// The inverse of a unit DCN: ~p0 - p1 e.
template <class T>
DualComplex<T> inverse(const DualComplex<T>& p) {
    return {std::conj(p.p0), -p.p1};
}

/// The action of a unit DCN on a point of the plane: p <> v = p0^2 v + 2 p0 p1.
template <class T>
std::complex<T> act(const DualComplex<T>& p, std::complex<T> v) {
    return p.p0 * (p.p0 * v + T(2) * p.p1);
}

/// The turn by `angle` radians about `centre`: e^{it/2} + (e^{-it/2} - e^{it/2}) (c/2) e (MKO example 3.1).
/// The angle is unwrapped: t and t + 2 pi act alike but are p and -p, and blend differently.
template <class T>
DualComplex<T> rotation(T angle, std::complex<T> centre) {
    const std::complex<T> half = std::polar(T(1), angle / T(2));
    return {half, (std::conj(half) - half) * (centre / T(2))};
}

/// The shift by d: 1 + (d/2) e.
template <class T>
DualComplex<T> translation(std::complex<T> d) {
    return {std::complex<T>(T(1)), d / T(2)};
}

/// An element i h + p1 e of the Lie algebra: h is half the angle.
template <class T>
struct DualComplexLog {
    T h{};
    std::complex<T> p1{};

    friend constexpr bool operator==(const DualComplexLog&, const DualComplexLog&) = default;
};

template <class T>
DualComplexLog<T> operator+(const DualComplexLog<T>& x, const DualComplexLog<T>& y) {
    return {x.h + y.h, x.p1 + y.p1};
}

template <class T>
DualComplexLog<T> operator*(T s, const DualComplexLog<T>& x) {
    return {s * x.h, s * x.p1};
}

/// h, Re p1, Im p1: a basis of the algebra.
template <class T>
std::array<T, 3> coordinates(const DualComplexLog<T>& x) {
    return {x.h, x.p1.real(), x.p1.imag()};
}

template <class T>
DualComplexLog<T> from_coordinates(const std::array<T, 3>& x) {
    return {x[0], {x[1], x[2]}};
}

/// exp(i h + p1 e) = e^{ih} + (sin h / h) p1 e (MKO section 5).
template <class T>
DualComplex<T> exp(const DualComplexLog<T>& x) {
    return {std::polar(T(1), x.h), sinc(x.h) * x.p1};
}

/// The inverse of exp for a unit DCN, with h in [-pi, pi). At h = -pi (a whole turn that also shifts) no
/// logarithm exists; rounding keeps sinc away from zero there, and the p1 returned is huge.
template <class T>
DualComplexLog<T> log(const DualComplex<T>& p) {
    T h = std::arg(p.p0);
    if (h >= std::numbers::pi_v<T>) h = -std::numbers::pi_v<T>;
    return {h, p.p1 / sinc(h)};
}

template <class To, class From>
DualComplex<To> cast(const DualComplex<From>& p) {
    return {std::complex<To>(p.p0), std::complex<To>(p.p1)};
}

template <class T>
std::complex<T> to_complex(glm::vec<2, T> v) {
    return {v.x, v.y};
}

template <class T>
glm::vec<2, T> to_vec(std::complex<T> z) {
    return {z.real(), z.imag()};
}

}  // namespace probewarp
