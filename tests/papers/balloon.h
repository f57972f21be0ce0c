// Regression paper, section B: a balloon that is squashed, each marker on it predicted from how the hand on
// it stands.
#pragma once

#include <span>
#include <vector>

#include "paper_tables.h"
#include "regression_errors.h"

namespace probewarp::papers {

/// A sphere of radius 60 mm that stands on a table while a palm on its top presses and tilts. The paper's own
/// balloon is not at hand: this shape is ours. Readings, each scaled to at most 1: how deep the palm presses
/// (0 to 36 mm), and its tilts about two horizontal axes (up to `tilt` either way): 19 x 9 x 5 = 855
/// postures.
struct Balloon {
    static constexpr int marker_count = 15, posture_count = 855, variables = 3;

    /// tilt: degrees. noise: standard deviation of each coordinate of each point, mm.
    Balloon(double tilt, double noise);

    std::vector<double> readings;                  ///< posture_count x variables, in random order
    std::vector<std::vector<glm::dvec3>> markers;  ///< at rest, marker_count x 4 corners of a sticker
    std::vector<std::vector<DualQuaternion<double>>> truth;  ///< marker_count x posture_count, from rest on
    std::vector<std::vector<DualQuaternion<double>>> observed;  ///< the same, fitted to the noisy corners
};

/// The largest turn of a marker from rest, degrees.
double furthest_turn(const Balloon& balloon);

/// Mean distance in mm of the markers' corners from where they truly are, over every ninth posture, with
/// polynomial features of the degrees 1 to `degree`, learned from the first `count` postures.
/// Throws RankDeficient.
MeanErrors balloon_errors(const Balloon& balloon, int degree, int count, double lambda);

std::span<const Table> balloon_tables();

}  // namespace probewarp::papers
