// A scalar that counts what is done with it: a template of core/math that is run on it tells its cost.
#pragma once

#include <cmath>
#include <compare>
#include <concepts>
#include <limits>
#include <numbers>

namespace probewarp::papers {

/// What was done. Negations, comparisons, absolute values and copies are free.
struct Operations {
    int additions = 0;  ///< and subtractions
    int multiplications = 0;
    int divisions = 0;
    int roots = 0;
    int functions = 0;  ///< sin, cos, atan2, ...: counted apart

    int flops() const { return additions + multiplications + divisions + roots; }
    friend bool operator==(const Operations&, const Operations&) = default;
};

/// As double. std::complex and GLM take it as their element: the first is unspecified for such a type by the
/// standard, and does just what its formulas say in libstdc++ and libc++. No member is initialised, since
/// GLM's vectors are unions.
struct Counting {
    double value;

    static inline Operations done;

    Counting() = default;
    template <class Number>
    requires std::integral<Number> || std::floating_point<Number>
    constexpr Counting(Number x) : value(double(x)) {}

    /// core/math asks for std::abs of weights by its full name, and gets that of double.
    operator double() const { return value; }

    friend Counting operator-(Counting a) { return -a.value; }
    friend Counting operator+(Counting a, Counting b) { return ++done.additions, a.value + b.value; }
    friend Counting operator-(Counting a, Counting b) { return ++done.additions, a.value - b.value; }
    friend Counting operator*(Counting a, Counting b) { return ++done.multiplications, a.value * b.value; }
    friend Counting operator/(Counting a, Counting b) { return ++done.divisions, a.value / b.value; }
    Counting& operator+=(Counting b) { return *this = *this + b; }
    Counting& operator-=(Counting b) { return *this = *this - b; }
    Counting& operator*=(Counting b) { return *this = *this * b; }
    Counting& operator/=(Counting b) { return *this = *this / b; }
    friend constexpr bool operator==(Counting a, Counting b) { return a.value == b.value; }
    friend constexpr auto operator<=>(Counting a, Counting b) { return a.value <=> b.value; }

    friend Counting abs(Counting x) { return std::abs(x.value); }
    friend Counting sqrt(Counting x) { return ++done.roots, std::sqrt(x.value); }
    friend Counting sin(Counting x) { return ++done.functions, std::sin(x.value); }
    friend Counting cos(Counting x) { return ++done.functions, std::cos(x.value); }
    friend Counting atan2(Counting y, Counting x) { return ++done.functions, std::atan2(y.value, x.value); }
    friend Counting pow(Counting x, Counting y) { return ++done.functions, std::pow(x.value, y.value); }
};

/// What `run` does. It is run twice and counted the second time: thresholds are worked out once a program.
template <class Run>
Operations count(Run run) {
    run();
    Counting::done = {};
    run();
    return Counting::done;
}

}  // namespace probewarp::papers

template <>
struct std::numeric_limits<probewarp::papers::Counting> : std::numeric_limits<double> {
    static constexpr probewarp::papers::Counting epsilon() { return std::numeric_limits<double>::epsilon(); }
};
