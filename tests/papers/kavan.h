// Kavan et al. (TCD-CS-2006-46), sections 4 and 5: how near DLB comes to ScLERP, and how fast DIB converges.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "math/dual_quaternion.h"
#include "paper_tables.h"

namespace probewarp::papers {

/// How DLB of p and q differs from ScLERP at t. Both are p followed by a screw about the axis of q p^-1.
struct Gap {
    double angle = 0;  ///< radians by which the two screws' angles differ
    double shift = 0;  ///< by how much of the pitch of q p^-1 their shifts along the axis differ
    double axis = 0;   ///< |a b - b a| with a of DLB's screw, b = q p^-1: 0 where they share their axis
};

/// Measured on our dlb and slerp. Requires <p0, q0> >= 0: q with the nearer sign; t in [0, 1].
Gap gap(const DualQuaternion<double>& p, const DualQuaternion<double>& q, double t);

/// The largest of each over `pairs` random pairs, t evenly in [0, 1].
Gap worst_of_random_pairs(std::size_t pairs);

struct Worst {
    double t = 0;     ///< where; by symmetry at 1 - t too
    double most = 0;  ///< radians, or the share of the pitch
};
struct WorstGaps {
    Worst angle, shift;
};

/// Searched over t on our dlb and slerp, for two that lie half a turn apart.
WorstGaps searched_worst();

// In closed form: q p^-1 = cos(A/2) + s sin(A/2) with the dual angle A = angle + pitch e, so DLB at t is the
// screw about s by B(A) with tan(B/2) = t sin(A/2) / (1 - t + t cos(A/2)); its pitch is the dual part, pitch
// B'(angle). ScLERP's is t A. Both gaps grow with the angle, to half a turn: there tan(B/2) = t / (1 - t),
// and with D = (1 - t)^2 + t^2
//   the angles differ by pi t - 2 atan(t / (1 - t)), most where D = 2 / pi, t = (1 - sqrt(4/pi - 1)) / 2;
//   the shifts differ by t - t^2 / D of the pitch, most where D^2 = 2 t (1 - t) = 1 - D, so
//   D = (sqrt(5) - 1) / 2, t = (1 - sqrt(2 D - 1)) / 2.
WorstGaps closed_form_worst();

/// Lemma 3: the largest difference of any number of DIB of two after one step from ScLERP, over random pairs.
double lemma3_difference(std::size_t pairs);

inline constexpr int most_steps = 40;

struct Steps {
    double spread;                           ///< radians: every rotation is within this of one that all share
    double precision;                        ///< of the half angle in radians, and of half the unit of length
    std::array<int, most_steps + 1> sets{};  ///< sets[k]: how many random sets took k steps
    int unconverged = 0;                     ///< after most_steps

    int most() const;   ///< steps that any set took
    int least() const;  ///< ...
};

/// DIB of `sets` random sets of 2 to 8 transformations with random convex weights, each with the sign nearer
/// to the pivot. The last step, which finds that nothing is left to do, is counted.
Steps dib_steps(double spread, double precision, int sets);

/// The rows of the table of steps.
std::vector<Steps> all_dib_steps();

std::span<const Table> kavan_tables();

}  // namespace probewarp::papers
