// Random values for the laws: bounded, so that a tolerance can be stated, with the places that are easily got
// wrong (edges, whole turns, zero) more often than chance would have them.
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <vector>

#include "math/dual_complex.h"

namespace probewarp {

template <class T>
std::ostream& operator<<(std::ostream& out, const DualComplex<T>& p) {
    return out << p.p0 << " + " << p.p1 << " e";
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

}  // namespace probewarp::testing
