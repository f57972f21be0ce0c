// The laws that the rigid transformations of the plane (DCN: MKO, arXiv 1601.01754) and of space (unit dual
// quaternions: Kavan et al., TCD-CS-2006-46) have in common, over both and over float and double.
#include "math/transformation.h"

#include "generators.h"

namespace probewarp {
namespace {

using testing::any_log;
using testing::difference;
using testing::expect_always;
using testing::magnitude;
using testing::real;

constexpr double pi = std::numbers::pi;
constexpr double size = 10;  // of the shifts in the laws

template <class P>
struct TransformationTest : ::testing::Test {
    using Scalar = typename P::Scalar;
    static constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
    // The laws join up to three transformations of |p1| <= 2 * 10 sqrt 3 and one point: some twenty
    // operations, each rounding numbers of up to 90 by half an epsilon.
    static constexpr Scalar rounding = 20 * 90 * epsilon / 2;

    static bool near(const P& p, const P& q, Scalar tolerance = rounding) {
        return difference(p, q) <= tolerance;
    }
    static P any() { return testing::any_unit<P>(size); }
    static auto any_point() { return testing::any_point<P>(size); }
};

TYPED_TEST_SUITE(TransformationTest, testing::Transformations);

TYPED_TEST(TransformationTest, IsAssociative) {
    expect_always("(pq)r = p(qr)", [] {
        const auto p = TestFixture::any(), q = TestFixture::any(), r = TestFixture::any();
        RC_ASSERT(TestFixture::near((p * q) * r, p * (q * r)));
    });
}

TYPED_TEST(TransformationTest, IsDistributive) {
    expect_always("p(q + r) = pq + pr, (p + q)r = pr + qr", [] {
        const auto p = TestFixture::any(), q = TestFixture::any(), r = TestFixture::any();
        RC_ASSERT(TestFixture::near(p * (q + r), p * q + p * r));
        RC_ASSERT(TestFixture::near((p + q) * r, p * r + q * r));
    });
}

TYPED_TEST(TransformationTest, NumbersCommuteWithEverything) {
    expect_always("(t p) q = p (t q) = t (pq), p + (-p) = 0", [] {
        using T = typename TypeParam::Scalar;
        const auto p = TestFixture::any(), q = TestFixture::any();
        const T t = T(*real(-1, 1));
        RC_ASSERT(TestFixture::near((t * p) * q, t * (p * q)));
        RC_ASSERT(TestFixture::near(p * (t * q), t * (p * q)));
        RC_ASSERT(p + (-p) == T(0) * p);
    });
}

TYPED_TEST(TransformationTest, TheDefaultIsOne) {
    expect_always("1 p = p 1 = p, 1 <> v = v", [] {
        const auto p = TestFixture::any();
        const auto v = TestFixture::any_point();
        RC_ASSERT(TypeParam{} * p == p);
        RC_ASSERT(p * TypeParam{} == p);
        RC_ASSERT(act(TypeParam{}, v) == v);
    });
}

TYPED_TEST(TransformationTest, ProductActsAsOneAfterTheOther) {
    expect_always("(pq) <> v = p <> (q <> v)", [] {
        const auto p = TestFixture::any(), q = TestFixture::any();
        const auto v = TestFixture::any_point();
        RC_ASSERT(difference(act(p * q, v), act(p, act(q, v))) <= TestFixture::rounding);
    });
}

TYPED_TEST(TransformationTest, OppositesActAlike) {
    expect_always("-p <> v = p <> v", [] {
        const auto p = TestFixture::any();
        const auto v = TestFixture::any_point();
        RC_ASSERT(act(-p, v) == act(p, v));  // exactly: rounding does not know the sign
    });
}

TYPED_TEST(TransformationTest, InverseUndoes) {
    expect_always("p p^-1 = p^-1 p = 1", [] {
        const auto p = TestFixture::any();
        RC_ASSERT(TestFixture::near(p * inverse(p), {}));
        RC_ASSERT(TestFixture::near(inverse(p) * p, {}));
    });
}

TYPED_TEST(TransformationTest, KeepsDistances) {
    expect_always("|p <> u - p <> v| = |u - v|", [] {
        const auto p = TestFixture::any();
        const auto u = TestFixture::any_point(), v = TestFixture::any_point();
        RC_ASSERT(std::abs(difference(act(p, u), act(p, v)) - difference(u, v)) <= TestFixture::rounding);
    });
}

TYPED_TEST(TransformationTest, NormalisingUndoesAScale) {
    expect_always("normalised(t p) = p for a unit p and t > 0", [] {
        using T = typename TypeParam::Scalar;
        const auto p = TestFixture::any();
        RC_ASSERT(TestFixture::near(normalised(std::abs(T(*magnitude(-3, 3))) * p), p));
    });
}

TYPED_TEST(TransformationTest, TheDotOfRotationsIsOneWithItselfAndKnowsNoFrame) {
    expect_always("<p, p> = 1, <qp, qr> = <pq, rq> = <p, r> = -<-p, r>", [] {
        using T = typename TypeParam::Scalar;
        const auto p = TestFixture::any(), q = TestFixture::any(), r = TestFixture::any();
        const T tolerance = 20 * TestFixture::epsilon;  // some twenty roundings of numbers up to 1
        RC_ASSERT(std::abs(rotation_dot(p, p) - 1) <= tolerance);
        RC_ASSERT(std::abs(rotation_dot(q * p, q * r) - rotation_dot(p, r)) <= tolerance);
        RC_ASSERT(std::abs(rotation_dot(p * q, r * q) - rotation_dot(p, r)) <= tolerance);
        RC_ASSERT(rotation_dot(-p, r) == -rotation_dot(p, r));
    });
}

TYPED_TEST(TransformationTest, CoordinatesGoThereAndBack) {
    expect_always("from_coordinates(coordinates(x)) = x; coordinates are linear", [] {
        using T = typename TypeParam::Scalar;
        const auto x = any_log<TypeParam>(T(*real(-3, 3)), size),
                   y = any_log<TypeParam>(T(*real(-3, 3)), size);
        const T t = T(*real(-1, 1));
        RC_ASSERT(from_coordinates(coordinates(x)) == x);
        const auto sum = coordinates(x + t * y);
        for (std::size_t i = 0; i < sum.size(); ++i)
            RC_ASSERT(sum[i] == coordinates(x)[i] + t * coordinates(y)[i]);
    });
}

/// Half angles in all of [-pi, pi], at its edges, and on both sides of the thresholds of sinc's and
/// sinc_slope's Taylor branches.
template <class T>
rc::Gen<T> half_angle() {
    const auto to_T = [](double h) { return T(h); };
    const double epsilon = std::numeric_limits<T>::epsilon();
    const double sinc = std::pow(epsilon, 0.25), slope = std::pow(1e6 * epsilon, 0.125);
    const auto about = [](double h) {
        return rc::gen::map(magnitude(-18, -1), [h](double d) { return h * (1 + d); });
    };
    return rc::gen::map(
        rc::gen::oneOf(real(-pi, pi), rc::gen::element(-pi, pi, 0.0), magnitude(-40, -4),
                       rc::gen::map(magnitude(-18, -3), [](double d) { return d < 0 ? -pi - d : pi - d; }),
                       about(sinc), about(slope), about(-sinc), about(-slope)),
        to_T);
}

TYPED_TEST(TransformationTest, ExpOfLogIsTheSameAtEveryAngle) {
    expect_always("exp(log p) = p, for p = exp(x) r and so for whole turns, none, and all between", [] {
        using P = TypeParam;
        using T = typename P::Scalar;
        const T h = *half_angle<T>();
        const P half = exp(any_log<P>(h / 2, 0));  // a product's sine is not that of a representable angle
        const P turn = half * half;
        const P p = turn * translation(TestFixture::any_point());
        // Plane: the same sinc divides and multiplies p1. Space: the vector is normalised between, so that
        // the sine is not the same; at a whole turn it is the rounding of pi that tells how far away the axis
        // is.
        const T sine = std::max(std::abs(std::sin(h)), TestFixture::epsilon);
        const T axis = testing::in_plane<P> ? T(1) : T(pi) / sine;
        // |qe| <= 10; a dozen roundings.
        RC_ASSERT(TestFixture::near(exp(log(p)), p, 12 * TestFixture::epsilon * (1 + T(size) * axis)));
        const auto difference_of_turns = difference(exp(log(turn)), turn);
        // No shift: nothing but the sine and cosine of an angle of up to pi rounded once or twice.
        RC_ASSERT(difference_of_turns <= 8 * TestFixture::epsilon);
    });
}

TYPED_TEST(TransformationTest, LogOfExpIsTheSameInsideTheBranch) {
    expect_always("log(exp x) = x, relatively where x is small", [] {
        using T = typename TypeParam::Scalar;
        const T scale = T(*rc::gen::element(1.0, 1e-1, 1e-2, 1e-3, 1e-5, 1e-8));
        const auto x = scale * any_log<TypeParam>(T(*real(-3, 3)), size);
        const auto y = log(exp(x));
        // At |h| = 3, sinc is 0.047: roundings of h change it by a 40th of that relatively more. The other
        // part is up to 10 sqrt 3 and is divided by sinc.
        RC_ASSERT(difference(coordinates(x), coordinates(y)) <= scale * 18 * 150 * TestFixture::epsilon);
    });
}

TYPED_TEST(TransformationTest, LogOfExpIsTheSameUpToAWholeTurnAsWellAsTheSineIsKnown) {
    expect_always("log(exp x) = x for |h| near pi", [] {
        using T = typename TypeParam::Scalar;
        const double most = sizeof(T) == sizeof(float) ? -2 : -6;  // a thousand roundings from pi at least
        const T from_pi = T(std::abs(*magnitude(most, -0.5)));
        const auto x = any_log<TypeParam>(*rc::gen::element(T(1), T(-1)) * (T(pi) - from_pi), size);
        // The other part, up to 10 sqrt 3, was multiplied by a sine that is known to a rounding of pi, 2
        // epsilon; in all a dozen roundings.
        RC_ASSERT(difference(coordinates(x), coordinates(log(exp(x)))) <=
                  12 * 18 * TestFixture::epsilon * T(pi) / from_pi);
    });
}

TYPED_TEST(TransformationTest, ExpIsAUnitAndAOneParameterGroup) {
    expect_always("exp((s + t) x) = exp(s x) exp(t x); exp(-x) = exp(x)^-1", [] {
        using T = typename TypeParam::Scalar;
        const auto x = any_log<TypeParam>(T(*real(-3, 3)), size);
        const T s = T(*real(-3, 3)), t = T(*real(-3, 3));
        // Angles of up to 18, and shifts of up to 6 * 10 sqrt 3.
        RC_ASSERT(TestFixture::near(exp((s + t) * x), exp(s * x) * exp(t * x), 4 * TestFixture::rounding));
        RC_ASSERT(TestFixture::near(exp(T(-1) * x), inverse(exp(x))));
        RC_ASSERT(TestFixture::near(normalised(exp(x)), exp(x)));
    });
}

TYPED_TEST(TransformationTest, ExpBeginsAsOnePlusX) {
    expect_always("exp(t x) = 1 + t x + O(t^2), by its action: v + t (2 i h v + 2 p1)", [] {
        // What the algebra's element is the velocity of, and in which frame: the plane's, also for space.
        using P = TypeParam;
        using T = typename P::Scalar;
        const T t = std::sqrt(TestFixture::epsilon);
        const DualComplexLog<T> x{T(*real(-1, 1)), *testing::point<T>(1)};
        const auto v = *testing::point<T>(1);
        const auto expected = v + t * (std::complex<T>(0, 2 * x.h) * v + T(2) * x.p1);
        // What is left out is (2 h t)^2 of numbers up to 2 sqrt 2 and so on: at most 12 t^2 = 12 epsilon.
        if constexpr (testing::in_plane<P>)
            RC_ASSERT(difference(act(exp(t * x), v), expected) <= 16 * TestFixture::epsilon);
        else
            RC_ASSERT(difference(act(exp(t * testing::embed(x)), embed(v)), embed(expected)) <=
                      16 * TestFixture::epsilon);
    });
}

TYPED_TEST(TransformationTest, SlerpEndsAtBoth) {
    expect_always("slerp(p, q; 0) = p, slerp(p, q; 1) = q", [] {
        using T = typename TypeParam::Scalar;
        const auto p = TestFixture::any();
        const auto q = exp(any_log<TypeParam>(T(*real(-3, 3)), size)) * p;
        RC_ASSERT(TestFixture::near(slerp(p, q, T(0)), p));
        // exp undoes log; in space but for sinc, of which 1 / 0.047 at |h| = 3.
        RC_ASSERT(TestFixture::near(slerp(p, q, T(1)), q, 21 * TestFixture::rounding));
    });
}

TYPED_TEST(TransformationTest, SlerpHasConstantSpeed) {
    expect_always("from t to t + 1/8 it does the same at every t: an eighth of the way", [] {
        using T = typename TypeParam::Scalar;
        const auto p = TestFixture::any();
        // Beyond |h| = 3 the logarithm's p1 grows without bound (a whole turn about a point at infinity).
        const auto x = any_log<TypeParam>(T(*real(-3, 3)), size);
        const auto q = exp(x) * p;
        for (int k = 0; k < 8; ++k) {
            const auto step = slerp(p, q, T(k + 1) / 8) * inverse(slerp(p, q, T(k) / 8));
            // The logarithm's p1 is at most 21 times |p1| = 18 at |h| = 3, and as much less exact.
            RC_ASSERT(TestFixture::near(step, exp(T(0.125) * x), 21 * TestFixture::rounding));
        }
    });
}

TYPED_TEST(TransformationTest, SlerpKnowsNoFrame) {
    expect_always("slerp(rp, rq; t) = r slerp(p, q; t), slerp(pr, qr; t) = slerp(p, q; t) r", [] {
        using T = typename TypeParam::Scalar;
        const auto p = TestFixture::any(), r = TestFixture::any();
        const auto q = exp(any_log<TypeParam>(T(*real(-3, 3)), size)) * p;
        const T t = T(*real(-1, 2));
        const auto plain = slerp(p, q, t);
        // 21: as above; twice: t is up to 2. The shifts add up to 130.
        const T tolerance = 2 * 21 * 2 * TestFixture::rounding;
        RC_ASSERT(TestFixture::near(slerp(r * p, r * q, t), r * plain, tolerance));
        RC_ASSERT(TestFixture::near(slerp(p * r, q * r, t), plain * r, tolerance));
        RC_ASSERT(TestFixture::near(slerp(q, p, T(1) - t), plain, tolerance));
    });
}

TYPED_TEST(TransformationTest, SlerpTakesTheWayAroundThatTheSignsSay) {
    expect_always("halfway to -q differs from halfway to q by half a turn", [] {
        using T = typename TypeParam::Scalar;
        const auto p = TestFixture::any();
        const auto q = exp(any_log<TypeParam>(T(*real(0.2, 2.9)), size)) * p;
        const auto one = slerp(p, q, T(0.5)), other = slerp(p, -q, T(0.5));
        // Half of h and half of h - pi: at right angles. Roundings of the half angles, by 1 / sin 0.2.
        RC_ASSERT(std::abs(rotation_dot(one, other)) <= 5 * 20 * TestFixture::epsilon);
    });
}

}  // namespace
}  // namespace probewarp
