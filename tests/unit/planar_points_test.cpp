// The blends of the plane's motions that only the plane has: the spiral, which counts turns without end, and
// moving least squares (Schaefer, McPhail, Warren 2006), which looks at points alone.
#include "generators.h"
#include "math/planar_blend.h"
#include "planar_cases.h"

namespace probewarp {
namespace {

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
struct PointsTest : ::testing::Test {
    using Scalar = typename K::Scalar;
    static constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
    // Means of up to 6 of up to 30 in size: some forty roundings.
    static constexpr Scalar rounding = 40 * 30 * epsilon;
};
TYPED_TEST_SUITE(PointsTest, testing::PlanarKinds);

TYPED_TEST(PointsTest, SpiralBetweenProbesTenTurnsApartIsExactAtBothSmoothBetweenAndTurnsInProportion) {
    using W = typename TypeParam::Weight;
    using T = typename TypeParam::Scalar;
    using C = std::complex<T>;
    const std::vector<Motion<T>> motions{motion(T(0), C(1, 2), C(3, -1)),
                                         motion(T(20 * pi), C(-4, 5), C(6, 7))};
    const auto at = [&](double w) { return spiral<W, T>(std::vector<W>{W(1 - w), W(w)}, motions); };
    EXPECT_EQ(at(0).less_one, motions[0].less_one);
    EXPECT_EQ(at(0).shift, motions[0].shift);
    EXPECT_EQ(at(1).less_one, motions[1].less_one);
    EXPECT_EQ(at(1).shift, motions[1].shift);
    const int steps = 1024;
    for (int k = 0; k < steps; ++k) {
        const double w = double(k) / steps;  // exact in float too
        const auto here = at(w), next = at(w + 1.0 / steps);
        EXPECT_FALSE(here.cancelled);
        // The turn is 20 pi w: rounded by 32 epsilons.
        EXPECT_LE(std::abs(here.less_one - (std::polar(T(1), T(20 * pi * w)) - T(1))), 64 * this->epsilon)
            << w;
        // A point within 10 goes no faster than 20 pi times its distance, up to 17, from the mean rest, and
        // the ways between the probes.
        EXPECT_LE(difference(next, here, size), (20 * pi * 17 + 20) / steps) << w;
    }
}

TYPED_TEST(PointsTest, SpiralIsTheMeanOfThePointsCarriedWithTheMeanTurnAndSoHasNoPole) {
    expect_always("v' = sum w_i (R(m)(v - rest_i) + now_i), any number of turns, within what is summed", [] {
        using T = typename TypeParam::Scalar;
        auto c = close_probes<TypeParam>(size);
        for (auto& m : c.motions) m = motion(T(*angle(20)), m.rest, m.now);
        T total{}, turn{};
        for (std::size_t i = 0; i < c.motions.size(); ++i) {
            total += T(c.weights[i]);
            turn += T(c.weights[i]) * c.motions[i].angle;
        }
        const auto v = *point<T>(size);
        std::complex<T> expected{};
        T farthest{};
        for (std::size_t i = 0; i < c.motions.size(); ++i) {
            const auto& m = c.motions[i];
            expected += T(c.weights[i]) / total * (std::polar(T(1), turn / total) * (v - m.rest) + m.now);
            farthest = std::max(farthest, std::abs(v - m.rest) + std::abs(m.now));
        }
        const auto blend = spiral<typename TypeParam::Weight, T>(c.weights, c.motions);
        // A turn of up to 126 is rounded by up to 6 * 64 epsilons, and turns what is up to 30 away.
        RC_ASSERT(std::abs(act(blend, v) - expected) <=
                  TestFixture::rounding + 400 * 30 * TestFixture::epsilon);
        RC_ASSERT(std::abs(act(blend, v)) <= farthest + TestFixture::rounding);
        RC_ASSERT(!blend.cancelled);
    });
}

TYPED_TEST(PointsTest, SpiralKeepsAProbeWhereItsWeightIsOne) {
    expect_always("weights 0 and 1: the probe's rest goes to where it is now, the picture turned with it",
                  [] {
                      using W = typename TypeParam::Weight;
                      using T = typename TypeParam::Scalar;
                      auto c = close_probes<TypeParam>(size, 60, 60);
                      const auto which = std::size_t(*whole(0, int(c.motions.size()) - 1));
                      for (std::size_t i = 0; i < c.weights.size(); ++i) c.weights[i] = W(i == which);
                      const auto blend = spiral<W, T>(c.weights, c.motions);
                      const auto& m = c.motions[which];
                      RC_ASSERT(blend.less_one == m.less_one);
                      RC_ASSERT(std::abs(act(blend, m.rest) - m.now) <= TestFixture::rounding);
                  });
}

// ---- Moving least squares.

/// Points within `size` of which at least two with weight are apart, on a line one time in three, moved by f.
template <class K, class F>
PlanarCase<K> points_moved(F f) {
    using T = typename K::Scalar;
    PlanarCase<K> c;
    const int count = *whole(2, 6);
    const bool line = *whole(0, 2) == 0;
    const auto start = *point<T>(size / 2), way = std::polar(T(1), T(*real(0, 7)));
    for (int i = 0; i < count; ++i) {
        auto rest = line ? start + way * T(*real(-5, 5)) : *point<T>(size);
        if (i == 1) rest = c.motions[0].rest + way * T(*real(2, 5));
        c.weights.push_back(typename K::Weight(*real(0.1, 1)));
        c.motions.push_back(motion(T(*angle(2)), rest, f(rest)));
    }
    return c;
}

// Points at least 2 apart with weights of at least 0.1: their spread is at least 0.1 0.1 2^2 / 1.1^2 or so of
// six times as much, 1/50; the quotient by it is rounded by that much more.
template <class K>
constexpr typename K::Scalar mls_rounding = 50 * PointsTest<K>::rounding;

TYPED_TEST(PointsTest, MlsSimilarityReproducesASimilarityThatThePointsMadeAlsoOnALine) {
    expect_always("now_i = a rest_i + b gives a and b", [] {
        using T = typename TypeParam::Scalar;
        const auto a = *point<T>(2), b = *point<T>(size);
        const auto c = points_moved<TypeParam>([&](const auto& x) { return a * x + b; });
        const auto blend = mls_similarity<typename TypeParam::Weight, T>(c.weights, c.motions);
        RC_ASSERT(difference(blend, Similarity<T>{a - T(1), b}, size) <= mls_rounding<TypeParam>);
        RC_ASSERT(!blend.cancelled);
    });
}

TYPED_TEST(PointsTest, MlsReproducesARigidMotionThatThePointsMadeAlsoOnALine) {
    expect_always("now_i = e^{it} rest_i + b gives t and b, by both", [] {
        using T = typename TypeParam::Scalar;
        const auto a = std::polar(T(1), T(*angle(1))), b = *point<T>(size);
        const auto c = points_moved<TypeParam>([&](const auto& x) { return a * x + b; });
        for (const auto& method : testing::mls_methods<TypeParam>())
            RC_ASSERT(difference(method(c), Similarity<T>{a - T(1), b}, size) <= mls_rounding<TypeParam>);
    });
}

TYPED_TEST(PointsTest, MlsRigidIsRigidAndTheSimilarityWithoutItsScale) {
    expect_always("|a| = 1, a the direction of the similarity's; both take the centre p* to q*", [] {
        using T = typename TypeParam::Scalar;
        using W = typename TypeParam::Weight;
        const auto c = points_moved<TypeParam>([](const auto& x) { return x + *point<T>(4); });
        const auto rigid = mls_rigid<W, T>(c.weights, c.motions),
                   free = mls_similarity<W, T>(c.weights, c.motions);
        const auto a = T(1) + rigid.less_one, s = T(1) + free.less_one;
        RC_PRE(std::abs(s) > T(0.1));
        RC_ASSERT(!rigid.cancelled);
        RC_ASSERT(std::abs(std::abs(a) - 1) <= 4 * TestFixture::epsilon);
        RC_ASSERT(std::abs(a - s / std::abs(s)) <= mls_rounding<TypeParam>);
        std::complex<T> p{}, q{};
        T total{};
        for (std::size_t i = 0; i < c.motions.size(); ++i) {
            p += T(c.weights[i]) * c.motions[i].rest, q += T(c.weights[i]) * c.motions[i].now;
            total += T(c.weights[i]);
        }
        RC_ASSERT(std::abs(act(rigid, p / total) - q / total) <= TestFixture::rounding);
        RC_ASSERT(std::abs(act(free, p / total) - q / total) <= TestFixture::rounding);
    });
}

TYPED_TEST(PointsTest, MlsIsTheLeastOfTheSquares) {
    expect_always("no similarity, and for mls_rigid no rigid motion, takes the points nearer", [] {
        using T = typename TypeParam::Scalar;
        using W = typename TypeParam::Weight;
        const auto c = points_moved<TypeParam>([](const auto& x) { return x + *point<T>(4); });
        const auto squares = [&](const Similarity<T>& s) {
            T sum{};
            for (std::size_t i = 0; i < c.motions.size(); ++i)
                sum += T(c.weights[i]) * std::norm(act(s, c.motions[i].rest) - c.motions[i].now);
            return sum;
        };
        const auto free = mls_similarity<W, T>(c.weights, c.motions),
                   rigid = mls_rigid<W, T>(c.weights, c.motions);
        const auto aside = *point<T>(0.3), turn = std::polar(T(1), T(*real(-0.3, 0.3)));
        // Squares of up to 6 * 20^2, rounded a few times.
        const T rounded = 8 * 2400 * TestFixture::epsilon;
        RC_ASSERT(squares(free) <= squares({free.less_one + aside, free.shift}) + rounded);
        RC_ASSERT(squares(free) <= squares({free.less_one, free.shift + aside}) + rounded);
        RC_ASSERT(squares(free) <= squares(rigid) + rounded);
        RC_PRE(!rigid.cancelled);
        RC_ASSERT(squares(rigid) <= squares({(T(1) + rigid.less_one) * turn - T(1), rigid.shift}) + rounded);
        RC_ASSERT(squares(rigid) <= squares({rigid.less_one, rigid.shift + aside}) + rounded);
    });
}

TYPED_TEST(PointsTest, MlsCommutesWithRigidMotionsOfThePointsInEitherFrame) {
    expect_always("rests moved by g, places now by k: k after it after g undone", [] {
        using T = typename TypeParam::Scalar;
        const auto c = points_moved<TypeParam>([](const auto& x) { return x + *point<T>(1); });
        const auto g = motion(T(*angle(1)), *point<T>(size), *point<T>(size)),
                   k = motion(T(*angle(1)), *point<T>(size), *point<T>(size));
        auto moved = c;
        for (auto& m : moved.motions)
            m = motion(m.angle, act(similarity(g), m.rest), act(similarity(k), m.now));
        for (const auto& method : testing::mls_methods<TypeParam>()) {
            const auto expected =
                testing::after(similarity(k), testing::after(method(c), testing::undone(similarity(g))));
            if (!(difference(method(moved), expected, size) <= 8 * mls_rounding<TypeParam>))
                RC_FAIL(method.name);
        }
    });
}

TYPED_TEST(PointsTest, MlsMindsNeitherScaleNorOrderNorTurns) {
    expect_always("blend(s w, m) = blend(w, m) in another order, with other turns", [] {
        using T = typename TypeParam::Scalar;
        const auto c = points_moved<TypeParam>([](const auto& x) { return x + *point<T>(1); });
        auto other = c;
        const double scale =
            std::ldexp(1, *whole(-60, 60));  // exact, so that float's weights keep their shares
        for (auto& w : other.weights) w = typename TypeParam::Weight(w * scale);
        for (auto& m : other.motions) m = motion(T(*angle(3)), m.rest, m.now);
        std::reverse(other.weights.begin(), other.weights.end());
        std::reverse(other.motions.begin(), other.motions.end());
        for (const auto& method : testing::mls_methods<TypeParam>())
            if (!(difference(method(c), method(other), size) <= mls_rounding<TypeParam>))
                RC_FAIL(method.name);
    });
}

TYPED_TEST(PointsTest, MlsTranslatesWherePointsCoincideWhateverTheRoundingOfTheirMean) {
    expect_always("rests (or, rigid, places now) in one point: the mean way, and no turn or scale at all",
                  [] {
                      using T = typename TypeParam::Scalar;
                      PlanarCase<TypeParam> c;
                      const auto one = std::complex<T>(T(*magnitude(-3, 7)), T(*magnitude(-3, 7)));
                      const int count = *whole(1, 6);
                      for (int i = 0; i < count; ++i) {
                          c.weights.push_back(typename TypeParam::Weight(*real(0.1, 3)));
                          c.motions.push_back(motion(T(*angle(1)), one, *point<T>(100)));
                      }
                      for (const auto& method : testing::mls_methods<TypeParam>()) {
                          const auto blend = method(c);
                          RC_ASSERT(blend.less_one == std::complex<T>(0));
                          RC_ASSERT(!blend.cancelled);
                      }
                      for (auto& m : c.motions) m = motion(m.angle, m.now, m.rest);
                      const auto blend = mls_rigid<typename TypeParam::Weight, T>(c.weights, c.motions);
                      RC_ASSERT(blend.less_one == std::complex<T>(0));
                      RC_ASSERT(!blend.cancelled);
                  });
}

TYPED_TEST(PointsTest, MlsByHand) {
    using W = typename TypeParam::Weight;
    using T = typename TypeParam::Scalar;
    using C = std::complex<T>;
    const auto at = [](C rest, C now) { return motion(T(0), rest, now); };
    // 0 and 2, weights 1 and 3: p* = 1.5, spread = (2.25 + 3 * 0.25) / 4 = 0.75. Now 1 and 1 + 4i: q* = 1 +
    // 3i, spread (9 + 3) / 4 = 3. Twice as large and a quarter turn: a = 2i, b = 1.
    const std::vector<W> weights{1, 3};
    const std::vector<Motion<T>> two{at(0, 1), at(2, C(1, 4))};
    const auto s = least_squares<W, T>(weights, two);
    const T tolerance = 8 * this->epsilon;  // a few roundings of numbers up to 4
    EXPECT_LE(std::abs(s.rest - C(T(1.5))), tolerance);
    EXPECT_LE(std::abs(s.way - C(T(-0.5), 3)), tolerance);
    EXPECT_NEAR(s.spread, 0.75, tolerance);
    EXPECT_NEAR(s.spread_now, 3, tolerance);
    EXPECT_LE(std::abs(s.way_spread - T(0.75) * C(-1, 2)), tolerance);
    EXPECT_LE(difference(mls_similarity<W, T>(weights, two), {C(-1, 2), 1}, 1), 4 * tolerance);
    EXPECT_LE(difference(mls_rigid<W, T>(weights, two), {C(-1, 1), C(1, T(1.5))}, 1), 4 * tolerance);
    // A square turned over, as a mirror would: no rotation is better than another. The similarity shrinks it
    // to its centre instead.
    const std::vector<Motion<T>> mirror{at(1, 1), at(C(0, 1), C(0, -1)), at(-1, -1), at(C(0, -1), C(0, 1))};
    const std::vector<W> alike{2, 2, 2, 2};
    EXPECT_TRUE((mls_rigid<W, T>(alike, mirror).cancelled));
    EXPECT_LE(difference(mls_similarity<W, T>(alike, mirror), {C(-1), C(0)}, 1), tolerance);
    // Stretched along x by x, it is 2 x of 4 from that; a millionth of the root of 1 and (1 + (1 + x)^2) / 2.
    const auto stretched = [&](double x) {
        auto m = mirror;
        for (const std::size_t i : {0u, 2u}) m[i] = at(m[i].rest, m[i].now * T(1 + x));
        return mls_rigid<W, T>(alike, m);
    };
    // Float's 1 + x is within 6e-8.
    EXPECT_TRUE(stretched(1.8e-6).cancelled);
    EXPECT_FALSE(stretched(2.2e-6).cancelled);
    EXPECT_LE(std::abs(stretched(0.5).less_one), tolerance);
}

}  // namespace
}  // namespace probewarp
