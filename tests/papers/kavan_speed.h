// Kavan et al. (TCD-CS-2006-46), appendix B: blending two transformations in the logarithm of their matrices,
// M(t) = exp((1 - t) log A + t log B), does not move at constant speed. Two examples and their closed forms.
#pragma once

#include <span>
#include <vector>

#include "paper_tables.h"

namespace probewarp::papers {

struct SpeedAt {
    double t;
    double closed_form;  ///< of log-matrix blending
    double numerical;    ///< ... by differences of our log_matrix_blend
    double sclerp;       ///< ScLERP's, by differences of our slerp
};

struct SpeedCurve {
    std::vector<SpeedAt> at;  ///< t = 0, 0.1, ..., 1
    double sclerp;            ///< ScLERP's in closed form: constant
};

/// How fast the body's origin moves, in lengths of d per unit of t: A shifts by d = (1, 0, 0), B turns by b =
/// 170 degrees about the z axis through the origin.
///
/// In the plane of x and y, as complex numbers, exp takes (angle x, l) to the turn by x and the shift V(x) l
/// with V(x) = (e^{ix} - 1) / (ix). So log A = (0, d), log B = (b, 0), M(t) = exp((b t, (1 - t) d)), and the
/// origin is at V(b t) (1 - t) d. Its velocity is (b (1 - t) V'(b t) - V(b t)) d, with V'(x) = (e^{ix} -
/// V(x)) / x and V'(0) = i/2. ScLERP turns the origin by b about a point from d to 0: at the speed b |d| / (2
/// sin(b/2)).
SpeedCurve moving_origin();

/// How fast the body turns, in radians per unit of t: A turns by 170 degrees about the x axis, B by 170
/// degrees about an axis 75 degrees from it in the plane of x and y, both through the origin.
///
/// With a, b their axes times their angles, M(t) = exp(L), L = (1 - t) a + t b, L' = b - a. exp(L + dL) =
/// exp(J dL) exp(L), where J leaves what lies along L as it is and turns what lies across it by |L|/2, times
/// s = sin(|L|/2) / (|L|/2). The angular velocity is J L'; with u = <L, L'> / |L|, its part along L, its size
/// is sqrt(u^2 + s^2 (|L'|^2 - u^2)). ScLERP's is the angle of B A^-1. It hardly varies: s is 1 to 2/pi.
SpeedCurve turning();

std::span<const Table> kavan_speed_tables();

}  // namespace probewarp::papers
