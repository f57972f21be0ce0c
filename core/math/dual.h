// Dual numbers a + b e with e e = 0 and e commuting: the scalars of dual quaternions (Kavan et al.,
// TCD-CS-2006-46, section 3).
#pragma once

#include <cmath>

namespace probewarp {

template <class T>
struct Dual {
    T real{};  ///< a
    T dual{};  ///< b

    friend constexpr bool operator==(const Dual&, const Dual&) = default;
};

template <class T>
Dual<T> operator+(const Dual<T>& x, const Dual<T>& y) {
    return {x.real + y.real, x.dual + y.dual};
}

template <class T>
Dual<T> operator-(const Dual<T>& x, const Dual<T>& y) {
    return {x.real - y.real, x.dual - y.dual};
}

template <class T>
Dual<T> operator*(const Dual<T>& x, const Dual<T>& y) {
    return {x.real * y.real, x.real * y.dual + x.dual * y.real};
}

/// a - b e.
template <class T>
Dual<T> conj(const Dual<T>& x) {
    return {x.real, -x.dual};
}

/// 1 / (a + b e) = 1/a - (b / a^2) e. Requires a != 0.
template <class T>
Dual<T> inverse(const Dual<T>& x) {
    return {T(1) / x.real, -x.dual / (x.real * x.real)};
}

/// sqrt(a + b e) = sqrt(a) + b / (2 sqrt(a)) e. Requires a > 0.
template <class T>
Dual<T> sqrt(const Dual<T>& x) {
    using std::sqrt;
    const T root = sqrt(x.real);
    return {root, x.dual / (T(2) * root)};
}

/// The Taylor series of f at a, which ends after its second term: f(a) + f'(a) b e.
template <class T>
Dual<T> sin(const Dual<T>& x) {
    using std::cos, std::sin;
    return {sin(x.real), cos(x.real) * x.dual};
}

template <class T>
Dual<T> cos(const Dual<T>& x) {
    using std::cos, std::sin;
    return {cos(x.real), -sin(x.real) * x.dual};
}

}  // namespace probewarp
