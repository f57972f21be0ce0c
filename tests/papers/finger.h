// Regression paper, Fig. 3 and Fig. 4: a finger of two joints, whose last phalanx is predicted from the two
// readings at its joints.
#pragma once

#include <span>

#include "paper_tables.h"
#include "regression_errors.h"

namespace probewarp::papers {

/// Readings x1, x2 from 0 to 250 in steps of 10; each turns its joint. Both joints turn about the same
/// direction, so that the finger moves in a plane. The paper does not print these two: they are ours.
struct Finger {
    double phalanx = 25;        ///< from joint to joint, mm: a middle phalanx
    double degrees_each = 0.4;  ///< of either joint for each unit of its reading: up to 100
};
inline constexpr int most_reading = 250, reading_step = 10;

enum class Signs {
    principal,  ///< turns by up to half a turn from the reference, what is beyond as turned the other way
    carried     ///< from posture to posture, so that turns go on beyond half a turn
};

struct FingerCase {
    int side = 26;        ///< observations along each reading, 2 to 26: N = side^2
    double noise = 1e-3;  ///< standard deviation of each coordinate of each marker, mm
    int reference = 120;  ///< both readings of the reference posture
    Signs signs = Signs::principal;
};

/// How far the last phalanx turns from the reference at most, over all readings, degrees.
double furthest_turn(const Finger& finger, int reference);

/// Mean marker distance in mm over all 26 x 26 postures without noise, with features x1, x2, x1 x2 of the
/// readings less the reference's and no l2 term. P is DualComplex<double> or DualQuaternion<double>. The same
/// for the same arguments.
template <RigidTransformation P>
MeanErrors finger_errors(const Finger& finger, const FingerCase& which);

std::span<const Table> finger_tables();

}  // namespace probewarp::papers
