// Random transformations for the tables: the same numbers on every machine, since only the engine is the
// standard library's (its distributions differ from one library to the next).
#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>

#include "math/dual_complex.h"
#include "math/dual_quaternion.h"

namespace probewarp::papers {

inline constexpr std::uint64_t seed = 20160107;  // printed with every table that draws from it

class Random {
  public:
    explicit Random(std::uint64_t from = seed) : engine(from) {}

    /// Evenly in [low, high).
    double real(double low, double high) { return low + (high - low) * (double(engine() >> 11) * 0x1p-53); }
    /// Evenly in {low, ..., high}.
    int whole(int low, int high) { return low + int(real(0, 1) * (high - low + 1)); }

    glm::dvec3 point() { return {real(-1, 1), real(-1, 1), real(-1, 1)}; }

    /// Every rotation of space as likely as every other, p and -p too (Shoemake 1992).
    glm::dquat rotation() {
        const double u = real(0, 1), a = real(0, 2 * std::numbers::pi), b = real(0, 2 * std::numbers::pi);
        const double s = std::sqrt(1 - u), c = std::sqrt(u);
        return {s * std::sin(a), s * std::cos(a), c * std::sin(b), c * std::cos(b)};
    }
    DualQuaternion<double> anywhere() {
        return translation(point()) * DualQuaternion<double>{rotation(), {0, 0, 0, 0}};
    }
    /// A turn of up to `most` radians about any axis through the origin, then a shift, with either sign.
    DualQuaternion<double> within(double most) {
        glm::dvec3 axis;
        do axis = point();
        while (!(glm::length(axis) > 0.1 && glm::length(axis) <= 1));
        const auto p = translation(point()) * probewarp::rotation(real(0, most), glm::normalize(axis));
        return real(0, 1) < 0.5 ? -p : p;
    }
    /// A unit DCN with any half angle and a shift within [-2, 2] x [-2, 2].
    DualComplex<double> planar() {
        return {std::polar(1.0, real(-std::numbers::pi, std::numbers::pi)), {real(-1, 1), real(-1, 1)}};
    }
    /// Convex: positive and of sum 1.
    void weights(std::span<double> w) {
        double sum = 0;
        for (double& x : w) sum += x = real(0, 1);
        for (double& x : w) x /= sum;
    }

  private:
    std::mt19937_64 engine;
};

}  // namespace probewarp::papers
