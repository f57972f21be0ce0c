// Motions of the plane that remember their turns, and the functions of an angle that they need, over float
// and double.
#include "math/motion.h"

#include "generators.h"

namespace probewarp {
namespace {

using testing::angle;
using testing::difference;
using testing::expect_always;
using testing::magnitude;
using testing::point;
using testing::real;
using testing::unit_dcn;

constexpr double pi = std::numbers::pi;
constexpr double size = 10;  // of the points

template <class T>
struct MotionTest : ::testing::Test {
    static constexpr T epsilon = std::numeric_limits<T>::epsilon();
    // A dozen roundings of numbers up to 60; an angle of three turns is rounded by 10 epsilon and turns
    // points that are up to 30 away.
    static constexpr T rounding = 12 * 60 * epsilon / 2 + 10 * 30 * epsilon;
    static Motion<T> any(double turns = 3) {
        return motion(T(*angle(turns)), *point<T>(size), *point<T>(size));
    }
};

using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(MotionTest, Scalars);

TYPED_TEST(MotionTest, LeftJacobianIsWhatShiftsUnderAConstantTurn) {
    expect_always("i x V(x) = e^{ix} - 1, V(-x) = conj V(x), V(0) = 1; relatively near 0", [] {
        using T = TypeParam;
        const T x = T(*rc::gen::oneOf(real(-20, 20), magnitude(-10, 0)));
        const std::complex<double> exact = std::polar(1.0, double(x) / 2) * 2.0 * std::sin(double(x) / 2);
        // i x V(x) = i e^{ix/2} 2 sin(x/2), worked out in double; three roundings, and of x/2 = 10 by 4
        // epsilon.
        const std::complex<double> got = double(x) * std::complex<double>(left_jacobian(x));
        RC_ASSERT(std::abs(got - exact) <= 8 * TestFixture::epsilon * std::min(2.0, std::abs(double(x))));
        RC_ASSERT(left_jacobian(-x) == std::conj(left_jacobian(x)));
    });
    EXPECT_EQ(left_jacobian(TypeParam(0)), std::complex<TypeParam>(1));
    // At half a turn: (e^{i pi} - 1)/(i pi) = 2i/pi. At a whole turn: nothing, but for the rounding of pi.
    EXPECT_LE(std::abs(left_jacobian(TypeParam(pi)) - std::complex<TypeParam>(0, TypeParam(2 / pi))),
              2 * this->epsilon);
    EXPECT_LE(std::abs(left_jacobian(TypeParam(2 * pi))), this->epsilon);
}

TYPED_TEST(MotionTest, TurnLessOneIsRelativelyExactNearZero) {
    expect_always("e^{ix} - 1", [] {
        using T = TypeParam;
        const T x = T(*rc::gen::oneOf(real(-20, 20), magnitude(-10, 0)));
        const std::complex<double> exact =
            std::complex<double>(0, 2 * std::sin(double(x) / 2)) * std::polar(1.0, double(x) / 2);
        RC_ASSERT(std::abs(std::complex<double>(turn_less_one(x)) - exact) <=
                  8 * TestFixture::epsilon * std::min(2.0, std::abs(double(x))));
        // ... and it is that: to roundings of 1.
        RC_ASSERT(std::abs(exact + 1.0 - std::polar(1.0, double(x))) <= 1e-15);
    });
    EXPECT_EQ(turn_less_one(TypeParam(0)), std::complex<TypeParam>(0));
}

TYPED_TEST(MotionTest, TurnsAboutItsRestAndCarriesItToWhereItIsNow) {
    expect_always("v -> e^{it}(v - rest) + now, by the similarity and by the DCN alike", [] {
        using T = TypeParam;
        const auto m = TestFixture::any();
        const auto v = *point<T>(size);
        const std::complex<T> expected = std::polar(T(1), m.angle) * (v - m.rest) + m.now;
        RC_ASSERT(difference(act(similarity(m), v), expected) <= TestFixture::rounding);
        RC_ASSERT(difference(act(m.p, v), expected) <= TestFixture::rounding);
        RC_ASSERT(difference(act(similarity(m), m.rest), m.now) <= TestFixture::rounding);
        RC_ASSERT(!similarity(m).cancelled);
    });
}

TYPED_TEST(MotionTest, RemembersItsTurns) {
    expect_always("p0 = e^{i angle/2}: after a whole turn more, -p", [] {
        using T = TypeParam;
        const auto m = TestFixture::any(1);
        const auto more = motion(T(m.angle + T(2 * pi)), m.rest, m.now);
        RC_ASSERT(std::abs(m.p.p0 - std::polar(T(1), m.angle / 2)) <= 2 * TestFixture::epsilon);
        RC_ASSERT(difference(more.p, -m.p) <= TestFixture::rounding);
        RC_ASSERT(more.angle != m.angle);
    });
}

TYPED_TEST(MotionTest, SimilarityOfAUnitActsAsIt) {
    expect_always("(p0^2 - 1) v + 2 p0 p1 + v = p <> v", [] {
        using T = TypeParam;
        const auto p = *unit_dcn<T>(size);
        const auto v = *point<T>(size);
        RC_ASSERT(difference(act(similarity(p), v), act(p, v)) <= TestFixture::rounding);
        RC_ASSERT(similarity(p).less_one == similarity(-p).less_one);
    });
}

TYPED_TEST(MotionTest, WhatDoesNotMoveIsExactlyZero) {
    expect_always("angle 0: less_one is 0; now = rest besides: so is the shift, and any point stays", [] {
        using T = TypeParam;
        const auto rest = std::complex<T>(T(*magnitude(-3, 7)), T(*magnitude(-3, 7)));
        const auto still = motion(T(0), rest, rest),
                   shifted = motion(T(0), rest, rest + std::complex<T>(1, 2));
        RC_ASSERT(still.less_one == std::complex<T>(0));
        RC_ASSERT(still.shift == std::complex<T>(0));
        RC_ASSERT(still.p == DualComplex<T>{});
        RC_ASSERT(shifted.less_one == std::complex<T>(0));
        RC_ASSERT(shifted.shift == shifted.now - shifted.rest);
        const auto v = *point<T>(1e7);
        RC_ASSERT(act(similarity(still), v) == v);
        RC_ASSERT(similarity(DualComplex<T>{}).less_one == std::complex<T>(0));
    });
}

TEST(Motion, ByHand) {
    // A quarter turn about 2 + i, which goes to 5 + 5i: v -> i (v - 2 - i) + 5 + 5i = i v + 6 + 3i.
    const auto m = motion(pi / 2, std::complex<double>(2, 1), std::complex<double>(5, 5));
    // A few roundings of numbers up to 6.
    EXPECT_LT(std::abs(m.less_one - std::complex<double>(-1, 1)), 1e-15);
    EXPECT_LT(std::abs(m.shift - std::complex<double>(6, 3)), 4e-15);
    EXPECT_LT(std::abs(act(similarity(m), std::complex<double>(3, 1)) - std::complex<double>(5, 6)), 4e-15);
}

}  // namespace
}  // namespace probewarp
