// What a regression starts from (the regression paper): polynomial features of the readings, and the least
// squares of their design with what they refuse.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "math/regression.h"

namespace probewarp {
namespace {

template <class T>
Eigen::MatrixX<T> matrix(std::initializer_list<std::initializer_list<T>> rows) {
    return Eigen::MatrixX<T>(rows);
}

// ---- Features

TEST(Features, ListTheMonomialsByDegree) {
    using List = std::vector<Monomial>;
    EXPECT_EQ(monomials(1, 1, 3), (List{{1}, {2}, {3}}));
    EXPECT_EQ(monomials(2, 1, 1), (List{{1, 0}, {0, 1}}));
    EXPECT_EQ(monomials(2, 1, 2), (List{{1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}));
    EXPECT_EQ(monomials(2, 0, 1), (List{{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_EQ(monomials(2, 3, 3), (List{{3, 0}, {2, 1}, {1, 2}, {0, 3}}));
    EXPECT_EQ(monomials(3, 2, 2), (List{{2, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 2, 0}, {0, 1, 1}, {0, 0, 2}}));
    EXPECT_EQ(monomials(3, 1, 3).size(), 19u);  // (3 + 3 over 3) - 1
    EXPECT_EQ(monomials(6, 0, 3).size(), 84u);  // (6 + 3 over 3)
}

TEST(Features, AreProductsOfPowers) {
    const auto list = monomials(2, 0, 3);
    const std::vector<double> expected{1, 2, -3, 4, -6, 9, 8, -12, 18, -27};
    EXPECT_EQ(features<double>(list, std::vector{2.0, -3.0}), expected);
    const auto x =
        design<double>(std::vector<Monomial>{{1, 0}, {0, 1}, {1, 1}}, std::vector{2.0, -3.0, 5.0, 7.0}, 2);
    EXPECT_EQ(x, matrix<double>({{2, -3, -6}, {5, 7, 35}}));
}

// ---- Least squares

template <class T>
std::pair<int, int> rank_reported(const Eigen::MatrixX<T>& x) {
    try {
        regularised_inverse(x, T(0));
        return {int(x.cols()), int(x.cols())};
    } catch (const RankDeficient& e) {
        return {int(e.rank), int(e.feature_count)};
    }
}

template <class T>
struct RegularisedInverse : ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(RegularisedInverse, Scalars);

TYPED_TEST(RegularisedInverse, ReportsTheRank) {
    using T = TypeParam;
    using Rank = std::pair<int, int>;
    EXPECT_EQ(rank_reported<T>(matrix<T>({{1, 2}, {3, 4}})), Rank(2, 2));
    EXPECT_EQ(rank_reported<T>(matrix<T>({{1, 2}, {2, 4}, {3, 6}})), Rank(1, 2));  // one reading, doubled
    EXPECT_EQ(rank_reported<T>(matrix<T>({{1, 0}, {2, 0}})), Rank(1, 2));          // one never moved
    EXPECT_EQ(rank_reported<T>(matrix<T>({{0, 1}, {0, 2}})), Rank(1, 2));          // or the first never
    EXPECT_EQ(rank_reported<T>(matrix<T>({{0, 0}, {0, 0}})), Rank(0, 2));          // only the reference
    EXPECT_EQ(rank_reported<T>(matrix<T>({{1, 2, 3}, {4, 5, 6}})), Rank(2, 3));    // too few observations
    EXPECT_EQ(rank_reported<T>(Eigen::MatrixX<T>(0, 3)), Rank(0, 3));              // none at all
    // x1 + x2 = x3, but for rounding.
    EXPECT_EQ(
        rank_reported<T>(matrix<T>(
            {{T(.1), T(.2), T(.3)}, {T(.7), T(.1), T(.8)}, {T(.6), T(.3), T(.9)}, {T(.2), T(.5), T(.7)}})),
        Rank(2, 3));
    // The same readings twice over are no more than once.
    EXPECT_EQ(rank_reported<T>(matrix<T>({{1, 2, 3}, {4, 5, 6}, {1, 2, 3}, {4, 5, 6}})), Rank(2, 3));
}

TYPED_TEST(RegularisedInverse, CallsWhatIsWithinRoundingDependentAndNotMore) {
    using T = TypeParam;
    // Two columns of length 1 whose part at right angles to each other is about d; with 3 rows and 2 columns
    // the threshold is 40 epsilon.
    const auto rank = [](T d) { return rank_reported<T>(matrix<T>({{1, 1}, {0, d}, {0, 0}})).first; };
    EXPECT_EQ(rank(20 * std::numeric_limits<T>::epsilon()), 1);
    EXPECT_EQ(rank(80 * std::numeric_limits<T>::epsilon()), 2);
}

TYPED_TEST(RegularisedInverse, TakesFeaturesWhoseSquaresAreNoNumbers) {
    using T = TypeParam;
    const T large = std::sqrt(std::numeric_limits<T>::max()) * T(8);
    const T small = std::sqrt(std::numeric_limits<T>::min()) / T(8);
    const auto inverse = regularised_inverse(matrix<T>({{large, 0}, {0, small}}), T(0));
    // A dozen roundings.
    EXPECT_NEAR(inverse(0, 0) * large, 1, 12 * std::numeric_limits<T>::epsilon());
    EXPECT_NEAR(inverse(1, 1) * small, 1, 12 * std::numeric_limits<T>::epsilon());
}

TYPED_TEST(RegularisedInverse, TakesAnythingWithAnL2Term) {
    using T = TypeParam;
    // x = (1, 1; 1, 1), lambda = 2: (X^T X + 2)^-1 = (4, -2; -2, 4) / 12, times X^T 1/6 everywhere.
    const auto inverse = regularised_inverse(matrix<T>({{1, 1}, {1, 1}}), T(2));
    const T sixth = T(1) / T(6);
    // A dozen roundings of numbers up to 1.
    EXPECT_LE((inverse.array() - sixth).abs().maxCoeff(), 12 * std::numeric_limits<T>::epsilon());
    // Nothing observed: no weights.
    EXPECT_EQ(regularised_inverse(Eigen::MatrixX<T>(0, 3), T(1)).size(), 0);
    // A feature that was never seen to change does nothing.
    const auto unseen = regularised_inverse(matrix<T>({{1, 0}, {2, 0}}), T(1));
    EXPECT_EQ(unseen(1, 0), T(0));
    EXPECT_EQ(unseen(1, 1), T(0));
}

template <class T>
std::string refusal(const Eigen::MatrixX<T>& x, T lambda) {
    try {
        regularised_inverse(x, lambda);
        return "none";
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
}

TYPED_TEST(RegularisedInverse, SaysWhatIsNoNumber) {
    using T = TypeParam;
    const T nan = std::numeric_limits<T>::quiet_NaN(), infinity = std::numeric_limits<T>::infinity();
    const auto good = matrix<T>({{1, 2}, {3, 4}});
    EXPECT_EQ(refusal(good, T(0)), "none");
    for (const T lambda : {T(-1), nan, infinity})
        EXPECT_EQ(refusal(good, lambda), "The l2 term must be a finite number of at least 0.") << lambda;
    for (const T value : {nan, infinity, -infinity})
        EXPECT_EQ(refusal(matrix<T>({{1, 2}, {value, 4}}), T(1)),
                  "A feature of an observation is not a finite number.")
            << value;
    EXPECT_EQ(refusal(Eigen::MatrixX<T>(3, 0), T(0)), "A regression needs at least one feature.");
}

}  // namespace
}  // namespace probewarp
