// The regressions of rigid transformations (the regression paper), in the plane and in space: what they
// recover, what they do not depend on, and what they refuse.
#include "math/regression.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <numbers>
#include <tuple>

#include "generators.h"

namespace probewarp {
namespace {

using testing::expect_always;
using testing::real;
using testing::whole;

template <class P>
using Coordinates = decltype(coordinates(typename P::Log{}));

/// A half angle within `turn` and a shift within about `size`, by their coordinates in the algebra.
template <class P>
P any_unit(double turn, double size) {
    using T = typename P::Scalar;
    constexpr std::size_t count = std::tuple_size_v<Coordinates<P>>, turns = count == 3 ? 1 : 3;
    Coordinates<P> x;
    for (std::size_t i = 0; i < turns; ++i) x[i] = T(*real(-turn, turn) / std::sqrt(double(turns)));
    for (std::size_t i = turns; i < count; ++i) x[i] = T(*real(-size, size));
    return exp(from_coordinates(x));
}

/// How far apart, as the logarithm measures it; p and -p are pi apart.
template <class P>
typename P::Scalar apart(const P& p, const P& q) {
    return length(log(p * inverse(q)));
}

template <class P>
std::vector<typename P::Point> points() {
    using T = typename P::Scalar;
    if constexpr (std::is_same_v<typename P::Point, std::complex<T>>)
        return {{0, 0}, {1, 0}, {0, 1}};
    else
        return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

template <class T>
T distance(std::complex<T> a, std::complex<T> b) {
    return std::abs(a - b);
}
template <class T>
T distance(const glm::vec<3, T>& a, const glm::vec<3, T>& b) {
    return glm::length(a - b);
}

/// How far apart two things that act carry points.
template <class P, class M, class N>
typename P::Scalar points_apart(const M& m, const N& n) {
    typename P::Scalar most{};
    for (const auto& v : points<P>()) most = std::max(most, distance(act(m, v), act(n, v)));
    return most;
}

/// Whether the greatest singular value is less than 30 times the least, and that is above a thirtieth.
template <class T>
bool well_conditioned(const Eigen::MatrixX<T>& x) {
    const Eigen::VectorX<T> squares =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixX<T>>(x.transpose() * x, Eigen::EigenvaluesOnly)
            .eigenvalues();
    return squares[0] * T(900) > std::max(T(1), squares[squares.size() - 1]);
}

template <class P>
struct RegressionTest : ::testing::Test {
    using Scalar = typename P::Scalar;
    static constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
    // Designs here have a condition below 30, entries within 1 and up to 24 rows, the numbers that they are
    // multiplied with are below 20: some 50 roundings of these.
    static constexpr Scalar rounding = 50 * 30 * 20 * epsilon / 2;

    struct Case {
        std::vector<Monomial> list;
        std::vector<Scalar> readings;
        Eigen::MatrixX<Scalar> x;
        std::vector<P> y;

        LogLinear<P> closed(Scalar lambda = 0) const { return fit_log_linear<P>(x, y, lambda); }
        BlendRegression<P> blended(Scalar lambda = 0) const { return fit_blend<P>(x, y, lambda); }
    };

    static std::vector<Scalar> any_reading() { return {Scalar(*real(-1, 1)), Scalar(*real(-1, 1))}; }

    /// Two readings, features of degree 1 or 2, `surplus` more observations than features.
    static Case any(int surplus, double turn = 1) {
        Case c{monomials(2, 1, *whole(1, 2)), {}, {}, {}};
        const std::size_t count = c.list.size() + std::size_t(surplus);
        for (std::size_t n = 0; n < count; ++n) {
            for (const Scalar value : any_reading()) c.readings.push_back(value);
            c.y.push_back(any_unit<P>(turn, 3));
        }
        c.x = design<Scalar>(c.list, c.readings, 2);
        RC_PRE(well_conditioned(c.x));
        return c;
    }
};

// Plane and space, float and double: each once, since nothing in the regressions is for one pair only.
using Systems = ::testing::Types<DualComplex<float>, DualQuaternion<double>>;
TYPED_TEST_SUITE(RegressionTest, Systems);

// ---- The closed form

TYPED_TEST(RegressionTest, RecoversTheCoefficientsThatMadeTheObservations) {
    using P = TypeParam;
    expect_always("y_n = exp(sum phi_k log b_k) gives back log b", [] {
        auto c = TestFixture::any(*whole(0, 10));
        LogLinear<P> truth;
        // Each turns by up to half a radian: five stay within the half angle of pi, which log can undo.
        for (std::size_t k = 0; k < c.list.size(); ++k) truth.log_b.push_back(log(any_unit<P>(0.5, 3)));
        for (std::size_t n = 0; n < c.y.size(); ++n)
            c.y[n] = predict<P>(
                truth, features<typename P::Scalar>(c.list, std::span(c.readings).subspan(2 * n, 2)));
        const auto found = c.closed();
        RC_ASSERT(found.log_b.size() == truth.log_b.size());
        for (std::size_t k = 0; k < found.log_b.size(); ++k)
            RC_ASSERT(length(found.log_b[k] + typename P::Scalar(-1) * truth.log_b[k]) <=
                      TestFixture::rounding);
    });
}

TYPED_TEST(RegressionTest, BlendsTheObservationsInTheLogarithm) {
    using P = TypeParam;
    using T = typename P::Scalar;
    expect_always("exp(phi log b) = exp(sum c_n log y_n), equation 7", [] {
        const auto c = TestFixture::any(*whole(0, 10));
        const T lambda = T(*whole(0, 1) * *real(0, 1));
        const auto phi = features<T>(c.list, TestFixture::any_reading());
        const auto blended = c.blended(lambda);
        const auto by_weights = log_linear<P>(blend_weights<P>(blended, phi), blended.observed);
        RC_ASSERT(points_apart<P>(predict<P>(c.closed(lambda), phi), by_weights) <=
                  20 * TestFixture::rounding);  // the weights are up to 30
    });
}

TYPED_TEST(RegressionTest, PassesThroughAsManyObservationsAsFeatures) {
    using P = TypeParam;
    using T = typename P::Scalar;
    expect_always("K = N, no l2 term: every method gives y_n at x_n", [] {
        const auto c = TestFixture::any(0, 2.5);
        const auto closed = c.closed();
        const auto blended = c.blended();
        for (std::size_t n = 0; n < c.y.size(); ++n) {
            const auto phi = features<T>(c.list, std::span(c.readings).subspan(2 * n, 2));
            RC_ASSERT(apart(predict<P>(closed, phi), c.y[n]) <= 4 * TestFixture::rounding);
            RC_ASSERT(apart(predict_dlb<P>(blended, phi).p, c.y[n]) <= 4 * TestFixture::rounding);
            RC_ASSERT(points_apart<P>(predict_matrix<P>(blended, phi), c.y[n]) <= 4 * TestFixture::rounding);
            const auto dib = predict_dib<P>(blended, phi, TestFixture::rounding);
            RC_ASSERT(dib.converged && apart(dib.p, c.y[n]) <= 8 * TestFixture::rounding);
        }
    });
}

TYPED_TEST(RegressionTest, IsTheIdentityAtTheReference) {
    using P = TypeParam;
    expect_always("phi = 0 gives 1, whatever was observed", [] {
        using T = typename P::Scalar;
        const auto c = TestFixture::any(*whole(0, 10));
        const std::vector<T> phi(c.list.size(), T(0));
        RC_ASSERT(predict<P>(c.closed(), phi) == P{});
        RC_ASSERT(predict_dlb<P>(c.blended(), phi).p == P{});
        RC_ASSERT(predict_dib<P>(c.blended(), phi, T(0)).p == P{});
        RC_ASSERT(points_apart<P>(predict_matrix<P>(c.blended(), phi), P{}) == T(0));
    });
}

TYPED_TEST(RegressionTest, LeavesTheReferenceNothingWhereAConstantIsAmongTheFeatures) {
    using P = TypeParam;
    using T = typename P::Scalar;
    expect_always("a constant feature and no l2 term: the weights of the observations sum to 1", [] {
        auto c = TestFixture::any(*whole(4, 10));
        c.list = monomials(2, 0, 1);
        c.x = design<T>(c.list, c.readings, 2);
        RC_PRE(well_conditioned(c.x));
        const auto phi = features<T>(c.list, TestFixture::any_reading());
        RC_ASSERT(std::abs(blend_weights<P>(c.blended(), phi).back()) <= TestFixture::rounding);
    });
}

// ---- The l2 term

TYPED_TEST(RegressionTest, ShrinksWithTheL2Term) {
    using P = TypeParam;
    using T = typename P::Scalar;
    expect_always("|log b| falls as lambda grows, to nothing", [] {
        const auto c = TestFixture::any(*whole(0, 10));
        const auto size = [&](T lambda) {
            T sum{};
            for (const auto& b : c.closed(lambda).log_b) sum += length(b) * length(b);
            return std::sqrt(sum);
        };
        const T lambda = T(*real(0, 10));
        RC_ASSERT(size(lambda + T(0.5)) < size(lambda));
        // (X^T X + lambda)^-1 X^T is within |X| / lambda, |X| within sqrt(15 x 5), the logarithms within 8
        // times sqrt(15).
        RC_ASSERT(size(T(1e6)) <= T(3e-4));
    });
}

TYPED_TEST(RegressionTest, SolvesTheNormalEquations) {
    using T = typename TypeParam::Scalar;
    expect_always("(X^T X + lambda I) S = X^T", [] {
        const auto c = TestFixture::any(*whole(0, 10));
        const T lambda = T(*whole(0, 1) * *real(0, 3));
        const Eigen::MatrixX<T> normal =
            c.x.transpose() * c.x + lambda * Eigen::MatrixX<T>::Identity(c.x.cols(), c.x.cols());
        const Eigen::MatrixX<T> error = normal * regularised_inverse(c.x, lambda) - c.x.transpose();
        RC_ASSERT(error.cwiseAbs().maxCoeff() <= TestFixture::rounding);
    });
}

// ---- What they do not depend on

// With g = y_ref this is also y y_ref^-1 in place of y_ref^-1 y.
TYPED_TEST(RegressionTest, DoesNotMindTheFrameNorTheSideOfTheReference) {
    using P = TypeParam;
    using T = typename P::Scalar;
    expect_always("observations g y g^-1 give predictions g p g^-1, by every method", [] {
        const auto c = TestFixture::any(*whole(0, 10), 0.5);
        auto moved = c;
        const P g = any_unit<P>(3, 3), back = inverse(g);
        for (P& y : moved.y) y = g * y * back;
        const auto phi = features<T>(c.list, TestFixture::any_reading());
        // Weights up to 30, distances through g 6 times as large.
        const T tolerance = 200 * TestFixture::rounding;
        RC_ASSERT(points_apart<P>(predict<P>(moved.closed(), phi), g * predict<P>(c.closed(), phi) * back) <=
                  tolerance);
        const auto dlb = predict_dlb<P>(c.blended(), phi);
        RC_PRE(!dlb.cancelled);
        // Where the sum is small against its terms, its direction is ill known.
        const auto weights = blend_weights<P>(c.blended(), phi);
        T total{};
        for (const T w : weights) total += std::abs(w);
        RC_PRE(total < T(5));
        RC_ASSERT(points_apart<P>(predict_dlb<P>(moved.blended(), phi).p, g * dlb.p * back) <= tolerance);
        const T precision = std::sqrt(TestFixture::epsilon) / 100;
        const auto dib = predict_dib<P>(c.blended(), phi, precision);
        const auto moved_dib = predict_dib<P>(moved.blended(), phi, precision);
        RC_PRE(dib.converged && moved_dib.converged);
        RC_ASSERT(points_apart<P>(moved_dib.p, g * dib.p * back) <= tolerance + 100 * precision);
        const auto matrix = to_matrix(g) * predict_matrix<P>(c.blended(), phi) * to_matrix(back);
        RC_ASSERT(points_apart<P>(predict_matrix<P>(moved.blended(), phi), matrix) <= tolerance);
    });
}

TYPED_TEST(RegressionTest, DoesNotMindTheUnitsOfTheFeatures) {
    using P = TypeParam;
    using T = typename P::Scalar;
    expect_always("features in other units: the same predictions, the same rank", [] {
        const auto c = TestFixture::any(*whole(0, 10));
        auto scaled = c;
        auto phi = features<T>(c.list, TestFixture::any_reading());
        const P before = predict<P>(c.closed(), phi);
        for (std::size_t k = 0; k < phi.size(); ++k) {
            const T unit = T(std::pow(10, *whole(-9, 9)));
            phi[k] *= unit;
            scaled.x.col(Eigen::Index(k)) *= unit;
        }
        RC_ASSERT(points_apart<P>(predict<P>(scaled.closed(), phi), before) <= 20 * TestFixture::rounding);
    });
}

TYPED_TEST(RegressionTest, IsRidgeRegressionComponentByComponent) {
    using P = TypeParam;
    using T = typename P::Scalar;
    expect_always("points: ridge regression of each coordinate; DLB: of each component, normalised", [] {
        const auto c = TestFixture::any(*whole(0, 10));
        const T lambda = T(*real(0, 1));
        const auto phi = features<T>(c.list, TestFixture::any_reading());
        const auto blended = c.blended(lambda);
        // By the normal equations, from the identity on.
        const Eigen::MatrixX<T> normal =
            c.x.transpose() * c.x + lambda * Eigen::MatrixX<T>::Identity(c.x.cols(), c.x.cols());
        const Eigen::VectorX<T> weights =
            c.x * normal.ldlt().solve(Eigen::Map<const Eigen::VectorX<T>>(phi.data(), c.x.cols()));
        P sum{};
        auto matrix = to_matrix(P{});
        for (std::size_t n = 0; n < c.y.size(); ++n) {
            const T w = weights[Eigen::Index(n)];
            sum = sum + w * (c.y[n] + -P{});
            matrix += (to_matrix(c.y[n]) - to_matrix(P{})) * w;
        }
        RC_ASSERT(points_apart<P>(predict_matrix<P>(blended, phi), matrix) <= 20 * TestFixture::rounding);
        RC_PRE(rotation_dot(sum, sum) > T(0.1));
        RC_ASSERT(points_apart<P>(predict_dlb<P>(blended, phi).p, normalised(sum)) <=
                  200 * TestFixture::rounding);
    });
}

// ---- What they refuse

template <class T>
Eigen::MatrixX<T> matrix(std::initializer_list<std::initializer_list<T>> rows) {
    return Eigen::MatrixX<T>(rows);
}

TEST(Regression, SaysWhatIsMissing) {
    try {
        const std::vector<DualComplex<double>> y(2);
        fit_log_linear<DualComplex<double>>(matrix<double>({{1, 2, 3}, {4, 5, 6}}), y, 0.0);
        FAIL() << "two observations do not determine three features";
    } catch (const RankDeficient& e) {
        EXPECT_STREQ(e.what(),
                     "The observations tell only 2 of the 3 features apart: take more or other observations, "
                     "fewer features, or a larger l2 term.");
    }
}

TYPED_TEST(RegressionTest, RefusesAnObservationAWholeTurnAway) {
    using P = TypeParam;
    using T = typename P::Scalar;
    const auto fit = [](T half) {
        Coordinates<P> x{};
        x[0] = half;
        x.back() = 1;
        return fit_log_linear<P>(matrix<T>({{1}}), std::vector{exp(from_coordinates(x))}, T(0));
    };
    constexpr T pi = std::numbers::pi_v<T>;
    // A thousandth of a radian is the threshold; float knows the cosine there to an eighth.
    EXPECT_THROW(fit(pi), std::invalid_argument);
    EXPECT_THROW(fit(pi - T(0.9e-3)), std::invalid_argument);
    EXPECT_THROW(fit(-pi + T(0.9e-3)), std::invalid_argument);
    EXPECT_NO_THROW(fit(pi - T(1.1e-3)));
    EXPECT_NO_THROW(fit(T(0)));
    EXPECT_THROW(fit(std::numeric_limits<T>::quiet_NaN()), std::invalid_argument);
}

TEST(Regression, SaysWhereDibDoesNotConverge) {
    // Twice what was seen at 170 degrees, less the reference: the logarithms' ends jump about.
    const auto y = rotation(170 * std::numbers::pi / 90, std::complex<double>(3));
    const auto model = fit_blend<DualComplex<double>>(matrix<double>({{1}}), std::vector{y}, 0.0);
    EXPECT_FALSE(predict_dib<DualComplex<double>>(model, std::vector{3.0}, 1e-9).converged);
    EXPECT_TRUE(predict_dib<DualComplex<double>>(model, std::vector{0.5}, 1e-9).converged);
}

// ---- Signs

TYPED_TEST(RegressionTest, PrincipalTurnsByAtMostHalfATurn) {
    using P = TypeParam;
    expect_always("p or -p, with a rotation on the reference's side", [] {
        const P p = any_unit<P>(3, 3);
        RC_ASSERT(principal(p) == p || principal(p) == -p);
        RC_ASSERT(principal(p) == principal(-p));
        RC_ASSERT(rotation_dot(principal(p), P{}) >= 0);
    });
}

TYPED_TEST(RegressionTest, CarriedSignsUnwrapTurnsBeyondHalfATurn) {
    using P = TypeParam;
    using T = typename P::Scalar;
    expect_always("a path whose signs were lost is a path again", [] {
        // Along one screw in steps of up to 85 degrees of the half angle, to up to 170.
        const P any = any_unit<P>(1, 1);
        const T turn = std::acos(rotation_dot(any, P{}));
        RC_PRE(turn > T(0.1));
        const int steps = *whole(2, 12);
        std::vector<P> y, lost;
        for (int n = 0; n <= steps; ++n) {
            y.push_back(exp((T(n) / T(steps) * T(170 * std::numbers::pi / 180) / turn) * log(any)));
            lost.push_back(*whole(0, 1) ? y.back() : -y.back());
        }
        carry_signs<P>(lost);
        RC_ASSERT(lost == y);
    });
}

// ---- Numbers worked by hand

TEST(Regression, GivesTheNumbersWorkedByHand) {
    using P = DualComplex<double>;
    // x = 1 turned the half angle to 0.1, x = 2 to 0.3: X^T X = 5, X^T log y = 0.7.
    const auto x = matrix<double>({{1}, {2}});
    const std::vector y{rotation(0.2, std::complex<double>(0)), rotation(0.6, std::complex<double>(0))};
    // A few roundings of numbers below 1.
    EXPECT_NEAR(fit_log_linear<P>(x, y, 0.0).log_b[0].h, 0.14, 1e-15);
    EXPECT_NEAR(fit_log_linear<P>(x, y, 2.0).log_b[0].h, 0.1, 1e-15);
    // At x = 2 the weights are 2/5, 4/5, and -1/5 of the reference.
    const auto blended = fit_blend<P>(x, y, 0.0);
    const auto weights = blend_weights<P>(blended, std::vector{2.0});
    EXPECT_NEAR(weights[0], 0.4, 1e-15);
    EXPECT_NEAR(weights[1], 0.8, 1e-15);
    EXPECT_NEAR(weights[2], -0.2, 1e-15);
    const double sine = 0.4 * std::sin(0.1) + 0.8 * std::sin(0.3);
    const double cosine = 0.4 * std::cos(0.1) + 0.8 * std::cos(0.3) - 0.2;
    EXPECT_NEAR(std::arg(predict_dlb<P>(blended, std::vector{2.0}).p.p0), std::atan2(sine, cosine), 1e-15);
    EXPECT_NEAR(std::arg(predict_dib<P>(blended, std::vector{2.0}, 1e-15).p.p0), 0.28, 1e-15);
    EXPECT_NEAR(act(predict_matrix<P>(blended, std::vector{2.0}), std::complex<double>(1)).imag(),
                0.4 * std::sin(0.2) + 0.8 * std::sin(0.6), 1e-15);
}

TEST(Regression, IsTheSameInThePlaneAsInSpace) {
    using Planar = DualComplex<double>;
    using Spatial = DualQuaternion<double>;
    using Fixture = RegressionTest<Planar>;
    expect_always("the regression of what is embedded is the regression, embedded", [] {
        const auto c = Fixture::any(*whole(0, 10));
        const double lambda = *whole(0, 1) * *real(0, 1);
        std::vector<Spatial> y;
        for (const Planar& p : c.y) y.push_back(embed(p));
        const auto phi = features<double>(c.list, Fixture::any_reading());
        const double tolerance = 200 * Fixture::rounding;  // weights up to 30
        RC_ASSERT(points_apart<Spatial>(predict<Spatial>(fit_log_linear<Spatial>(c.x, y, lambda), phi),
                                        embed(predict<Planar>(c.closed(lambda), phi))) <= tolerance);
        const auto planar = c.blended(lambda);
        const auto spatial = fit_blend<Spatial>(c.x, y, lambda);
        const auto dlb = predict_dlb<Planar>(planar, phi);
        RC_PRE(!dlb.cancelled);
        RC_ASSERT(points_apart<Spatial>(predict_dlb<Spatial>(spatial, phi).p, embed(dlb.p)) <= tolerance);
        const auto dib = predict_dib<Planar>(planar, phi, 1e-12);
        const auto dib_in_space = predict_dib<Spatial>(spatial, phi, 1e-12);
        RC_PRE(dib.converged);
        RC_ASSERT(dib_in_space.converged);
        RC_ASSERT(points_apart<Spatial>(dib_in_space.p, embed(dib.p)) <= tolerance);
        for (const auto& v : points<Planar>())
            RC_ASSERT(glm::length(act(predict_matrix<Spatial>(spatial, phi), embed(v)) -
                                  embed(act(predict_matrix<Planar>(planar, phi), v))) <= tolerance);
    });
}

}  // namespace
}  // namespace probewarp
