// What is dual quaternions' own (Kavan et al., TCD-CS-2006-46, here "Kavan"), over float and double: products
// and conjugates, the dual norm, screws, and the plane inside them (MKO, arXiv 1601.01754, section 4). The
// laws they share with the plane are in transformation_test.cpp.
#include "math/dual_quaternion.h"

#include "generators.h"

namespace probewarp {
namespace {

using testing::any_axis;
using testing::any_log;
using testing::any_vector;
using testing::difference;
using testing::expect_always;
using testing::magnitude;
using testing::point;
using testing::real;
using testing::unit_dcn;

constexpr double pi = std::numbers::pi;
constexpr double size = 10;  // of the shifts in the laws

template <class T>
struct DualQuaternionTest : ::testing::Test {
    using Element = DualQuaternion<T>;
    static constexpr T epsilon = std::numeric_limits<T>::epsilon();
    // Some twenty operations on numbers of up to 90, as in transformation_test.cpp.
    static constexpr T rounding = 20 * 90 * epsilon / 2;

    static bool near(const Element& p, const Element& q, T tolerance = rounding) {
        return difference(p, q) <= tolerance;
    }
    static Element unit() { return testing::any_unit<Element>(size); }
    static Quaternion<T> any_quaternion() { return quaternion(T(*real(-3, 3)), any_vector<T>(3)); }
    /// Not a unit: any eight numbers, q0 not near 0.
    static Element any() {
        const Element q{any_quaternion(), any_quaternion()};
        RC_PRE(inner(q.q0, q.q0) > T(0.1));
        return q;
    }
};

using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DualQuaternionTest, Scalars);

TYPED_TEST(DualQuaternionTest, ProductByHand) {
    using T = TypeParam;
    using D = DualQuaternion<T>;
    const Quaternion<T> none(0, 0, 0, 0);
    const D i{{0, 1, 0, 0}, none}, j{{0, 0, 1, 0}, none}, k{{0, 0, 0, 1}, none}, e{none, {1, 0, 0, 0}};
    EXPECT_EQ(i * j, k);
    EXPECT_EQ(j * k, i);
    EXPECT_EQ(k * i, j);
    EXPECT_EQ(j * i, -k);
    EXPECT_EQ(i * i, -D{});
    // e commutes, which it does not with DCN, and e e = 0.
    EXPECT_EQ(e * i, i * e);
    EXPECT_EQ(e * i, (D{none, {0, 1, 0, 0}}));
    EXPECT_EQ(e * e, (D{none, none}));
    // (1 + 2i + (3 + j) e)(2 - k + (1 + i) e): p0 q0 = (1 + 2i)(2 - k) = 2 + 4i + 2j - k, for i k = -j;
    // p0 qe + pe q0 = (1 + 2i)(1 + i) + (3 + j)(2 - k) = (-1 + 3i) + (6 - i + 2j - 3k), for j k = i.
    const D p{{1, 2, 0, 0}, {3, 0, 1, 0}}, q{{2, 0, 0, -1}, {1, 1, 0, 0}};
    EXPECT_EQ(p * q, (D{{2, 4, 2, -1}, {5, 2, 2, -3}}));
}

TYPED_TEST(DualQuaternionTest, ThreeConjugates) {
    expect_always("~(pq) = ~q ~p; the dual numbers' (pq)' = p' q'; and so both: ~(pq)' = ~q' ~p'", [] {
        const auto p = TestFixture::any(), q = TestFixture::any();
        RC_ASSERT(TestFixture::near(conj(p * q), conj(q) * conj(p)));
        RC_ASSERT(TestFixture::near(dual_conj(p * q), dual_conj(p) * dual_conj(q)));
        RC_ASSERT(conj(dual_conj(p)) == dual_conj(conj(p)));
        RC_ASSERT(TestFixture::near(conj(dual_conj(p * q)), conj(dual_conj(q)) * conj(dual_conj(p))));
        RC_ASSERT(conj(conj(p)) == p);
        RC_ASSERT(dual_conj(dual_conj(p)) == p);
    });
}

TYPED_TEST(DualQuaternionTest, ConjugatesByHand) {
    using D = DualQuaternion<TypeParam>;
    const D q{{1, 2, 3, 4}, {5, 6, 7, 8}};
    EXPECT_EQ(conj(q), (D{{1, -2, -3, -4}, {5, -6, -7, -8}}));
    EXPECT_EQ(dual_conj(q), (D{{1, 2, 3, 4}, {-5, -6, -7, -8}}));
    EXPECT_EQ(rotation_dot(q, D{{2, 1, 0, -1}, {9, 9, 9, 9}}), TypeParam(0));
    // |q|^2 = 30 + 2 * 70 e, and so |q| = sqrt 30 + 70 / sqrt 30 e.
    EXPECT_NEAR(norm(q).real, std::sqrt(30), 10 * this->epsilon);       // a rounding or two of 5.5
    EXPECT_NEAR(norm(q).dual, 70 / std::sqrt(30), 30 * this->epsilon);  // ... and of 12.8
}

TYPED_TEST(DualQuaternionTest, NormIsADualNumberAndMultiplies) {
    expect_always("q ~q = |q|^2, |pq| = |p| |q|, and a unit's is 1", [] {
        using T = TypeParam;
        const auto p = TestFixture::any(), q = TestFixture::any();
        const Dual<T> square = norm(q) * norm(q), both = norm(p) * norm(q);
        const auto product = q * conj(q);
        // As numbers of up to 2 * 36 and, for both, 2 * 36^2 / 0.3 divided by the least |q0|.
        RC_ASSERT(TestFixture::near(product, square * DualQuaternion<T>{}, 8 * 72 * TestFixture::epsilon));
        RC_ASSERT(std::abs(norm(p * q).real - both.real) <= 8 * 36 * TestFixture::epsilon);
        RC_ASSERT(std::abs(norm(p * q).dual - both.dual) <= 8 * 36 * 72 * 10 * TestFixture::epsilon);
        const Dual<T> one = norm(TestFixture::unit());
        RC_ASSERT(std::abs(one.real - 1) <= 8 * TestFixture::epsilon);
        RC_ASSERT(std::abs(one.dual) <= TestFixture::rounding);
    });
}

TYPED_TEST(DualQuaternionTest, NormalisingMakesAUnitAndUndoesADualFactor) {
    expect_always("|q / |q|| = 1 with q0 and qe at right angles; normalised((a + b e) p) = p", [] {
        using T = TypeParam;
        const auto q = normalised(TestFixture::any()), p = TestFixture::unit();
        // qe is up to 6 / 0.3; a dozen roundings.
        RC_ASSERT(std::abs(inner(q.q0, q.q0) - 1) <= 12 * TestFixture::epsilon);
        RC_ASSERT(std::abs(inner(q.q0, q.qe)) <= 12 * 20 * TestFixture::epsilon);
        const Dual<T> factor{T(*real(0.1, 10)), T(*real(-10, 10))};
        // The factor's inverse has a dual part of up to 10 / 0.01 and meets a p of up to 10.
        RC_ASSERT(TestFixture::near(normalised(factor * p), p, 4 * 1000 * TestFixture::epsilon));
        RC_ASSERT(TestFixture::near((factor * p) * q, factor * (p * q), 10 * TestFixture::rounding));
    });
}

TYPED_TEST(DualQuaternionTest, ActsAsTheProductWithTheThirdConjugate) {
    expect_always("1 + (q <> v) e = q (1 + v e) ~q'", [] {
        using T = TypeParam;
        const auto q = TestFixture::unit();
        const auto v = any_vector<T>(size);
        const DualQuaternion<T> point{{1, 0, 0, 0}, quaternion(T(0), v)};
        const auto product = q * point * conj(dual_conj(q));
        const DualQuaternion<T> acted{{1, 0, 0, 0}, quaternion(T(0), act(q, v))};
        RC_ASSERT(TestFixture::near(product, acted));
    });
}

TYPED_TEST(DualQuaternionTest, ActsByHand) {
    using T = TypeParam;
    using V = glm::vec<3, T>;
    const T tolerance = 8 * this->epsilon;  // a few roundings of numbers up to 5
    // A quarter turn about z takes x to y, y to -x; about x, y to z; about y, z to x. Right-handed.
    EXPECT_LE(difference(act(rotation(T(pi / 2), V(0, 0, 1)), V(2, 1, 5)), V(-1, 2, 5)), tolerance);
    EXPECT_LE(difference(act(rotation(T(pi / 2), V(1, 0, 0)), V(5, 2, 1)), V(5, -1, 2)), tolerance);
    EXPECT_LE(difference(act(rotation(T(pi / 2), V(0, 1, 0)), V(1, 5, 2)), V(2, 5, -1)), tolerance);
    EXPECT_EQ(act(translation(V(1, -2, 3)), V(1, 1, 1)), V(2, -1, 4));
    EXPECT_EQ(translation(V(1, -2, 3)), (DualQuaternion<T>{{1, 0, 0, 0}, {0, T(0.5), -1, T(1.5)}}));
    // First the turn, then the shift.
    const auto both = translation(V(1, 0, 0)) * rotation(T(pi / 2), V(0, 0, 1));
    EXPECT_LE(difference(act(both, V(2, 0, 0)), V(1, 2, 0)), tolerance);
}

TYPED_TEST(DualQuaternionTest, KeepsTheHandOfThreeVectors) {
    expect_always("q0 (u x v) = q0 u x q0 v", [] {
        using T = TypeParam;
        const auto q = TestFixture::unit();
        const auto u = any_vector<T>(1), v = any_vector<T>(1);
        const auto turned = [&](const auto& x) { return act(q, x) - act(q, glm::vec<3, T>(T(0))); };
        RC_ASSERT(difference(turned(glm::cross(u, v)), glm::cross(turned(u), turned(v))) <=
                  2 * TestFixture::rounding);
    });
}

TYPED_TEST(DualQuaternionTest, ScrewGoesThereAndBack) {
    expect_always("from_screw(screw(q)) = q; the axis is a unit, the moment at right angles to it", [] {
        using T = TypeParam;
        const T h = T(*real(0.1, 3));
        const auto q = exp(any_log<DualQuaternion<T>>(h, size));
        const Screw<T> s = screw(q);
        // Divided by sinc, at least 0.047, and by h, at least 0.1.
        const T tolerance = 12 * 18 * 21 * 10 * TestFixture::epsilon;
        RC_ASSERT(TestFixture::near(from_screw(s), q, tolerance));
        RC_ASSERT(std::abs(s.angle - 2 * h) <= 16 * TestFixture::epsilon);
        RC_ASSERT(std::abs(glm::length(s.axis) - 1) <= 4 * TestFixture::epsilon);
        RC_ASSERT(std::abs(glm::dot(s.axis, s.moment)) <= tolerance);
    });
}

TYPED_TEST(DualQuaternionTest, ScrewIsATurnAboutALineAndAShiftAlongIt) {
    expect_always("c + x axis goes to c + (x + pitch) axis, and q is the turn about c, then the shift", [] {
        using T = TypeParam;
        const auto axis = any_axis<T>();
        const auto c = any_vector<T>(size);
        const Screw<T> s{T(*real(0.1, 6)), T(*real(-size, size)), axis, glm::cross(c, axis)};
        const auto q = translation(c + axis * s.pitch) * rotation(s.angle, axis) * translation(-c);
        RC_ASSERT(TestFixture::near(from_screw(s), q, 2 * TestFixture::rounding));
        RC_ASSERT(difference(act(q, c), c + axis * s.pitch) <= 2 * TestFixture::rounding);
        const Screw<T> back = screw(q);
        // As above: by 1 / sinc and by 1 / h = 20.
        const T tolerance = 40 * 20 * 20 * TestFixture::epsilon;
        RC_ASSERT(std::abs(back.angle - s.angle) <= 20 * TestFixture::epsilon);
        RC_ASSERT(std::abs(back.pitch - s.pitch) <= tolerance);
        RC_ASSERT(difference(back.axis, s.axis) <= 20 * 20 * TestFixture::epsilon);
        RC_ASSERT(difference(back.moment, s.moment) <= tolerance);
    });
}

TYPED_TEST(DualQuaternionTest, ScrewsByHand) {
    using T = TypeParam;
    using V = glm::vec<3, T>;
    const T tolerance = 16 * this->epsilon;  // a few roundings of numbers up to 6
    // A pure shift, in either direction along its axis, and nothing at all.
    const Screw<T> shift = screw(translation(V(0, -3, 4)));
    EXPECT_EQ(shift.angle, T(0));
    EXPECT_EQ(shift.pitch, T(5));
    EXPECT_LE(difference(shift.axis, V(0, T(-0.6), T(0.8))), tolerance);
    EXPECT_EQ(shift.moment, V(0, 0, 0));
    EXPECT_LE(difference(from_screw(shift), translation(V(0, -3, 4))), tolerance);
    const Screw<T> none = screw(DualQuaternion<T>{});
    EXPECT_EQ(none.angle, T(0));
    EXPECT_EQ(none.pitch, T(0));
    EXPECT_EQ(none.axis, V(0, 0, 1));
    EXPECT_EQ(from_screw(none), DualQuaternion<T>{});
    // A quarter turn about the line through (1, 0, 0) along z: moment (1, 0, 0) x (0, 0, 1) = (0, -1, 0). It
    // takes the origin to (1, -1, 0).
    const auto turn = from_screw(Screw<T>{T(pi / 2), T(0), V(0, 0, 1), V(0, -1, 0)});
    EXPECT_LE(difference(act(turn, V(0, 0, 0)), V(1, -1, 0)), tolerance);
    const Screw<T> back = screw(turn);
    EXPECT_NEAR(back.angle, T(pi / 2), tolerance);
    EXPECT_NEAR(back.pitch, T(0), tolerance);
    EXPECT_LE(difference(back.moment, V(0, -1, 0)), tolerance);
    // q and -q: the same motion by the other way round, about the axis turned over.
    const Screw<T> other = screw(-turn);
    EXPECT_NEAR(other.angle, T(3 * pi / 2), tolerance);
    EXPECT_LE(difference(other.axis, V(0, 0, -1)), tolerance);
    EXPECT_LE(difference(other.moment, V(0, 1, 0)), tolerance);
}

TYPED_TEST(DualQuaternionTest, EveryWholeTurnHasALogarithmAboutItsShift) {
    using T = TypeParam;
    using V = glm::vec<3, T>;
    const T pi_T = std::numbers::pi_v<T>;
    // -1 is exp(-pi i), as in the plane.
    EXPECT_EQ(log(-DualQuaternion<T>{}), (DualQuaternionLog<T>{V(-pi_T, 0, 0), V(0)}));
    // -(1 + (d/2) e): -b = d/2, and the axis is b / |b|, along which it shifts back by |d|.
    const auto q = -translation(V(6, 0, -8));
    const Screw<T> s = screw(q);
    const T tolerance = 16 * this->epsilon;  // a few roundings of numbers up to 10
    EXPECT_NEAR(s.angle, 2 * pi_T, tolerance);
    EXPECT_NEAR(s.pitch, T(-10), tolerance);
    EXPECT_LE(difference(s.axis, V(T(-0.6), 0, T(0.8))), tolerance);
    EXPECT_LE(glm::length(s.moment), tolerance);
    expect_always("exp(log q) = q for whole turns with any shift, to the rounding of q0", [] {
        const T tiny = T(*magnitude(-40, -1)) * TestFixture::epsilon;
        const auto whole = -translation(any_vector<T>(size)) * rotation(tiny, any_axis<T>());
        RC_ASSERT(difference(exp(log(whole)), whole) <= 6 * T(size) * TestFixture::epsilon);
    });
}

TYPED_TEST(DualQuaternionTest, LogByHand) {
    using T = TypeParam;
    using V = glm::vec<3, T>;
    const T tolerance = 8 * this->epsilon;  // a few roundings of numbers up to 3
    // A quarter turn about z and 3 along it: (pi/4 + 3/2 e) k.
    const auto x = log(translation(V(0, 0, 3)) * rotation(T(pi / 2), V(0, 0, 1)));
    EXPECT_LE(difference(x.r, V(0, 0, T(pi / 4))), tolerance);
    EXPECT_LE(difference(x.d, V(0, 0, T(1.5))), tolerance);
    // Half a turn about x through (0, 2, 0): (pi/2)(i + m e) with m = (0, 2, 0) x (1, 0, 0) = (0, 0, -2).
    const auto y = log(translation(V(0, 2, 0)) * rotation(T(pi), V(1, 0, 0)) * translation(V(0, -2, 0)));
    EXPECT_LE(difference(y.r, V(T(pi / 2), 0, 0)), tolerance);
    EXPECT_LE(difference(y.d, V(0, 0, T(-pi))), tolerance);
}

TYPED_TEST(DualQuaternionTest, ThePlaneIsInsideAndActsAlike) {
    expect_always("embed is a homomorphism, keeps sums, and commutes with the action (MKO section 4)", [] {
        using T = TypeParam;
        const auto p = *unit_dcn<T>(size), q = *unit_dcn<T>(size);
        const auto v = *point<T>(size);
        RC_ASSERT(TestFixture::near(embed(p * q), embed(p) * embed(q)));
        RC_ASSERT(embed(p + q) == embed(p) + embed(q));
        RC_ASSERT(embed(inverse(p)) == inverse(embed(p)));
        RC_ASSERT(difference(embed(act(p, v)), act(embed(p), embed(v))) <= TestFixture::rounding);
        RC_ASSERT(std::abs(rotation_dot(embed(p), embed(q)) - rotation_dot(p, q)) <=
                  2 * TestFixture::epsilon);
        RC_ASSERT(std::abs(norm(embed(p)).real - norm(p)) <= 2 * TestFixture::epsilon);
        RC_ASSERT(norm(embed(p)).dual == 0);
    });
}

TYPED_TEST(DualQuaternionTest, ThePlaneIsInsideWithItsExpLogAndSlerp) {
    expect_always(
        "embed(exp x) = exp(embed x), embed(log p) = log(embed p), embed(slerp) = slerp(embed)", [] {
            using T = TypeParam;
            const DualComplexLog<T> x{T(*real(-3, 3)), *point<T>(size)};
            const auto p = exp(x), r = *unit_dcn<T>(size);
            const T t = T(*real(-1, 2));
            RC_ASSERT(
                TestFixture::near(embed(exp(x)), exp(testing::embed(x)), 8 * 15 * TestFixture::epsilon));
            // By 1 / sinc = 21.
            RC_ASSERT(difference(coordinates(testing::embed(log(p))), coordinates(log(embed(p)))) <=
                      21 * 8 * 15 * TestFixture::epsilon);
            RC_ASSERT(TestFixture::near(embed(slerp(r, p * r, t)), slerp(embed(r), embed(p * r), t),
                                        2 * 21 * TestFixture::rounding));
        });
}

TEST(DualQuaternion, ThePlaneByHand) {
    // 1 + 2i + (3 + 4i) e -> 1 + 2i + (3j + 4k) e; 5 + 6i -> (0, 5, 6).
    EXPECT_EQ(embed(DualComplex<double>{{1, 2}, {3, 4}}),
              (DualQuaternion<double>{{1, 2, 0, 0}, {0, 0, 3, 4}}));
    EXPECT_EQ(embed(std::complex<double>(5, 6)), glm::dvec3(0, 5, 6));
}

}  // namespace
}  // namespace probewarp
