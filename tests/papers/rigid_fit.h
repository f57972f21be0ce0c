// Rigid transformations from markers, as a camera would have them: noise on the markers, and the fit.
#pragma once

#include <Eigen/Dense>
#include <cassert>
#include <cmath>
#include <complex>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "math/matrix.h"
#include "math/transformation.h"
#include "random.h"

namespace probewarp::papers {

inline Eigen::Vector2d to_eigen(const std::complex<double>& v) { return {v.real(), v.imag()}; }
inline Eigen::Vector3d to_eigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

inline DualComplex<double> to_unit(const Eigen::Matrix2d& r, const Eigen::Vector2d& d) {
    return to_dual_complex(glm::dmat3(r(0, 0), r(1, 0), 0, r(0, 1), r(1, 1), 0, d[0], d[1], 1));
}
inline DualQuaternion<double> to_unit(const Eigen::Matrix3d& r, const Eigen::Vector3d& d) {
    glm::dmat4 m(1);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) m[column][row] = r(row, column);
    m[3] = {d[0], d[1], d[2], 1};
    return to_dual_quaternion(m);
}

/// The rotation that is nearest to m in the sum of squares (Kabsch 1978): U V^T of m = U S V^T, or where that
/// mirrors, with the direction of the least singular value turned back.
template <int n>
Eigen::Matrix<double, n, n> nearest_rotation(const Eigen::Matrix<double, n, n>& m) {
    const Eigen::JacobiSVD<Eigen::Matrix<double, n, n>> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix<double, n, n> u = svd.matrixU();
    const Eigen::Matrix<double, n, n> v = svd.matrixV();
    if ((u * v.transpose()).determinant() < 0) u.col(n - 1) *= -1;
    return u * v.transpose();
}

/// The rigid transformation that takes `from` nearest to `to` in the sum of squares. Of the two signs, the
/// principal one. Both: #markers, at least two in the plane and three in space, not on a line.
template <RigidTransformation P>
P rigid_fit(const std::vector<typename P::Point>& from, const std::vector<typename P::Point>& to) {
    using Vector = decltype(to_eigen(from[0]));
    constexpr int n = Vector::RowsAtCompileTime;
    assert(from.size() == to.size() && !from.empty());
    Vector rest = Vector::Zero(), now = Vector::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) {
        rest += to_eigen(from[i]) / double(from.size());
        now += to_eigen(to[i]) / double(from.size());
    }
    Eigen::Matrix<double, n, n> sum = Eigen::Matrix<double, n, n>::Zero();
    for (std::size_t i = 0; i < from.size(); ++i)
        sum += (to_eigen(to[i]) - now) * (to_eigen(from[i]) - rest).transpose();
    const Eigen::Matrix<double, n, n> turn = nearest_rotation<n>(sum);
    return to_unit(turn, now - turn * rest);
}

/// Normally distributed numbers of mean 0 and deviation 1 (Box and Muller 1958; one of each pair is enough).
class Noise {
  public:
    double operator()() {
        const double u = 1 - random.real(0, 1);  // never 0
        return std::sqrt(-2 * std::log(u)) * std::cos(random.real(0, 2 * std::numbers::pi));
    }

  private:
    Random random;
};

inline std::complex<double> shaken(std::complex<double> v, double deviation, Noise& noise) {
    const double x = noise(), y = noise();
    return {v.real() + deviation * x, v.imag() + deviation * y};
}
inline glm::dvec3 shaken(glm::dvec3 v, double deviation, Noise& noise) {
    const double x = noise(), y = noise(), z = noise();
    return v + deviation * glm::dvec3(x, y, z);
}

/// What is measured of a body whose markers `p` has carried from `rest`: each of their coordinates with
/// noise, and the rigid transformation fitted to them. The noise is the markers' because they are what is
/// measured; on a transformation's own components it would have no unit.
template <RigidTransformation P>
P measured(const P& p, const std::vector<typename P::Point>& rest, double deviation, Noise& noise) {
    std::vector<typename P::Point> now;
    for (const auto& v : rest) now.push_back(shaken(act(p, v), deviation, noise));
    return rigid_fit<P>(rest, now);
}

}  // namespace probewarp::papers
