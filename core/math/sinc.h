// sin(h) / h and what else of exp and log has a removable singularity: Taylor polynomials near 0, each below
// the root of the scalar's epsilon at which its first missing term is lost in rounding.
#pragma once

#include <cmath>
#include <limits>

namespace probewarp {

/// sin(h) / h. The next term of 1 - h^2/6 is h^4/120.
template <class T>
T sinc(T h) {
    using std::abs, std::sin, std::sqrt;
    static const T threshold = sqrt(sqrt(std::numeric_limits<T>::epsilon()));
    if (abs(h) < threshold) return T(1) - h * h / T(6);
    return sin(h) / h;
}

/// (cos(h) - sinc(h)) / h^2: the derivative of sinc, divided by h. The series' next term is h^8/3991680.
/// Above the threshold rounding is epsilon / h^2; it is used times h^2.
template <class T>
T sinc_slope(T h) {
    using std::abs, std::cos, std::pow, std::sin;
    static const T threshold = pow(T(1e6) * std::numeric_limits<T>::epsilon(), T(0.125));
    const T square = h * h;
    if (abs(h) < threshold)
        return T(-1) / T(3) +
               square * (T(1) / T(30) + square * (T(-1) / T(840) + square * (T(1) / T(45360))));
    return (cos(h) - sin(h) / h) / square;
}

}  // namespace probewarp
