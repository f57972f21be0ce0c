// Random values for the laws: bounded, so that a tolerance can be stated, with the places that are easily got
// wrong (edges, whole turns, zero) more often than chance would have them.
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <type_traits>
#include <vector>

#include "math/dual_complex.h"
#include "math/dual_quaternion.h"

namespace probewarp {

template <class T>
std::ostream& operator<<(std::ostream& out, const DualComplex<T>& p) {
    return out << p.p0 << " + " << p.p1 << " e";
}

template <class T>
std::ostream& operator<<(std::ostream& out, const DualQuaternion<T>& q) {
    const auto write = [&](const Quaternion<T>& x) {
        out << '(' << x.w << ", " << x.x << ", " << x.y << ", " << x.z << ')';
    };
    write(q.q0), out << " + ", write(q.qe);
    return out << " e";
}

}  // namespace probewarp

namespace probewarp::testing {

/// Runs a property and fails the test where rapidcheck finds a counterexample (it prints it).
template <class Property>
void expect_always(const std::string& law, Property property) {
    EXPECT_TRUE(rc::check(law, property)) << law;
}

/// A whole number in [low, high], every one as likely.
inline rc::Gen<int> whole(int low, int high) {
    return rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high + 1));
}

/// A number in [low, high], spread evenly; rapidcheck's own are of any size and may be NaN.
inline rc::Gen<double> real(double low, double high) {
    constexpr int steps = 1'000'000'000;
    return rc::gen::map(whole(0, steps), [=](int n) { return low + (high - low) * n / steps; });
}

/// +-10^exponent with the exponent spread evenly.
inline rc::Gen<double> magnitude(double least_exponent, double most_exponent) {
    return rc::gen::map(rc::gen::pair(real(least_exponent, most_exponent), whole(0, 1)),
                        [](std::pair<double, int> x) { return (x.second ? -1 : 1) * std::pow(10, x.first); });
}

/// Radians: many turns, or a multiple of a quarter turn up to a tiny difference.
inline rc::Gen<double> angle(double turns) {
    const double most = 2 * std::numbers::pi * turns;
    const auto quarter =
        rc::gen::map(rc::gen::pair(whole(int(-4 * turns), int(4 * turns)), magnitude(-17, -2)),
                     [](std::pair<int, double> x) { return x.first * std::numbers::pi / 2 + x.second; });
    return rc::gen::oneOf(real(-most, most), quarter);
}

template <class T>
rc::Gen<std::complex<T>> point(double size) {
    return rc::gen::map(rc::gen::pair(real(-size, size), real(-size, size)),
                        [](std::pair<double, double> x) { return std::complex<T>(T(x.first), T(x.second)); });
}

/// A unit DCN: |p1| within `size`, the half angle anywhere.
template <class T>
rc::Gen<DualComplex<T>> unit_dcn(double size) {
    return rc::gen::map(rc::gen::pair(angle(1), point<T>(size)), [](std::pair<double, std::complex<T>> x) {
        return DualComplex<T>{std::polar(T(1), T(x.first / 2)), x.second};
    });
}

/// The laws that hold in the plane and in space run over these.
using Transformations =
    ::testing::Types<DualComplex<float>, DualComplex<double>, DualQuaternion<float>, DualQuaternion<double>>;

template <class P>
inline constexpr bool in_plane = std::is_same_v<typename P::Point, std::complex<typename P::Scalar>>;

/// A vector of space, each coordinate within `size`; one time in three along a coordinate axis.
template <class T>
glm::vec<3, T> any_vector(double size) {
    glm::vec<3, T> v(T(*real(-size, size)), T(*real(-size, size)), T(*real(-size, size)));
    const int alone = *whole(0, 8);
    for (int i = 0; i < 3 && alone < 3; ++i)
        if (i != alone) v[i] = T(0);
    return v;
}

template <class T>
glm::vec<3, T> any_axis() {
    const auto v = any_vector<T>(1);
    const T length = glm::length(v);
    return length > T(0.01) ? v / length : glm::vec<3, T>(T(0), T(0), T(1));
}

template <class P>
typename P::Point any_point(double size) {
    using T = typename P::Scalar;
    if constexpr (in_plane<P>)
        return *point<T>(size);
    else
        return any_vector<T>(size);
}

/// The element of the algebra with half the angle h about any axis, its other part within `size`.
template <class P>
typename P::Log any_log(typename P::Scalar h, double size) {
    using T = typename P::Scalar;
    if constexpr (in_plane<P>)
        return {h, *point<T>(size)};
    else
        return {any_axis<T>() * h, any_vector<T>(size)};
}

/// A unit whose p1 or qe is at most 2 `size`, the half angle anywhere in [-pi, pi].
template <class P>
P any_unit(double size) {
    using T = typename P::Scalar;
    if constexpr (in_plane<P>)
        return *unit_dcn<T>(size);
    else
        return translation(any_vector<T>(2 * size)) * rotation(T(*angle(1)), any_axis<T>());
}

/// The turn about x + y i, in space in the plane that embed puts there.
template <class P>
P turn_in_plane(double turn_degrees, double x = 0, double y = 0) {
    using T = typename P::Scalar;
    const auto p = rotation(T(turn_degrees * std::numbers::pi / 180), std::complex<T>(T(x), T(y)));
    if constexpr (in_plane<P>)
        return p;
    else
        return embed(p);
}

template <class T>
T difference(const std::complex<T>& a, const std::complex<T>& b) {
    return std::abs(a - b);
}

template <class T>
T difference(const glm::vec<3, T>& a, const glm::vec<3, T>& b) {
    return glm::length(a - b);
}

template <class T>
T difference(const DualComplex<T>& p, const DualComplex<T>& q) {
    return std::max(std::abs(p.p0 - q.p0), std::abs(p.p1 - q.p1));
}

template <class T>
T difference(const DualQuaternion<T>& p, const DualQuaternion<T>& q) {
    return std::max(glm::length(p.q0 - q.q0), glm::length(p.qe - q.qe));
}

template <class T, std::size_t N>
T difference(const std::array<T, N>& a, const std::array<T, N>& b) {
    T most{};
    for (std::size_t i = 0; i < N; ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

/// p and -p are the same transformation.
template <class P>
typename P::Scalar difference_of_motions(const P& p, const P& q) {
    return std::min(difference(p, q), difference(p, -q));
}

/// As embed of a dual complex number: i h + p1 e -> i h + p1 j e.
template <class T>
DualQuaternionLog<T> embed(const DualComplexLog<T>& x) {
    return {{x.h, T(0), T(0)}, {T(0), x.p1.real(), x.p1.imag()}};
}

}  // namespace probewarp::testing
