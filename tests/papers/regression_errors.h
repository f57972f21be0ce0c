// How far the markers that a regression predicts are from the true ones: the figure of the regression paper's
// experiments, for its four methods.
#pragma once

#include <glm/geometric.hpp>
#include <vector>

#include "math/regression.h"

namespace probewarp::papers {

/// Means over predictions and markers, in the markers' unit.
struct MeanErrors {
    double log_linear = 0, dlb = 0, ridge = 0;
    double dib = 0;     ///< of the predictions that converged
    int unsettled = 0;  ///< predictions at which DIB did not converge
};

/// One body. Readings are row-major and less the reference's; transformations are relative to the reference.
template <RigidTransformation P>
struct Trial {
    std::vector<Monomial> monomials;
    double lambda = 0;                         ///< the l2 term
    std::vector<double> readings{};            ///< #observations x #variables
    std::vector<P> observed{};                 ///< #observations
    std::vector<double> asked{};               ///< #predictions x #variables
    std::vector<P> truth{};                    ///< #predictions
    std::vector<typename P::Point> markers{};  ///< where they are at the reference
};

inline double distance(std::complex<double> a, std::complex<double> b) { return std::abs(a - b); }
inline double distance(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b); }

/// The mean distance of the markers carried by `predicted`, which is anything that acts, from the true ones.
template <class Predicted, RigidTransformation P>
double marker_distance(const Predicted& predicted, const P& truth,
                       const std::vector<typename P::Point>& markers) {
    double sum = 0;
    for (const auto& v : markers) sum += distance(act(predicted, v), act(truth, v));
    return sum / double(markers.size());
}

/// Throws RankDeficient.
template <RigidTransformation P>
MeanErrors mean_errors(const Trial<P>& trial) {
    // Radians of the half angle, and half units of length: far below any error that is printed.
    constexpr double dib_precision = 1e-9;
    const std::size_t variables = trial.monomials.at(0).size(), count = trial.truth.size();
    const auto x = design<double>(trial.monomials, trial.readings, variables);
    const auto closed = fit_log_linear<P>(x, trial.observed, trial.lambda);
    const auto blended = fit_blend<P>(x, trial.observed, trial.lambda);
    MeanErrors sum;
    for (std::size_t i = 0; i < count; ++i) {
        const auto phi = features<double>(
            trial.monomials, std::span<const double>(trial.asked).subspan(i * variables, variables));
        const auto error = [&](const auto& predicted) {
            return marker_distance(predicted, trial.truth[i], trial.markers);
        };
        sum.log_linear += error(predict<P>(closed, phi));
        sum.dlb += error(predict_dlb<P>(blended, phi).p);
        sum.ridge += error(predict_matrix<P>(blended, phi));
        const auto dib = predict_dib<P>(blended, phi, dib_precision);
        if (dib.converged)
            sum.dib += error(dib.p);
        else
            ++sum.unsettled;
    }
    const double n = double(count), settled = double(count) - sum.unsettled;
    return {sum.log_linear / n, sum.dlb / n, sum.ridge / n, sum.dib / settled, sum.unsettled};
}

}  // namespace probewarp::papers
