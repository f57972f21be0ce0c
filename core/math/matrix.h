// The matrices of rigid transformations, to and from (MKO section 6): 2 x 2 complex and 3 x 3 real in the
// plane, 4 x 4 real in space. Matrices act on columns and GLM holds them column by column.
#pragma once

#include <cmath>
#include <complex>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "math/dual_complex.h"
#include "math/dual_quaternion.h"

namespace probewarp {

/// [ a b ]
/// [ c d ]
template <class T>
struct ComplexMatrix {
    std::complex<T> a{T(1)}, b{T(0)}, c{T(0)}, d{T(1)};
};

template <class T>
ComplexMatrix<T> operator*(const ComplexMatrix<T>& m, const ComplexMatrix<T>& n) {
    return {m.a * n.a + m.b * n.c, m.a * n.b + m.b * n.d, m.c * n.a + m.d * n.c, m.c * n.b + m.d * n.d};
}

/// p0 + p1 e as [p0 p1; 0 ~p0]: sums and products are the matrices' own (MKO section 6).
template <class T>
ComplexMatrix<T> to_complex_matrix(const DualComplex<T>& p) {
    return {p.p0, p.p1, std::complex<T>(0), std::conj(p.p0)};
}

/// Requires a matrix that to_complex_matrix gives, or a sum or product of such.
template <class T>
DualComplex<T> to_dual_complex(const ComplexMatrix<T>& m) {
    return {m.a, m.b};
}

/// The action on a point of the plane: twice the Moebius transformation of half the point. For a unit, a
/// division by d is a product with a.
template <class T>
std::complex<T> act(const ComplexMatrix<T>& m, std::complex<T> v) {
    return m.a * (m.a * v + T(2) * m.b);
}

/// The rotation and the shift of a unit DCN as a matrix of SE(2): [Re p0^2, -Im p0^2, x; Im p0^2, Re p0^2, y;
/// 0 0 1] with x + y i = 2 p0 p1.
template <class T>
glm::mat<3, 3, T> to_matrix(const DualComplex<T>& p) {
    const T a = p.p0.real(), b = p.p0.imag();
    const T twice = b + b, cosine = T(1) - twice * b, sine = twice * a;
    const std::complex<T> half = p.p0 * p.p1;
    return {cosine, sine, T(0), -sine, cosine, T(0), half.real() + half.real(), half.imag() + half.imag(),
            T(1)};
}

/// Of a rigid matrix: the unit whose p0 has an angle in [-pi/2, pi/2].
template <class T>
DualComplex<T> to_dual_complex(const glm::mat<3, 3, T>& m) {
    const std::complex<T> p0 = std::polar(T(1), std::atan2(m[0][1], m[0][0]) / T(2));
    return {p0, std::complex<T>(m[2][0], m[2][1]) * std::conj(p0) / T(2)};
}

/// The rotation and the shift of a unit dual quaternion as a matrix of SE(3); the shift is the vector of
/// 2 qe ~q0 (Kavan section 3).
template <class T>
glm::mat<4, 4, T> to_matrix(const DualQuaternion<T>& q) {
    glm::mat<4, 4, T> m(glm::mat3_cast(q.q0));
    const auto half = vector_part(q.qe * glm::conjugate(q.q0));
    m[3] = {half.x + half.x, half.y + half.y, half.z + half.z, T(1)};
    return m;
}

/// Of a rigid matrix: the unit whose q0 has a scalar part >= 0.
template <class T>
DualQuaternion<T> to_dual_quaternion(const glm::mat<4, 4, T>& m) {
    Quaternion<T> q0 = glm::normalize(glm::quat_cast(glm::mat<3, 3, T>(m)));
    if (q0.w < T(0)) q0 = -q0;
    const glm::vec<3, T> half = glm::vec<3, T>(m[3]) * T(0.5);
    return {q0, quaternion(T(0), half) * q0};
}

/// The action of a homogeneous matrix on a point.
template <class T>
std::complex<T> act(const glm::mat<3, 3, T>& m, std::complex<T> v) {
    return {m[0][0] * v.real() + m[1][0] * v.imag() + m[2][0],
            m[0][1] * v.real() + m[1][1] * v.imag() + m[2][1]};
}

template <class T>
glm::vec<3, T> act(const glm::mat<4, 4, T>& m, const glm::vec<3, T>& v) {
    return glm::vec<3, T>(m[0]) * v.x + glm::vec<3, T>(m[1]) * v.y + glm::vec<3, T>(m[2]) * v.z +
           glm::vec<3, T>(m[3]);
}

}  // namespace probewarp
