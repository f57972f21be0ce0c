// The blends of the plane's motions, by every method: what all of them promise, and that each is the method
// that its name says.
#include "math/planar_blend.h"

#include "generators.h"
#include "math/matrix_blend.h"
#include "planar_cases.h"

namespace probewarp {
namespace {

using testing::all_methods;
using testing::angle;
using testing::close_probes;
using testing::difference;
using testing::expect_always;
using testing::magnitude;
using testing::PlanarCase;
using testing::point;
using testing::real;
using testing::whole;

constexpr double pi = std::numbers::pi;
constexpr double size = 10;  // of the pictures

template <class K>
struct PlanarTest : ::testing::Test {
    using Scalar = typename K::Scalar;
    static constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
    // Of close probes: means of up to 6 of up to 30 in size, a quotient whose divisor is at least half of
    // what is summed up in it, and products of those: some forty roundings.
    static constexpr Scalar rounding = 40 * 30 * epsilon;
};
TYPED_TEST_SUITE(PlanarTest, testing::PlanarKinds);

/// Whatever may come: no weight or a huge one, places that coincide, far away or not, turns on the spot, many
/// turns, whole ones.
template <class K>
PlanarCase<K> anything() {
    using W = typename K::Weight;
    using T = typename K::Scalar;
    PlanarCase<K> c;
    const double extent = *rc::gen::element(1.0, 1000.0, 1e7);
    const int count = *whole(1, 6);
    const auto some_point = [&] {
        return *rc::gen::oneOf(
            point<T>(extent),
            rc::gen::element(std::complex<T>(T(0)), std::complex<T>(T(0.1 * extent), T(extent))));
    };
    for (int i = 0; i < count; ++i) {
        c.weights.push_back(
            W(std::abs(*rc::gen::oneOf(real(0, 1), magnitude(-15, 15), rc::gen::element(0.0, 1.0)))));
        const auto rest = some_point();
        c.motions.push_back(motion(T(*angle(12)), rest, *whole(0, 2) ? some_point() : rest));
    }
    c.weights[std::size_t(*whole(0, count - 1))] = W(*rc::gen::element(1e-15, 1.0, 1e15));
    return c;
}

TYPED_TEST(PlanarTest, IsFiniteWhateverMayComeAndFollowsTheHeaviestWhereThereIsNoAnswer) {
    expect_always("never NaN or infinite; where cancelled, the heaviest motion bit for bit", [] {
        const auto c = anything<TypeParam>();
        for (const auto& method : all_methods<TypeParam>()) {
            const auto blend = method(c);
            const auto z = blend.less_one, b = blend.shift;
            if (!std::isfinite(std::abs(z)) || !std::isfinite(std::abs(b))) RC_FAIL(method.name);
            if (!blend.cancelled) continue;
            const auto& m = c.motions[heaviest<typename TypeParam::Weight>(c.weights)];
            if (z != m.less_one || b != m.shift) RC_FAIL(method.name);
        }
    });
}

TYPED_TEST(PlanarTest, IsTheIdentityBitForBitWhereNoProbeMoved) {
    expect_always("no turn, now = rest: nothing moves, by any method, whatever the weights and places", [] {
        using T = typename TypeParam::Scalar;
        auto c = anything<TypeParam>();
        for (auto& m : c.motions) m = motion(T(0), m.rest, m.rest);
        for (const auto& method : all_methods<TypeParam>()) {
            const auto blend = method(c);
            if (blend.less_one != std::complex<T>(0) || blend.shift != std::complex<T>(0) || blend.cancelled)
                RC_FAIL(method.name);
            const auto v = *point<T>(1e4);
            RC_ASSERT(act(blend, v) == v);
        }
    });
}

TYPED_TEST(PlanarTest, GivesTheProbesOwnMotionWhereItsWeightAloneIsNotZero) {
    expect_always("weights 0, ..., w, ..., 0 give the motion; least squares its shift alone, exactly", [] {
        using T = typename TypeParam::Scalar;
        auto c = close_probes<TypeParam>(size, 6, 6);
        const auto which = std::size_t(*whole(0, int(c.motions.size()) - 1));
        for (std::size_t i = 0; i < c.weights.size(); ++i)
            if (i != which) c.weights[i] = 0;
        const auto& m = c.motions[which];
        for (const auto& method : all_methods<TypeParam>()) {
            const auto blend = method(c);
            if (method.knows_turns) {
                // The angle is rounded by up to 12 half epsilons twice; log_linear multiplies by V of one
                // that divides by V of the other.
                const T rounded = 12 * TestFixture::epsilon * (T(size) + 20);
                const T v = std::max(std::abs(left_jacobian(m.angle)), cancelled_share<T>);
                if (!(difference(blend, similarity(m), size) <= TestFixture::rounding + rounded / v))
                    RC_FAIL(method.name);
            } else if (blend.less_one != std::complex<T>(0) || blend.shift != m.now - m.rest)
                RC_FAIL(method.name);
        }
    });
}

TYPED_TEST(PlanarTest, GivesTheProbesOwnMotionExactlyAtWeightOneByTheMethodsThatOnlyAverage) {
    expect_always("weights 0 and 1: spiral and linear, bit for bit", [] {
        using W = typename TypeParam::Weight;
        auto c = anything<TypeParam>();
        const auto which = std::size_t(*whole(0, int(c.motions.size()) - 1));
        for (std::size_t i = 0; i < c.weights.size(); ++i) c.weights[i] = W(i == which);
        for (const auto& blend : {spiral<W, typename TypeParam::Scalar>(c.weights, c.motions),
                                  planar_linear<W, typename TypeParam::Scalar>(c.weights, c.motions)}) {
            RC_ASSERT(blend.less_one == c.motions[which].less_one);
            RC_ASSERT(blend.shift == c.motions[which].shift);
        }
    });
}

TYPED_TEST(PlanarTest, MindsNeitherTheScaleOfTheWeightsNorTheirOrder) {
    expect_always("blend(s w, m) = blend(w, m), also in another order", [] {
        const auto c = close_probes<TypeParam>(size);
        auto other = c;
        const double scale =
            std::ldexp(1, *whole(-60, 60));  // exact, so that float's weights keep their shares
        for (auto& w : other.weights) w = typename TypeParam::Weight(w * scale);
        std::reverse(other.weights.begin(), other.weights.end());
        std::reverse(other.motions.begin(), other.motions.end());
        auto methods = testing::equivariant_methods<TypeParam>();
        methods.push_back(testing::log_linear_method<TypeParam>());
        for (const auto& method : methods)
            if (!(difference(method(c), method(other), size) <= TestFixture::rounding)) RC_FAIL(method.name);
    });
}

TYPED_TEST(PlanarTest, CommutesWithRigidMotionsOfEitherFrame) {
    expect_always("now_i and turns moved by g: the blend, then g; v and rest_i moved by g: g undone, then it",
                  [] {
                      const auto c = close_probes<TypeParam>(size);
                      using T = typename TypeParam::Scalar;
                      const auto g = motion(T(*angle(1)), *point<T>(size), *point<T>(size));
                      auto left = c, right = c;
                      for (auto& m : left.motions) m = testing::then(g, m);
                      for (auto& m : right.motions) m = testing::at_rest_moved(m, g);
                      for (const auto& method : testing::equivariant_methods<TypeParam>()) {
                          const auto plain = method(c);
                          const auto moved = testing::after(similarity(g), plain),
                                     before = testing::after(plain, testing::undone(similarity(g)));
                          // g carries 30 more away, and angles of up to 8 are rounded.
                          if (!(difference(method(left), moved, size) <= 3 * TestFixture::rounding))
                              RC_FAIL(method.name);
                          if (!(difference(method(right), before, size) <= 3 * TestFixture::rounding))
                              RC_FAIL(method.name);
                      }
                  });
}

TYPED_TEST(PlanarTest, LogLinearCommutesWithMovingBothFramesAlike) {
    expect_always("log_linear(g m g^-1) = g log_linear(m) g^-1", [] {
        using T = typename TypeParam::Scalar;
        const auto c = close_probes<TypeParam>(size);
        const auto g = motion(T(*angle(1)), *point<T>(size), *point<T>(size));
        auto both = c;
        for (auto& m : both.motions) m = testing::at_rest_moved(testing::then(g, m), g);
        const auto blend = testing::log_linear_method<TypeParam>();
        const auto expected =
            testing::after(similarity(g), testing::after(blend(c), testing::undone(similarity(g))));
        RC_ASSERT(difference(blend(both), expected, size) <= 6 * TestFixture::rounding);
    });
}

// ---- Each is the method of its name.

template <class K>
std::vector<typename K::Scalar> plain_weights(const PlanarCase<K>& c) {
    return {c.weights.begin(), c.weights.end()};
}

template <class K>
std::vector<DualComplex<typename K::Scalar>> elements(const PlanarCase<K>& c) {
    std::vector<DualComplex<typename K::Scalar>> p;
    for (const auto& m : c.motions) p.push_back(m.p);
    return p;
}

/// Turns that are multiples of 90 degrees: many half a turn apart, many sets without a mean.
template <class K>
PlanarCase<K> ties() {
    using T = typename K::Scalar;
    PlanarCase<K> c;
    const int count = *whole(2, 6);
    for (int i = 0; i < count; ++i) {
        c.weights.push_back(typename K::Weight(*whole(1, 2)));
        c.motions.push_back(motion(T(pi / 2) * T(*whole(-8, 8)), *point<T>(size), *point<T>(size)));
    }
    return c;
}

TYPED_TEST(PlanarTest, DlbIsDlbHoweverFarApart) {
    expect_always("planar_dlb = dlb, cancelled where it is", [] {
        using P = DualComplex<typename TypeParam::Scalar>;
        const auto c = *whole(0, 1) ? close_probes<TypeParam>(size, 6, 6) : ties<TypeParam>();
        const auto expected = dlb<P>(plain_weights(c), elements(c));
        const auto got =
            planar_dlb<typename TypeParam::Weight, typename TypeParam::Scalar>(c.weights, c.motions);
        auto s0 = std::complex<double>(0);
        for (std::size_t i = 0; i < c.motions.size(); ++i)
            s0 += double(c.weights[i]) * std::complex<double>(c.motions[i].p.p0);
        RC_PRE(std::abs(s0) < 1e-7 ||
               std::abs(s0) > 0.05);  // in between rounding counts; another test has that
        RC_ASSERT(got.cancelled == expected.cancelled);
        // By the share of at least 0.05 / 6, in p0 and in p1.
        RC_ASSERT(difference(got, similarity(expected.p), size) <= 120 * TestFixture::rounding);
    });
}

TYPED_TEST(PlanarTest, DlbShortestIsDlbShortestAlsoWithTiesAndWithoutAMean) {
    expect_always("planar_dlb_shortest = dlb_shortest", [] {
        using P = DualComplex<typename TypeParam::Scalar>;
        const auto c = *whole(0, 1) ? close_probes<TypeParam>(size, 6, 1) : ties<TypeParam>();
        const auto expected = dlb_shortest<P>(plain_weights(c), elements(c));
        const auto got =
            planar_dlb_shortest<typename TypeParam::Weight, typename TypeParam::Scalar>(c.weights, c.motions);
        RC_ASSERT(!got.cancelled);
        RC_ASSERT(!expected.cancelled);
        // The sum is at least a sixth of its terms.
        RC_ASSERT(difference(got, similarity(expected.p), size) <= 6 * TestFixture::rounding);
    });
}

TYPED_TEST(PlanarTest, LogLinearIsLogLinearWithinAWholeTurn) {
    expect_always("planar_log_linear = log_linear for |angle| < 2 pi and weights that sum to 1", [] {
        using T = typename TypeParam::Scalar;
        auto c = close_probes<TypeParam>(size, 2.7, 2.7);
        auto w = plain_weights(c);
        T total{};
        for (const T x : w) total += x;
        for (T& x : w) x /= total;
        const auto expected = log_linear<DualComplex<T>>(w, elements(c));
        const auto got = planar_log_linear<typename TypeParam::Weight, T>(c.weights, c.motions);
        // At 5.4 the logarithm's shift is up to 7 times the shift, and as much less exact.
        RC_ASSERT(difference(got, similarity(expected), size) <= 10 * TestFixture::rounding);
    });
}

TYPED_TEST(PlanarTest, LinearIsTheMeanOfTheMatrices) {
    expect_always("planar_linear = linear_matrix_blend for weights that sum to 1", [] {
        using T = typename TypeParam::Scalar;
        auto c = close_probes<TypeParam>(size, 6, 6);
        auto w = plain_weights(c);
        T total{};
        for (const T x : w) total += x;
        for (T& x : w) x /= total;
        const auto expected = linear_matrix_blend<DualComplex<T>>(w, elements(c));
        const auto got = planar_linear<typename TypeParam::Weight, T>(c.weights, c.motions);
        const auto v = *point<T>(size);
        RC_ASSERT(difference(act(got, v), act(expected, v)) <= TestFixture::rounding);
    });
}

template <class K>
void expect_dib_is_the_iteration(const PlanarCase<K>& c, double tolerance) {
    using P = DualComplex<double>;
    const auto result = dib<P>(plain_weights(c), elements(c), tolerance / 4);
    RC_ASSERT(result.converged);
    const auto got = planar_dib<typename K::Weight, double>(c.weights, c.motions);
    RC_ASSERT(!got.cancelled);
    RC_ASSERT(difference(got, similarity(result.p), size) <= tolerance);
}

TEST(PlanarDib, IsTheIterationOfKavanToAMillionMillionth) {
    // 1e-12 of the sizes, 30: a hundred roundings of them, and four of the iteration's last steps.
    using K = testing::PlanarKind<double, double>;
    expect_always("planar_dib = dib, many within 70 degrees",
                  [] { expect_dib_is_the_iteration(close_probes<K>(size, 1, 0.6), 30e-12); });
    expect_always("planar_dib = dib, two that are anything but a whole turn apart", [] {
        auto c = close_probes<K>(size, 3, 0);
        c.weights.resize(2, *real(0.01, 1)), c.motions.resize(2, c.motions[0]);
        const double apart =
            *rc::gen::oneOf(real(-5.5, 5.5), rc::gen::element(1.999e-2, 2.001e-2, 1e-3, 0.0));
        c.motions[1] = motion(c.motions[0].angle + apart, *point<double>(size), *point<double>(size));
        RC_PRE(std::abs(c.motions[1].angle) < 6);
        expect_dib_is_the_iteration(c, 30e-12);
    });
}

TYPED_TEST(PlanarTest, DibOfTwoThatTurnApartByHandOnBothSidesOfItsSmallAngles) {
    using W = typename TypeParam::Weight;
    using T = typename TypeParam::Scalar;
    // Turns by -2h about 0 and by 2h, then a shift by d; weights 1 and 1. m = 0, a_i = h cot h +- i h:
    //   d (h cot h - i h) / (2 h cot h) = (d/2)(1 - i tan h).
    const std::complex<T> d(3, 4);
    for (const double half :
         {0.0, 1e-8, 1e-5, 0.5e-3, 2e-3, 0.999e-2, 1.001e-2, 0.02, 0.05, 0.3, 1.0, 1.4, 2.0}) {
        const T h = T(half);
        const std::vector<Motion<T>> motions{motion(-2 * h, std::complex<T>(0), std::complex<T>(0)),
                                             motion(2 * h, std::complex<T>(0), d)};
        const auto blend = planar_dib<W, T>(std::vector<W>{1, 1}, motions);
        const T tangent = std::tan(h);
        EXPECT_EQ(blend.less_one, std::complex<T>(0));
        // A few roundings of numbers up to 5, as much larger as the tangent is steep.
        EXPECT_LE(std::abs(blend.shift - d / T(2) * std::complex<T>(1, -tangent)),
                  8 * 5 * this->epsilon * (1 + tangent * tangent))
            << half;
    }
}

// ---- Where there is no answer.

TYPED_TEST(PlanarTest, SaysWhereTheWeightsCancel) {
    using W = typename TypeParam::Weight;
    using T = typename TypeParam::Scalar;
    using C = std::complex<T>;
    const auto at = [](double turns, C rest, C now) { return motion(T(2 * pi * turns), rest, now); };
    const std::vector<W> halves{1, 1}, first_more{W(1.1), 1};
    // DLB: nothing and a whole turn.
    const std::vector<Motion<T>> whole{at(0, 0, 1), at(1, 2, 3)};
    EXPECT_TRUE((planar_dlb<W, T>(halves, whole).cancelled));
    EXPECT_FALSE((planar_dlb<W, T>(first_more, whole).cancelled));
    EXPECT_FALSE((planar_dlb_shortest<W, T>(halves, whole).cancelled));
    // DIB: two a whole turn apart, whatever their weights, for nothing in between knows its centre; the mean
    // a whole turn from either; but not where one of the two has no weight, nor short of a whole turn.
    const std::vector<Motion<T>> twice{at(0, 0, 1), at(2, 2, 3)}, short_of{at(0, 0, 1), at(0.9, 2, 3)};
    EXPECT_TRUE((planar_dib<W, T>(halves, whole).cancelled));
    EXPECT_TRUE((planar_dib<W, T>(first_more, whole).cancelled));
    EXPECT_TRUE((planar_dib<W, T>(halves, twice).cancelled));
    EXPECT_FALSE((planar_dib<W, T>(halves, short_of).cancelled));
    EXPECT_FALSE((planar_dib<W, T>(std::vector<W>{1, 0}, twice).cancelled));
    // In the logarithm: a whole turn that goes elsewhere. In place, or without weight, it does no harm.
    EXPECT_TRUE((planar_log_linear<W, T>(halves, whole).cancelled));
    EXPECT_FALSE((planar_log_linear<W, T>(std::vector<W>{1, 0}, whole).cancelled));
    EXPECT_FALSE(
        (planar_log_linear<W, T>(halves, std::vector<Motion<T>>{at(0, 0, 1), at(1, 2, 2)}).cancelled));
    // What follows is the heaviest motion, of equals the first.
    EXPECT_EQ((planar_dlb<W, T>(halves, whole).shift), whole[0].shift);
    EXPECT_EQ((planar_dib<W, T>(std::vector<W>{W(0.5), W(0.5)}, twice).shift), twice[0].shift);
}

TYPED_TEST(PlanarTest, CancelsBelowAMillionthAndNotAbove) {
    using W = typename TypeParam::Weight;
    using T = typename TypeParam::Scalar;
    using C = std::complex<T>;
    // Turns by 180 degrees -+ x and back are cos(90 -+ x/2) = +- x/2 away from cancelling. Float rounds them
    // by 2e-7 at pi, a fifth of the millionth; so 0.7 and 1.4 millionths, and their means by a tenth.
    const auto apart = [](double x, double turns) {
        return std::vector<Motion<T>>{motion(T(-pi * turns + x), C(0), C(1)),
                                      motion(T(pi * turns - x), C(2), C(3))};
    };
    const std::vector<W> halves{W(0.5), W(0.5)};
    EXPECT_TRUE((planar_dlb<W, T>(halves, apart(1.2e-6, 1)).cancelled));
    EXPECT_FALSE((planar_dlb<W, T>(halves, apart(3e-6, 1)).cancelled));
    // DIB: sin((t - m)/2) a millionth, at whole turns (t of 2 pi: float's rounding is twice as large).
    EXPECT_TRUE((planar_dib<W, T>(halves, apart(1e-6, 2)).cancelled));
    EXPECT_FALSE((planar_dib<W, T>(halves, apart(3.5e-6, 2)).cancelled));
    // |V(t)| = |sin(t/2)| / (t/2) a millionth: t is pi millionths, twice, from 2 pi.
    const auto near_whole = [](double x) {
        return std::vector<Motion<T>>{motion(T(2 * pi - x), C(0), C(1))};
    };
    const std::vector<W> one{1};
    EXPECT_TRUE((planar_log_linear<W, T>(one, near_whole(5e-6)).cancelled));
    EXPECT_FALSE((planar_log_linear<W, T>(one, near_whole(8e-6)).cancelled));
}

}  // namespace
}  // namespace probewarp
