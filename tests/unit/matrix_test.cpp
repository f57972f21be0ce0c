// The matrices of rigid transformations, to and from, and the blends by matrices that the papers compare with
// (MKO, arXiv 1601.01754, section 6; Kavan et al., TCD-CS-2006-46, section 2), over float and double.
#include "math/matrix.h"

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

#include "generators.h"
#include "math/matrix_blend.h"

namespace probewarp {
namespace {

using testing::any_log;
using testing::any_unit;
using testing::any_vector;
using testing::difference;
using testing::difference_of_motions;
using testing::expect_always;
using testing::point;
using testing::real;
using testing::unit_dcn;
using testing::whole;

constexpr double pi = std::numbers::pi;
constexpr double size = 10;  // of the shifts

template <class T>
T difference(const ComplexMatrix<T>& m, const ComplexMatrix<T>& n) {
    return std::max({std::abs(m.a - n.a), std::abs(m.b - n.b), std::abs(m.c - n.c), std::abs(m.d - n.d)});
}

template <glm::length_t N, class T>
T difference(const glm::mat<N, N, T>& m, const glm::mat<N, N, T>& n) {
    T most{};
    for (glm::length_t i = 0; i < N; ++i)
        for (glm::length_t j = 0; j < N; ++j) most = std::max(most, std::abs(m[i][j] - n[i][j]));
    return most;
}

/// From the matrix, whichever type it is of.
template <class T>
DualComplex<T> from_matrix(const glm::mat<3, 3, T>& m) {
    return to_dual_complex(m);
}
template <class T>
DualQuaternion<T> from_matrix(const glm::mat<4, 4, T>& m) {
    return to_dual_quaternion(m);
}

template <class P>
struct MatrixTest : ::testing::Test {
    using Scalar = typename P::Scalar;
    static constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
    // Two transformations of shifts up to 35 and a point: some twenty roundings of numbers of up to 90.
    static constexpr Scalar rounding = 20 * 90 * epsilon;
};

TYPED_TEST_SUITE(MatrixTest, testing::Transformations);

TYPED_TEST(MatrixTest, IsAHomomorphismThatCommutesWithTheAction) {
    expect_always("M(pq) = M(p) M(q), M(p) v = p <> v, M(-p) = M(p), M(1) = 1", [] {
        const auto p = any_unit<TypeParam>(size), q = any_unit<TypeParam>(size);
        const auto v = testing::any_point<TypeParam>(size);
        RC_ASSERT(difference(to_matrix(p * q), to_matrix(p) * to_matrix(q)) <= TestFixture::rounding);
        RC_ASSERT(difference(act(to_matrix(p), v), act(p, v)) <= TestFixture::rounding);
        RC_ASSERT(to_matrix(-p) == to_matrix(p));
        RC_ASSERT(to_matrix(TypeParam{}) == decltype(to_matrix(p))(1));
        RC_ASSERT(difference(to_matrix(inverse(p)) * to_matrix(p), to_matrix(TypeParam{})) <=
                  TestFixture::rounding);
    });
}

TYPED_TEST(MatrixTest, GoesThereAndBackUpToSign) {
    expect_always("p(M(p)) = p or -p, the one that turns by at most half a turn", [] {
        const auto p = any_unit<TypeParam>(size);
        const auto back = from_matrix(to_matrix(p));
        RC_ASSERT(difference_of_motions(back, p) <= TestFixture::rounding);
        RC_ASSERT(rotation_dot(back, TypeParam{}) >= -4 * TestFixture::epsilon);  // cos of a rounded pi/2
        RC_ASSERT(difference(to_matrix(back), to_matrix(p)) <= TestFixture::rounding);
    });
}

template <class T>
struct MatrixByHandTest : ::testing::Test {
    static constexpr T epsilon = std::numeric_limits<T>::epsilon();
};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(MatrixByHandTest, Scalars);

TYPED_TEST(MatrixByHandTest, MatricesByHand) {
    using T = TypeParam;
    const T tolerance = 8 * this->epsilon;  // a few roundings of numbers up to 3
    // The quarter turn about 0, then the shift by 2 + 3i: x' = -y + 2, y' = x + 3.
    const auto p = translation(std::complex<T>(2, 3)) * rotation(T(pi / 2), std::complex<T>(0));
    const glm::mat<3, 3, T> plane(0, 1, 0, -1, 0, 0, 2, 3, 1);  // column by column
    EXPECT_LE(difference(to_matrix(p), plane), tolerance);
    EXPECT_LE(difference(act(plane, std::complex<T>(10, 20)), std::complex<T>(-18, 13)), tolerance);
    EXPECT_LE(difference(to_dual_complex(plane), p), tolerance);
    // About z, then the shift by (2, 3, 4).
    const auto q = translation(glm::vec<3, T>(2, 3, 4)) * rotation(T(pi / 2), glm::vec<3, T>(0, 0, 1));
    const glm::mat<4, 4, T> space(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 2, 3, 4, 1);
    EXPECT_LE(difference(to_matrix(q), space), tolerance);
    EXPECT_EQ(act(space, glm::vec<3, T>(10, 20, 30)), (glm::vec<3, T>(-18, 13, 34)));
    EXPECT_LE(difference(to_dual_quaternion(space), q), tolerance);
    // Beyond half a turn the other sign comes back: 270 degrees are -90.
    const auto three_quarters = rotation(T(3 * pi / 2), std::complex<T>(5, 1));
    EXPECT_LE(difference(to_dual_complex(to_matrix(three_quarters)), -three_quarters), 6 * tolerance);
    EXPECT_LE(difference(to_dual_quaternion(to_matrix(embed(three_quarters))), -embed(three_quarters)),
              6 * tolerance);
    const DualComplex<T> any{{1, 2}, {3, 4}};
    EXPECT_EQ(difference(to_complex_matrix(any), {{1, 2}, {3, 4}, {0, 0}, {1, -2}}), T(0));
}

TYPED_TEST(MatrixByHandTest, ComplexMatrixIsTheRing) {
    expect_always("[p0 p1; 0 ~p0] keeps products and the action, there and back, of any DCN", [] {
        using T = TypeParam;
        const DualComplex<T> p{*point<T>(3), *point<T>(size)}, q{*point<T>(3), *point<T>(size)};
        const auto product = to_complex_matrix(p) * to_complex_matrix(q);
        const T rounding = 8 * 60 * TestFixture::epsilon;  // a few roundings of numbers up to 60
        RC_ASSERT(difference(to_complex_matrix(p * q), product) <= rounding);
        RC_ASSERT(difference(to_dual_complex(product), p * q) <= rounding);
        RC_ASSERT(to_dual_complex(to_complex_matrix(p)) == p);
        const auto u = *unit_dcn<T>(size);
        const auto v = *point<T>(size);
        RC_ASSERT(difference(act(to_complex_matrix(u), v), act(u, v)) <= rounding);
        // Twice the Moebius transformation of half the point.
        const auto m = to_complex_matrix(u);
        const std::complex<T> w = v / T(2);
        RC_ASSERT(difference(T(2) * ((m.a * w + m.b) / (m.c * w + m.d)), act(u, v)) <= rounding);
        // A product of any two, not only of such: against one worked by hand below.
        const ComplexMatrix<T> a{{1, 1}, {2, 0}, {0, 1}, {3, 0}}, b{{0, 2}, {1, 0}, {1, -1}, {2, 0}};
        RC_ASSERT(difference(a * b, {{0, 0}, {5, 1}, {1, -3}, {6, 1}}) == T(0));
    });
}

TYPED_TEST(MatrixByHandTest, SpaceHasThePlanesMatrixAmongItsOwn) {
    expect_always("the matrix of embed(p) is that of p in y and z, and leaves x", [] {
        using T = TypeParam;
        const auto p = *unit_dcn<T>(size);
        const auto plane = to_matrix(p);
        const auto space = to_matrix(embed(p));
        glm::mat<4, 4, T> expected(1);
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) expected[i + 1][j + 1] = plane[i][j];
        for (int j = 0; j < 2; ++j) expected[3][j + 1] = plane[2][j];
        RC_ASSERT(difference(space, expected) <= 8 * 30 * TestFixture::epsilon);  // a few roundings up to 30
    });
}

// ---- Blends by matrices.

template <class P>
struct MatrixBlendTest : MatrixTest<P> {
    using Scalar = typename P::Scalar;
    std::vector<Scalar> weights;
    std::vector<P> all;

    /// Weights that sum to 1; turns of at most `turn` either way from none.
    void draw(double turn) {
        weights.clear(), all.clear();
        const int count = *whole(1, 5);
        Scalar total{};
        for (int i = 0; i < count; ++i) {
            weights.push_back(Scalar(*real(0.01, 1)));
            all.push_back(exp(any_log<P>(Scalar(*real(-turn / 2, turn / 2)), size)));
            if (*whole(0, 1)) all.back() = -all.back();
            total += weights.back();
        }
        for (auto& w : weights) w /= total;
    }
};
TYPED_TEST_SUITE(MatrixBlendTest, testing::Transformations);

TYPED_TEST(MatrixBlendTest, LinearIsTheMeanOfWhereThePointsGo) {
    expect_always("(sum w_i M_i) v = sum w_i p_i <> v, whatever the signs", [this] {
        this->draw(2 * pi);
        const auto v = testing::any_point<TypeParam>(size);
        auto mean = act(this->all[0], v) * this->weights[0];
        for (std::size_t i = 1; i < this->all.size(); ++i) mean += act(this->all[i], v) * this->weights[i];
        const auto blend = linear_matrix_blend<TypeParam>(this->weights, this->all);
        RC_ASSERT(difference(act(blend, v), mean) <= TestFixture::rounding);
    });
}

/// GLM's matrix as Eigen's.
template <glm::length_t N, class T>
Eigen::Matrix<double, N, N> eigen(const glm::mat<N, N, T>& m) {
    Eigen::Matrix<double, N, N> result;
    for (glm::length_t i = 0; i < N; ++i)
        for (glm::length_t j = 0; j < N; ++j) result(j, i) = double(m[i][j]);
    return result;
}

TYPED_TEST(MatrixBlendTest, LogMatrixBlendIsThatOfMatricesGenericExpAndLog) {
    expect_always("exp(sum w_i log M_i) by Eigen's own, which know nothing of rotations", [this] {
        this->draw(0.9 * pi);  // at half a turn the matrix has no principal logarithm
        const auto got = eigen(log_matrix_blend<TypeParam>(this->weights, this->all));
        typename std::remove_const_t<decltype(got)> sum = 0 * got;
        for (std::size_t i = 0; i < this->all.size(); ++i)
            sum += double(this->weights[i]) * eigen(to_matrix(this->all[i])).log();
        const typename std::remove_const_t<decltype(got)> expected = sum.exp();
        // Eigen's logarithm is good to a hundred roundings or so of shifts of up to 35, ours to
        // TestFixture's.
        RC_ASSERT((got - expected).cwiseAbs().maxCoeff() <= 2 * double(TestFixture::rounding));
    });
}

TYPED_TEST(MatrixBlendTest, DecompositionTurnsAsDlbAndShiftsLinearly) {
    expect_always("0 goes to the mean of where it goes; the rest turns as DLB, shortest way", [this] {
        this->draw(2 * pi);
        const auto middle = pivot<typename TypeParam::Scalar>(this->weights, this->all);
        for (const auto& x : this->all) RC_PRE(std::abs(rotation_dot(x, middle)) > 0.01f);
        const auto blend = decomposition_blend<TypeParam>(this->weights, this->all);
        using Point = typename TypeParam::Point;
        const Point origin{}, v = testing::any_point<TypeParam>(size);
        auto mean = act(this->all[0], origin) * this->weights[0];
        for (std::size_t i = 1; i < this->all.size(); ++i)
            mean += act(this->all[i], origin) * this->weights[i];
        RC_ASSERT(difference(act(blend, origin), mean) <= TestFixture::rounding);
        const auto turn = dlb_shortest<TypeParam>(this->weights, this->all).p;
        const Point turned = act(turn, v) - act(turn, origin);
        // DLB's shift, of which the difference is free, is up to 35 divided by the share of the sum, 1/4 or
        // more.
        RC_ASSERT(difference(Point(act(blend, v) - act(blend, origin)), turned) <= 4 * TestFixture::rounding);
        constexpr int last = decltype(blend)::length() - 1;
        RC_ASSERT(std::abs(blend[last][last] - 1) <= 8 * TestFixture::epsilon);
    });
}

TYPED_TEST(MatrixBlendTest, LogMatrixBlendTakesTheAngleWithinHalfATurn) {
    // Of none and 270 degrees, which are -90: -45 halfway. Linear: halfway between 1 and -i, shrunk.
    using P = TypeParam;
    using T = typename P::Scalar;
    const auto turn = [](double degrees) { return testing::turn_in_plane<P>(degrees); };
    const std::vector<T> halves{T(0.5), T(0.5)};
    const std::vector<P> p{P{}, turn(270)};
    const T tolerance = 8 * this->epsilon;  // a few roundings of numbers up to 1
    EXPECT_LE(difference(log_matrix_blend<P>(halves, p), to_matrix(turn(-45))), tolerance);
    EXPECT_LE(difference(decomposition_blend<P>(halves, p), to_matrix(turn(-45))), tolerance);
    const auto linear = linear_matrix_blend<P>(halves, p);
    const auto shrunk = testing::in_plane<P> ? linear[0][0] : linear[1][1];
    EXPECT_NEAR(shrunk, 0.5, tolerance);
}

}  // namespace
}  // namespace probewarp
