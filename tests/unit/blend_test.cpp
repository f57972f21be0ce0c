// The laws of blending (Kavan et al., TCD-CS-2006-46, here "Kavan"; MKO section 5), over every method, in the
// plane and in space, in float and double: no preferred frame, no scale of the weights, no order, no NaN.
#include "math/blend.h"

#include "generators.h"

namespace probewarp {
namespace {

using testing::any_log;
using testing::any_unit;
using testing::difference;
using testing::difference_of_motions;
using testing::expect_always;
using testing::magnitude;
using testing::real;
using testing::turn_in_plane;
using testing::whole;

constexpr double pi = std::numbers::pi;
constexpr double size = 10;  // of the shifts

template <class P>
struct Case {
    using T = typename P::Scalar;
    std::vector<T> weights;
    std::vector<P> p;
};

/// A blend as a function of the same shape for every method.
template <class P>
using Method = P (*)(const Case<P>&);

template <class P>
constexpr typename P::Scalar epsilon = std::numeric_limits<typename P::Scalar>::epsilon();

// What a step of the iteration can resolve: logarithms with shifts of up to 30, a dozen roundings of them.
template <class P>
constexpr typename P::Scalar precision = 12 * 30 * epsilon<P>;

template <class P>
P by_dlb(const Case<P>& c) {
    return dlb<P>(c.weights, c.p).p;
}
template <class P>
P by_dlb_shortest(const Case<P>& c) {
    return dlb_shortest<P>(c.weights, c.p).p;
}
template <class P>
P by_dib(const Case<P>& c) {
    const auto result = dib<P>(c.weights, c.p, precision<P>);
    EXPECT_TRUE(result.converged) << result.last_step;
    return result.p;
}
template <class P>
P by_log_linear(const Case<P>& c) {
    return log_linear<P>(c.weights, c.p);
}

template <class P>
struct BlendTest : ::testing::Test {
    using Scalar = typename P::Scalar;

    /// Weights that sum to 1, and transformations whose half angles are within 0.6 of one another's middle:
    /// near enough for every method to have a well determined answer.
    static Case<P> close() {
        Case<P> c;
        const P middle = exp(any_log<P>(Scalar(*real(-1, 1)), size));
        const int count = *whole(1, 8);
        Scalar total{};
        for (int i = 0; i < count; ++i) {
            c.weights.push_back(Scalar(*real(0.01, 1)));
            c.p.push_back(exp(any_log<P>(Scalar(*real(-0.6, 0.6)), size)) * middle);
            total += c.weights.back();
        }
        for (auto& w : c.weights) w /= total;
        return c;
    }
    /// Any at all, but the sum's direction is known: it is at least a hundredth of what it could be.
    static Case<P> wide() {
        Case<P> c;
        const int count = *whole(1, 8);
        P sum = Scalar(0) * P{};
        Scalar total{};
        for (int i = 0; i < count; ++i) {
            c.weights.push_back(Scalar(*real(0.01, 1)));
            c.p.push_back(any_unit<P>(size));
            sum = sum + c.weights.back() * c.p.back();
            total += c.weights.back();
        }
        RC_PRE(rotation_dot(sum, sum) > Scalar(1e-4) * total * total);
        return c;
    }
    template <class Change>
    static Case<P> changed(Case<P> c, Change change) {
        for (auto& p : c.p) p = change(p);
        return c;
    }
    // Of the close: sums of 8 of up to 60 in size, a product of two, a division; for the iteration also the
    // precision, which a step nears by at least a half.
    static constexpr Scalar rounding = 40 * 60 * epsilon<P> / 2 + 4 * precision<P>;
    // Of the wide: the same with shifts of up to 60, which the division by a share of a hundredth makes
    // larger once in the direction and once more, for dual quaternions, in the dual part.
    static constexpr Scalar wide_rounding = 40 * 60 * 100 * epsilon<P> / 2 * (testing::in_plane<P> ? 1 : 20);

    static constexpr std::array<Method<P>, 3> invariant{&by_dlb<P>, &by_dlb_shortest<P>, &by_dib<P>};
    static constexpr std::array<Method<P>, 4> all{&by_dlb<P>, &by_dlb_shortest<P>, &by_dib<P>,
                                                  &by_log_linear<P>};
};

TYPED_TEST_SUITE(BlendTest, testing::Transformations);

TYPED_TEST(BlendTest, DlbAndDibAreEquivariantFromTheLeftAndFromTheRight) {
    expect_always("blend(w, q p_i) = q blend(w, p_i), blend(w, p_i q) = blend(w, p_i) q", [] {
        const auto c = TestFixture::close();
        // Any q: but such that DIB's logarithms, of p_i x^-1, do not see it.
        const auto q = any_unit<TypeParam>(size);
        for (const auto method : TestFixture::invariant) {
            const auto plain = method(c);
            const auto left = method(TestFixture::changed(c, [&](const auto& p) { return q * p; }));
            const auto right = method(TestFixture::changed(c, [&](const auto& p) { return p * q; }));
            RC_ASSERT(difference_of_motions(left, q * plain) <= 2 * TestFixture::rounding);
            RC_ASSERT(difference_of_motions(right, plain * q) <= 2 * TestFixture::rounding);
        }
    });
}

TYPED_TEST(BlendTest, DlbIsEquivariantHoweverFarApart) {
    expect_always("dlb(w, q p_i r) = q dlb(w, p_i) r, sign and all", [] {
        const auto c = TestFixture::wide();
        const auto q = any_unit<TypeParam>(size), r = any_unit<TypeParam>(size);
        const auto moved = TestFixture::changed(c, [&](const auto& p) { return q * p * r; });
        RC_ASSERT(difference(by_dlb(moved), q * by_dlb(c) * r) <= TestFixture::wide_rounding);
    });
}

TYPED_TEST(BlendTest, LogLinearIsEquivariantUnderConjugation) {
    expect_always("log_linear(w, q p_i q^-1) = q log_linear(w, p_i) q^-1", [] {
        const auto c = TestFixture::close();
        const auto q = any_unit<TypeParam>(size);
        const auto moved = TestFixture::changed(c, [&](const auto& p) { return q * p * inverse(q); });
        // Half angles of up to 1.6 and shifts of up to 90.
        RC_ASSERT(difference(by_log_linear(moved), q * by_log_linear(c) * inverse(q)) <=
                  4 * TestFixture::rounding);
    });
}

TYPED_TEST(BlendTest, LogLinearIsNotEquivariantFromTheLeftNorFromTheRight) {
    // Halfway between two quarter turns about points 10 apart: one about the middle. With a turn of all
    // before it, or after, it is another by units, not by roundings. What the method's limits are (and DLB's
    // are not).
    const Case<TypeParam> c{{0.5, 0.5}, {TypeParam{}, turn_in_plane<TypeParam>(90, 0, 10)}};
    const auto q = turn_in_plane<TypeParam>(90, 0, 0);
    const auto left = TestFixture::changed(c, [&](const auto& p) { return q * p; });
    const auto right = TestFixture::changed(c, [&](const auto& p) { return p * q; });
    EXPECT_GT(difference(by_log_linear(left), q * by_log_linear(c)), 0.1);
    EXPECT_GT(difference(by_log_linear(right), by_log_linear(c) * q), 0.1);
    EXPECT_LT(difference(by_dlb(left), q * by_dlb(c)), TestFixture::rounding);
}

TYPED_TEST(BlendTest, GivesTheOneProbeThatWeighsSomething) {
    expect_always("weights 0, ..., w, ..., 0 give p_i by every method", [] {
        auto c = TestFixture::close();
        const auto which = std::size_t(*whole(0, int(c.p.size()) - 1));
        for (std::size_t i = 0; i < c.weights.size(); ++i) c.weights[i] = i == which;
        for (const auto method : TestFixture::all)
            RC_ASSERT(difference_of_motions(method(c), c.p[which]) <= TestFixture::rounding);
        const auto blend = dlb<TypeParam>(c.weights, c.p);
        RC_ASSERT(!blend.cancelled);
        // Three roundings (the norm, its inverse, the product) of numbers up to 30, sign and all.
        RC_ASSERT(difference(blend.p, c.p[which]) <= 3 * 30 * epsilon<TypeParam>);
    });
}

TYPED_TEST(BlendTest, DoesNotMindTheScaleOfTheWeights) {
    expect_always("blend(s w, p) = blend(w, p) for s > 0, however small", [] {
        const auto c = TestFixture::close();
        auto scaled = c;
        const auto scale = typename TypeParam::Scalar(std::abs(*magnitude(-30, 30)));
        for (auto& w : scaled.weights) w *= scale;
        for (const auto method : TestFixture::invariant)
            RC_ASSERT(difference_of_motions(method(scaled), method(c)) <= TestFixture::rounding);
    });
}

TYPED_TEST(BlendTest, CancelsWhateverTheScaleOfTheWeights) {
    using T = typename TypeParam::Scalar;
    for (const T w : {T(1e-30), T(1e-12), T(1), T(1e30)}) {
        const Case<TypeParam> c{{w, w, w / 2}, {TypeParam{}, -TypeParam{}, T(-1) * TypeParam{}}};
        EXPECT_FALSE(dlb<TypeParam>(c.weights, c.p).cancelled) << w;
        EXPECT_TRUE(dlb<TypeParam>(std::vector<T>{w, w}, std::vector{c.p[0], c.p[1]}).cancelled) << w;
    }
}

TYPED_TEST(BlendTest, IsAUnit) {
    expect_always("normalised(blend) = blend", [] {
        const auto c = TestFixture::close();
        for (const auto method : TestFixture::all) {
            const auto p = method(c);
            // The norm and the quotient round a few times numbers up to 60.
            RC_ASSERT(std::abs(rotation_dot(p, p) - 1) <= 8 * epsilon<TypeParam>);
            RC_ASSERT(difference(normalised(p), p) <= 8 * 60 * epsilon<TypeParam>);
        }
    });
}

TYPED_TEST(BlendTest, KnowsNoOrder) {
    expect_always("blend(w, p) in any order is the same", [] {
        const auto c = TestFixture::close();
        auto order = c;
        for (std::size_t i = order.p.size(); i > 1; --i) {
            const auto j = std::size_t(*whole(0, int(i) - 1));
            std::swap(order.p[i - 1], order.p[j]);
            std::swap(order.weights[i - 1], order.weights[j]);
        }
        for (const auto method : TestFixture::all)
            RC_ASSERT(difference_of_motions(method(order), method(c)) <= TestFixture::rounding);
    });
}

TYPED_TEST(BlendTest, LiesBetweenTwo) {
    expect_always("of two, dlb and dib are on the way from one to the other", [] {
        // DLB's angle along it: tan(a) = w sin h / (1 - w + w cos h).
        using T = typename TypeParam::Scalar;
        const T h = T(*real(0.1, 1.4)), w = T(*real(0, 1));
        const auto p = any_unit<TypeParam>(size), q = exp(any_log<TypeParam>(h, size)) * p;
        const auto p_q = dlb<TypeParam>(std::vector<T>{T(1) - w, w}, std::vector{p, q}).p;
        const T t = std::atan2(w * std::sin(h), T(1) - w + w * std::cos(h)) / h;
        // In space the shift along the axis is another: Kavan's figure of DLB and ScLERP. Its rotation is
        // not.
        RC_ASSERT(std::abs(rotation_dot(p_q, slerp(p, q, t)) - 1) <= 20 * epsilon<TypeParam>);
    });
}

TYPED_TEST(BlendTest, DibOfTwoIsTheirScrewMotionAfterOneStep) {
    expect_always("dib(1 - t, t; p, q) = slerp(p, q; t) at once (Kavan Lemma 3)", [] {
        using T = typename TypeParam::Scalar;
        const auto p = any_unit<TypeParam>(size), q = exp(any_log<TypeParam>(T(*real(-1.4, 1.4)), size)) * p;
        const T t = T(*real(0, 1));
        const std::vector<T> weights{T(1) - t, t};
        const std::vector<TypeParam> both{p, q};
        const auto one = dib<TypeParam>(weights, both, T(0), 1);
        RC_ASSERT(one.steps == 1);
        RC_ASSERT(difference(one.p, slerp(p, q, t)) <= TestFixture::rounding);
        const auto two = dib<TypeParam>(weights, both, precision<TypeParam>);
        RC_ASSERT(two.converged);
        RC_ASSERT(two.steps <= 2);  // the second finds nothing left to do
    });
}

/// sum w_i log(p_i x^-1).
template <class P>
auto residual(const Case<P>& c, const P& x) {
    auto sum = c.weights[0] * log(c.p[0] * inverse(x));
    for (std::size_t i = 1; i < c.p.size(); ++i) sum = sum + c.weights[i] * log(c.p[i] * inverse(x));
    return length(sum);
}

TYPED_TEST(BlendTest, DibLeavesNothingInTheLogarithms) {
    expect_always("sum w_i log(p_i x^-1) = 0 (Kavan section 5), in a few steps", [] {
        const auto c = TestFixture::close();
        const auto result = dib<TypeParam>(c.weights, c.p, precision<TypeParam>);
        RC_ASSERT(result.converged);
        RC_ASSERT(result.last_step <= precision<TypeParam>);
        RC_ASSERT(result.steps >= 1);
        RC_ASSERT(result.steps <= 15);
        RC_ASSERT(residual(c, result.p) <= 2 * precision<TypeParam>);
    });
}

TYPED_TEST(BlendTest, DibSaysHowFarItCameWhereItIsStopped) {
    using T = typename TypeParam::Scalar;
    const Case<TypeParam> c{{1, 2}, {TypeParam{}, turn_in_plane<TypeParam>(90, 3, 4)}};
    const auto none = dib<TypeParam>(c.weights, c.p, T(1e-3), 0);
    EXPECT_EQ(none.p, by_dlb(c));
    EXPECT_EQ(none.steps, 0);
    EXPECT_FALSE(none.converged);
    // DLB's half angle is atan(2 sin(pi/4) / (1 + 2 cos(pi/4))) = 0.530, DIB's 2/3 pi/4 = 0.524; about 5 away
    // the other coordinates are up to 5 times that. A precision of zero is never reached by the first step.
    const auto one = dib<TypeParam>(c.weights, c.p, T(0), 1);
    EXPECT_EQ(one.steps, 1);
    EXPECT_FALSE(one.converged);
    const double step = std::atan(2 * std::sin(pi / 4) / (1 + 2 * std::cos(pi / 4))) - pi / 6;
    EXPECT_NEAR(one.last_step, step * std::sqrt(1.0 + 25.0),
                30 * epsilon<TypeParam>);  // roundings of up to 5
    // A step of just the precision has converged.
    EXPECT_TRUE(dib<TypeParam>(c.weights, c.p, one.last_step, 1).converged);
    EXPECT_FALSE(dib<TypeParam>(c.weights, c.p, std::nextafter(one.last_step, T(0)), 1).converged);
}

TYPED_TEST(BlendTest, LogLinearOfOneIsItsPart) {
    expect_always("log_linear(t; p) = slerp(1, p; t): what the weights lack of 1 is the identity's", [] {
        using T = typename TypeParam::Scalar;
        const auto p = exp(any_log<TypeParam>(T(*real(-2, 2)), size));
        const T t = T(*real(0, 1));
        RC_ASSERT(difference(by_log_linear<TypeParam>({{t}, {p}}), slerp({}, p, t)) <= TestFixture::rounding);
    });
}

TYPED_TEST(BlendTest, FollowsTheHeaviestWhereTheWeightsCancel) {
    expect_always("p and -p of equal weights give the first of the heaviest, and say so", [] {
        using T = typename TypeParam::Scalar;
        const auto p = any_unit<TypeParam>(size);
        const T w = T(*real(0.01, 1));
        const auto two = dlb<TypeParam>(std::vector<T>{w, w}, std::vector{p, -p});
        RC_ASSERT(two.cancelled && two.p == p);
        const auto swapped = dlb<TypeParam>(std::vector<T>{w, w}, std::vector{-p, p});
        RC_ASSERT(swapped.cancelled && swapped.p == -p);
        const auto three = dlb<TypeParam>(std::vector<T>{w, 2 * w, w}, std::vector{p, -p, p});
        RC_ASSERT(three.cancelled && three.p == -p);
        const auto negative = dlb<TypeParam>(std::vector<T>{w, -w}, std::vector{p, -p});
        RC_ASSERT(!negative.cancelled);
    });
}

TYPED_TEST(BlendTest, CancelsBelowAMillionthAndNotAbove) {
    using T = typename TypeParam::Scalar;
    // Weights 1 and 1 - d on 1 and -1 leave d of 2 - d. Float rounds 1 - d by 3e-8, 3 per cent of the
    // millionth, and the quotients by as much again.
    const std::vector<TypeParam> p{{}, -TypeParam{}}, alike{{}, {}};
    const auto blend = [&p](double d) { return dlb<TypeParam>(std::vector<T>{T(1 - d), T(1)}, p); };
    EXPECT_TRUE(blend(1.8e-6).cancelled);
    EXPECT_EQ(blend(1.8e-6).p, p[1]);
    EXPECT_FALSE(blend(2.2e-6).cancelled);
    EXPECT_EQ(blend(2.2e-6).p, p[1]);
    // The share is of the weights' magnitudes.
    EXPECT_TRUE(dlb<TypeParam>(std::vector<T>{T(1 - 1.8e-6), T(-1)}, alike).cancelled);
    EXPECT_FALSE(dlb<TypeParam>(std::vector<T>{T(1 - 2.2e-6), T(-1)}, alike).cancelled);
}

TYPED_TEST(BlendTest, HeaviestIsTheFirstOfTheGreatestMagnitude) {
    using T = typename TypeParam::Scalar;
    EXPECT_EQ(heaviest<T>(std::vector<T>{1}), 0u);
    EXPECT_EQ(heaviest<T>(std::vector<T>{1, 3, 2, 3}), 1u);
    EXPECT_EQ(heaviest<T>(std::vector<T>{1, -3, 2}), 1u);
    EXPECT_EQ(heaviest<T>(std::vector<T>{0, 0}), 0u);
}

TYPED_TEST(BlendTest, LengthIsTheRootOfTheSquares) {
    using P = TypeParam;
    using T = typename P::Scalar;
    if constexpr (testing::in_plane<P>)
        EXPECT_EQ(length(DualComplexLog<T>{T(-2), {T(3), T(-6)}}), T(7));
    else
        EXPECT_EQ(length(DualQuaternionLog<T>{{1, 3, 1}, {-5, 3, -2}}), T(7));
}

TEST(Blend, HalfwayBetweenNothingAndAQuarterTurnIsAnEighth) {
    // (1 + e^{i pi/4}) / |1 + e^{i pi/4}| = e^{i pi/8}, about the same centre.
    const std::complex<double> centre{5, -3};
    const auto turned = rotation(pi / 2, centre);
    const auto blend =
        dlb<DualComplex<double>>(std::vector{2.0, 2.0}, std::vector{DualComplex<double>{}, turned}).p;
    const auto expected = rotation(pi / 4, centre);
    EXPECT_LT(std::abs(blend.p0 - expected.p0), 1e-15);  // a few roundings of numbers up to 1
    EXPECT_LT(std::abs(blend.p1 - expected.p1), 1e-14);  // ... and of numbers up to 6
}

}  // namespace
}  // namespace probewarp
