// Regression of rigid transformations on real vectors: from observations y_n at readings x_n to the
// transformation at any reading. Source: "Regression of 3D rigid transformations on real-valued vectors in
// closed form", here "the regression paper". Written over the concept, so in the plane as in space.
//
// Every method here takes what the least squares of the design X (one row of features an observation) make of
// it, and what tells them apart is only how they blend. So readings and observations are relative to a
// reference: features phi(x - x_ref), all 0 there unless they hold a constant, and observations y_ref^-1 y
// (or y y_ref^-1: no method tells them apart). Among the observations the reference is the identity.
#pragma once

#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "math/blend.h"
#include "math/matrix_blend.h"
#include "math/transformation.h"

namespace probewarp {

// ---- Features

/// A product of powers of the readings: the exponent of each, so that {1, 2} is x1 x2^2.
using Monomial = std::vector<int>;

/// Appends to `list` the monomials whose first exponents are those of `head` and whose others sum to
/// `degree`.
inline void append_monomials(std::vector<Monomial>& list, Monomial& head, std::size_t variables, int degree) {
    if (head.size() + 1 == variables) {
        list.push_back(head);
        list.back().push_back(degree);
        return;
    }
    for (int exponent = degree; exponent >= 0; --exponent) {
        head.push_back(exponent);
        append_monomials(list, head, variables, degree - exponent);
        head.pop_back();
    }
}

/// All monomials of the degrees from `least` to `most`, by degree and then by falling exponents: of two
/// variables x1, x2, x1^2, x1 x2, x2^2, ... A `least` of 0 puts the constant in front; without it the
/// reference is met exactly. Requires variables >= 1, 0 <= least <= most.
inline std::vector<Monomial> monomials(std::size_t variables, int least, int most) {
    assert(variables >= 1 && 0 <= least && least <= most);
    std::vector<Monomial> list;
    Monomial head;
    for (int degree = least; degree <= most; ++degree) append_monomials(list, head, variables, degree);
    return list;
}

/// phi(x): the value of each monomial. reading: #variables, less the reference's.
template <class T>
std::vector<T> features(std::span<const Monomial> list, std::span<const T> reading) {
    std::vector<T> values;
    for (const Monomial& exponents : list) {
        assert(exponents.size() == reading.size());
        T product(1);
        for (std::size_t i = 0; i < reading.size(); ++i)
            for (int e = 0; e < exponents[i]; ++e) product *= reading[i];
        values.push_back(product);
    }
    return values;
}

/// X: #readings x #monomials. readings: #readings x #variables, row-major, less the reference's.
template <class T>
Eigen::MatrixX<T> design(std::span<const Monomial> list, std::span<const T> readings, std::size_t variables) {
    assert(variables >= 1 && readings.size() % variables == 0);
    const std::size_t rows = readings.size() / variables;
    Eigen::MatrixX<T> x(rows, list.size());
    for (std::size_t n = 0; n < rows; ++n) {
        const std::vector<T> row = features(list, readings.subspan(n * variables, variables));
        for (std::size_t k = 0; k < row.size(); ++k) x(Eigen::Index(n), Eigen::Index(k)) = row[k];
    }
    return x;
}

// ---- Least squares

/// The observations do not determine the coefficients of all features.
struct RankDeficient : std::invalid_argument {
    RankDeficient(Eigen::Index independent, Eigen::Index all)
        : std::invalid_argument("The observations tell only " + std::to_string(independent) + " of the " +
                                std::to_string(all) +
                                " features apart: take more or other observations, fewer features, or a "
                                "larger l2 term."),
          rank(independent),
          feature_count(all) {}
    Eigen::Index rank, feature_count;
};

/// (X^T X + lambda I)^-1 X^T, #features x #observations: what takes observed values to the coefficients that
/// minimise |X b - y|^2 + lambda |b|^2. By a pivoted QR decomposition of [X; sqrt(lambda) I], which does not
/// square the condition as X^T X does. The columns are scaled to length 1 before it, so that the rank does
/// not depend on the features' units; a column counts as dependent where what the others leave of it is
/// within rounding. Throws RankDeficient; std::invalid_argument where lambda is negative or a number is not
/// finite.
template <class T>
Eigen::MatrixX<T> regularised_inverse(const Eigen::MatrixX<T>& x, T lambda) {
    const Eigen::Index rows = x.rows(), columns = x.cols();
    if (!(lambda >= T(0)) || !std::isfinite(lambda))
        throw std::invalid_argument("The l2 term must be a finite number of at least 0.");
    if (!x.allFinite()) throw std::invalid_argument("A feature of an observation is not a finite number.");
    if (columns == 0) throw std::invalid_argument("A regression needs at least one feature.");

    Eigen::MatrixX<T> augmented(rows + columns, columns);
    augmented << x, std::sqrt(lambda) * Eigen::MatrixX<T>::Identity(columns, columns);
    // stableNorm: a square of a feature must not overflow. A column of zeros stays one.
    Eigen::VectorX<T> scale(columns);
    for (Eigen::Index k = 0; k < columns; ++k) {
        const T length = augmented.col(k).stableNorm();
        scale[k] = length > T(0) ? T(1) / length : T(1);
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixX<T>> qr;
    // A dependent column keeps of its length 1 the roundings of its numbers and of the reflections.
    qr.setThreshold(T(8 * augmented.rows()) * std::numeric_limits<T>::epsilon());
    qr.compute(augmented * scale.asDiagonal());
    if (qr.rank() < columns) throw RankDeficient(qr.rank(), columns);

    const Eigen::MatrixX<T> q =
        qr.householderQ() * Eigen::MatrixX<T>::Identity(augmented.rows(), columns);  // its first columns
    const Eigen::MatrixX<T> solved =
        qr.matrixQR().topRows(columns).template triangularView<Eigen::Upper>().solve(
            q.topRows(rows).transpose());
    return scale.asDiagonal() * (qr.colsPermutation() * solved);
}

// ---- Signs: p and -p are one transformation with two logarithms

/// The one of p and -p that turns by at most half a turn; its logarithm is the principal one. What lies
/// beyond half a turn from the reference comes out as turned the other way, and a regression over it breaks
/// there.
template <RigidTransformation P>
P principal(const P& p) {
    return rotation_dot(p, P{}) < typename P::Scalar(0) ? -p : p;
}

/// Gives each observation the sign that is nearer to the one before it, the first its principal one: turns
/// are then unwrapped up to a whole turn either way of the reference. In an order in which neighbours are
/// less than half a turn apart. What comes from unwrapped angles has its signs already.
template <RigidTransformation P>
void carry_signs(std::span<P> y) {
    P before{};
    for (P& p : y) before = p = rotation_dot(p, before) < typename P::Scalar(0) ? -p : p;
}

// ---- The regression in closed form

/// y(x) = exp(sum_k phi_k(x) log b_k) (regression paper, equations 8 to 10). The logarithms are kept, not the
/// b_k: they may be longer than exp can be undone.
template <RigidTransformation P>
struct LogLinear {
    std::vector<typename P::Log> log_b;  ///< #features
};

/// log b = (X^T X + lambda I)^-1 X^T log y. Each observation is taken with the sign that it has.
/// x: #observations x #features. y: #observations.
/// Throws what regularised_inverse does; std::invalid_argument where an observation is within a thousandth of
/// a radian (of its half angle) of a whole turn: it has no logarithm there, or one of any direction.
template <RigidTransformation P>
LogLinear<P> fit_log_linear(const Eigen::MatrixX<typename P::Scalar>& x, std::span<const P> y,
                            typename P::Scalar lambda) {
    using T = typename P::Scalar;
    assert(std::size_t(x.rows()) == y.size());
    const Eigen::MatrixX<T> inverted = regularised_inverse(x, lambda);
    std::vector<typename P::Log> logs;
    for (const P& p : y) {
        // 1 - cos(1e-3) is half a millionth.
        if (!(rotation_dot(p, P{}) > T(-1) + cancelled_share<T> / T(2)))
            throw std::invalid_argument(
                "An observation is a whole turn from the reference: take a reference nearer to it.");
        logs.push_back(log(p));
    }
    LogLinear<P> model;
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
        typename P::Log sum{};
        for (std::size_t n = 0; n < y.size(); ++n) sum = sum + inverted(k, Eigen::Index(n)) * logs[n];
        model.log_b.push_back(sum);
    }
    return model;
}

/// The transformation at a reading, relative to the reference. phi: #features.
template <RigidTransformation P>
P predict(const LogLinear<P>& model, std::span<const typename P::Scalar> phi) {
    assert(phi.size() == model.log_b.size());
    typename P::Log sum{};
    for (std::size_t k = 0; k < phi.size(); ++k) sum = sum + phi[k] * model.log_b[k];
    return exp(sum);
}

// ---- The regressions that it is compared with

/// A linear regression's prediction is a sum of what was observed, with weights
/// c(x) = phi(x)^T (X^T X + lambda I)^-1 X^T. Here these weigh transformations, whatever the blend, and the
/// reference weighs what they lack of 1. Blended in the logarithm (equation 7) they give LogLinear again;
/// blended component by component, ridge regression.
template <RigidTransformation P>
struct BlendRegression {
    Eigen::MatrixX<typename P::Scalar> inverted;  ///< #features x #observations: regularised_inverse
    std::vector<P> observed;                      ///< #observations + 1: the last is the reference, 1
};

/// Shapes and errors as fit_log_linear's, without what is said there of logarithms.
template <RigidTransformation P>
BlendRegression<P> fit_blend(const Eigen::MatrixX<typename P::Scalar>& x, std::span<const P> y,
                             typename P::Scalar lambda) {
    assert(std::size_t(x.rows()) == y.size());
    BlendRegression<P> model{regularised_inverse(x, lambda), {y.begin(), y.end()}};
    model.observed.push_back(P{});
    return model;
}

/// The weights of `observed` at a reading: they sum to 1 and may be below 0 or above 1. phi: #features.
template <RigidTransformation P>
std::vector<typename P::Scalar> blend_weights(const BlendRegression<P>& model,
                                              std::span<const typename P::Scalar> phi) {
    using T = typename P::Scalar;
    assert(Eigen::Index(phi.size()) == model.inverted.rows());
    std::vector<T> weights(model.observed.size());
    const Eigen::Index count = model.inverted.cols();
    Eigen::Map<Eigen::RowVectorX<T>> c(weights.data(), count);
    c = Eigen::Map<const Eigen::RowVectorX<T>>(phi.data(), model.inverted.rows()) * model.inverted;
    weights.back() = T(1) - c.sum();
    return weights;
}

/// Regression by DLB: the same as each component's ridge regression from 1 on, normalised.
template <RigidTransformation P>
Blend<P> predict_dlb(const BlendRegression<P>& model, std::span<const typename P::Scalar> phi) {
    return dlb<P>(blend_weights(model, phi), model.observed);
}

/// Regression by DIB. The weights are not convex, so that it need not converge: the answer says whether it
/// did. `precision` as dib's.
template <RigidTransformation P>
Iteration<P> predict_dib(const BlendRegression<P>& model, std::span<const typename P::Scalar> phi,
                         typename P::Scalar precision) {
    return dib<P>(blend_weights(model, phi), model.observed, precision);
}

/// Ridge regression of each component of the matrices, or what is the same, of each coordinate of any points
/// that the transformations carry. Not rigid.
template <RigidTransformation P>
auto predict_matrix(const BlendRegression<P>& model, std::span<const typename P::Scalar> phi) {
    return linear_matrix_blend<P>(blend_weights(model, phi), model.observed);
}

}  // namespace probewarp
