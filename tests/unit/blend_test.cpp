// The laws of DLB (MKO section 5): it knows no preferred frame, no scale of its weights, and no NaN.
#include "math/blend.h"

#include "generators.h"

namespace probewarp {
namespace {

using testing::expect_always;
using testing::real;
using testing::unit_dcn;
using testing::whole;

constexpr double size = 10;  // of the shifts

template <class T>
struct BlendTest : ::testing::Test {
    static constexpr T epsilon = std::numeric_limits<T>::epsilon();

    struct Case {
        std::vector<T> weights;
        std::vector<DualComplex<T>> p;
        T share = 0;  ///< |sum w_i p_i| / sum w_i: how well the direction of the sum is known

        Blend<DualComplex<T>> blend() const { return dlb<DualComplex<T>>(weights, p); }
        /// Sums of up to 8 DCNs of up to 15 in size, a product of two and a division: 40 roundings of numbers
        /// up to 30, all of which the division by the share makes larger.
        T rounding() const { return 40 * 30 * epsilon / 2 / share; }
    };
    static Case any() {
        Case c;
        const int count = *whole(1, 8);
        DualComplex<T> sum{T(0), T(0)};
        T total = 0;
        for (int i = 0; i < count; ++i) {
            c.weights.push_back(T(*real(0.01, 1)));
            c.p.push_back(*unit_dcn<T>(size));
            sum = sum + c.weights.back() * c.p.back();
            total += c.weights.back();
        }
        c.share = norm(sum) / total;
        RC_PRE(c.share > T(0.01));  // with less, the next test but one speaks
        return c;
    }
    static bool near(const DualComplex<T>& p, const DualComplex<T>& q, T tolerance) {
        return std::abs(p.p0 - q.p0) <= tolerance && std::abs(p.p1 - q.p1) <= tolerance;
    }
};

using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(BlendTest, Scalars);

TYPED_TEST(BlendTest, IsEquivariantFromTheLeft) {
    expect_always("dlb(w, q p_i) = q dlb(w, p_i)", [] {
        const auto plain = TestFixture::any();
        auto moved = plain;
        const auto q = *unit_dcn<TypeParam>(size);
        for (auto& p : moved.p) p = q * p;
        RC_ASSERT(TestFixture::near(moved.blend().p, q * plain.blend().p, plain.rounding()));
    });
}

TYPED_TEST(BlendTest, IsEquivariantFromTheRight) {
    expect_always("dlb(w, p_i q) = dlb(w, p_i) q", [] {
        const auto plain = TestFixture::any();
        auto moved = plain;
        const auto q = *unit_dcn<TypeParam>(size);
        for (auto& p : moved.p) p = p * q;
        RC_ASSERT(TestFixture::near(moved.blend().p, plain.blend().p * q, plain.rounding()));
    });
}

TYPED_TEST(BlendTest, GivesTheOneProbeThatWeighsSomething) {
    expect_always("weights 0, ..., w, ..., 0 give p_i", [] {
        auto c = TestFixture::any();
        const auto which = std::size_t(*whole(0, int(c.p.size()) - 1));
        for (std::size_t i = 0; i < c.weights.size(); ++i)
            if (i != which) c.weights[i] = 0;
        const auto blend = c.blend();
        RC_ASSERT(!blend.cancelled);
        // Three roundings (the weight in, the norm, the weight out) of numbers up to 15.
        RC_ASSERT(TestFixture::near(blend.p, c.p[which], 3 * 15 * TestFixture::epsilon));
    });
}

TYPED_TEST(BlendTest, DoesNotMindTheScaleOfTheWeights) {
    expect_always("dlb(s w, p) = dlb(w, p) for s > 0", [] {
        const auto plain = TestFixture::any();
        auto scaled = plain;
        const auto scale = TypeParam(*real(1e-6, 1e6));
        for (auto& w : scaled.weights) w *= scale;
        RC_ASSERT(TestFixture::near(scaled.blend().p, plain.blend().p, plain.rounding()));
    });
}

TYPED_TEST(BlendTest, IsAUnit) {
    expect_always("|dlb(w, p)| = 1", [] {
        // The norm, its inverse and the product round three times; a 4th time the norm of the result.
        RC_ASSERT(std::abs(norm(TestFixture::any().blend().p) - 1) <= 4 * TestFixture::epsilon);
    });
}

TYPED_TEST(BlendTest, FollowsTheHeaviestWhereTheWeightsCancel) {
    using T = TypeParam;
    expect_always("p and -p of equal weights give the first of the heaviest, and say so", [] {
        const auto p = *unit_dcn<T>(size);
        const T w = T(*real(0.01, 1));
        const auto two = dlb<DualComplex<T>>(std::vector<T>{w, w}, std::vector{p, -p});
        RC_ASSERT(two.cancelled && two.p == p);
        const auto swapped = dlb<DualComplex<T>>(std::vector<T>{w, w}, std::vector{-p, p});
        RC_ASSERT(swapped.cancelled && swapped.p == -p);
        const auto three = dlb<DualComplex<T>>(std::vector<T>{w, 2 * w, w}, std::vector{p, -p, p});
        RC_ASSERT(three.cancelled && three.p == -p);
    });
}

TYPED_TEST(BlendTest, CancelsBelowAMillionthAndNotAbove) {
    using T = TypeParam;
    // Weights 1 and 1 - d on 1 and -1 leave d of 2 - d. Float rounds 1 - d by 3e-8, 3 per cent of the
    // millionth.
    const std::vector<DualComplex<T>> p{{}, -DualComplex<T>{}};
    const auto blend = [&p](double d) { return dlb<DualComplex<T>>(std::vector<T>{T(1 - d), T(1)}, p); };
    EXPECT_TRUE(blend(1.9e-6).cancelled);
    EXPECT_EQ(blend(1.9e-6).p, p[1]);
    EXPECT_FALSE(blend(2.1e-6).cancelled);
    EXPECT_EQ(blend(2.1e-6).p.p0, std::complex<T>(-1));
}

TYPED_TEST(BlendTest, HeaviestIsTheFirstOfTheGreatestMagnitude) {
    using T = TypeParam;
    EXPECT_EQ(heaviest<T>(std::vector<T>{1}), 0u);
    EXPECT_EQ(heaviest<T>(std::vector<T>{1, 3, 2, 3}), 1u);
    EXPECT_EQ(heaviest<T>(std::vector<T>{1, -3, 2}), 1u);
    EXPECT_EQ(heaviest<T>(std::vector<T>{0, 0}), 0u);
}

TEST(Blend, HalfwayBetweenNothingAndAQuarterTurnIsAnEighth) {
    // (1 + e^{i pi/4}) / |1 + e^{i pi/4}| = e^{i pi/8}, about the same centre.
    const std::complex<double> centre{5, -3};
    const auto turned = rotation(std::numbers::pi / 2, centre);
    const auto blend =
        dlb<DualComplex<double>>(std::vector{2.0, 2.0}, std::vector{DualComplex<double>{}, turned}).p;
    const auto expected = rotation(std::numbers::pi / 4, centre);
    EXPECT_LT(std::abs(blend.p0 - expected.p0), 1e-15);  // a few roundings of numbers up to 1
    EXPECT_LT(std::abs(blend.p1 - expected.p1), 1e-14);  // ... and of numbers up to 6
}

}  // namespace
}  // namespace probewarp
