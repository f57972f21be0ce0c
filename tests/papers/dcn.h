// MKO (arXiv 1601.01754), section 5: DLB distributes over composition, SLERP turns uniformly, and DLB has no
// candy wrapper.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "paper_tables.h"

namespace probewarp::papers {

struct Distributivity {
    double left = 0;   ///< the largest difference of any number of q dlb(w, p_i) and dlb(w, q p_i)
    double right = 0;  ///< ... of dlb(w, p_i) q and dlb(w, p_i q)
};

/// Over random sets of 2 to 8 DCNs, with random convex weights that leave at least a tenth: where they
/// cancel, rounding is all that is left.
Distributivity distributivity(std::size_t sets);

/// From one transformation to the same followed by a turn by `apart` about a point: the fastest over the
/// slowest angular velocity, and how far the point moves that should stay.
struct Evenness {
    double apart;         ///< radians
    double slerp;         ///< 1: uniform
    double centre_moves;  ///< on SLERP's way
    double dlb;           ///< numerically, as slerp
    double dlb_exact;     ///< 1 / cos^2(apart / 4): half the angle at t is the argument of 1 - t + t e^{i
                          ///< apart/2}, so the velocity is proportional to 1 / |1 - t + t e^{i apart/2}|^2
};
std::vector<Evenness> evenness();  ///< from 30 to 350 degrees

/// A bar [-2, 2] x [-1/4, 1/4] with a probe on each end. They are turned by -apart/2 and apart/2 about the
/// bar's centre; the weight of the right one grows evenly from 0 to 1 along the bar, the left one has the
/// rest.
struct Bar {
    static constexpr double half_length = 2, half_width = 0.25;
    double apart;  ///< radians

    std::complex<double> linear(std::complex<double> v) const;  ///< deformed by linear blending
    std::complex<double> dlb(std::complex<double> v) const;     ///< ... by DLB
};

/// The smallest singular value, over the bar, of the deformation's Jacobian, the weights' gradient included:
/// by central differences on a grid of 161 x 21 points that has the centre. 0: something is flattened there.
struct Wrapper {
    double apart;  ///< radians
    double linear, dlb;
    double dlb_exact;  ///< the same of the closed form, on the same grid
};

/// DLB turns a cross section at x by a(x) = 2 atan(x/2 tan(apart/4)), so that v' = e^{i a(x)} v. Seen from
/// the turned frame its Jacobian is [1 - a' y, 0; a' x, 1].
Wrapper wrapper(double apart);
std::vector<Wrapper> wrappers();  ///< from 90 to 270 degrees

std::span<const Table> dcn_tables();

}  // namespace probewarp::papers
