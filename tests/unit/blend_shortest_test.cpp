// DLB the shortest way (Kavan et al., TCD-CS-2006-46, section 4): it depends neither on the signs of what it
// blends nor on their order, also where two ways are as short; and every blend in the plane is the same in
// space.
#include "generators.h"
#include "math/blend.h"

namespace probewarp {
namespace {

using testing::any_log;
using testing::any_unit;
using testing::any_vector;
using testing::difference;
using testing::difference_of_motions;
using testing::expect_always;
using testing::real;
using testing::whole;

constexpr double pi = std::numbers::pi;
constexpr double size = 10;  // of the shifts

template <class P>
struct Case {
    std::vector<typename P::Scalar> weights;
    std::vector<P> p;
};

/// A shift after a turn by a multiple of a quarter, in space after a second one about another axis: many are
/// half a turn apart, so that both ways are as short, and many sets of them have no mean.
template <class P>
P quarters() {
    using T = typename P::Scalar;
    const auto angle = [] { return T(pi / 2) * T(*whole(-4, 4)); };
    if constexpr (testing::in_plane<P>) {
        return translation(*testing::point<T>(size)) * rotation(angle(), std::complex<T>(0));
    } else {
        const auto axis = [] {
            glm::vec<3, T> v(T(0));
            v[*whole(0, 2)] = T(1);
            return v;
        };
        return translation(any_vector<T>(size)) * rotation(angle(), axis()) * rotation(angle(), axis());
    }
}

template <class P>
Case<P> ties() {
    Case<P> c;
    const int count = *whole(2, 6);
    for (int i = 0; i < count; ++i) {
        c.weights.push_back(typename P::Scalar(*whole(1, 2)));
        c.p.push_back(quarters<P>());
    }
    return c;
}

template <class P>
Case<P> in_any_order_with_any_signs(Case<P> c) {
    for (std::size_t i = c.p.size(); i > 0; --i) {
        const auto j = std::size_t(*whole(0, int(i) - 1));
        std::swap(c.p[i - 1], c.p[j]);
        std::swap(c.weights[i - 1], c.weights[j]);
        if (*whole(0, 1)) c.p[i - 1] = -c.p[i - 1];
    }
    return c;
}

template <class P>
struct ShortestTest : ::testing::Test {
    static constexpr typename P::Scalar epsilon = std::numeric_limits<typename P::Scalar>::epsilon();
    // Sums of up to 6 of up to 35 in size, a division by a share of at least 1/6 (twice in the dual norm).
    static constexpr typename P::Scalar rounding = 20 * 35 * 36 * epsilon;

    static Blend<P> blend(const Case<P>& c) { return dlb_shortest<P>(c.weights, c.p); }
};

TYPED_TEST_SUITE(ShortestTest, testing::Transformations);

TYPED_TEST(ShortestTest, DependsNeitherOnOrderNorOnSignsAlsoWithTiesAndWithoutAMean) {
    expect_always("any order, any signs: the same up to its own sign, and never cancelled", [] {
        const auto c = ties<TypeParam>();
        const auto plain = TestFixture::blend(c), other = TestFixture::blend(in_any_order_with_any_signs(c));
        RC_ASSERT(!plain.cancelled);
        RC_ASSERT(!other.cancelled);
        RC_ASSERT(difference_of_motions(plain.p, other.p) <= TestFixture::rounding);
    });
}

TYPED_TEST(ShortestTest, DependsNeitherOnOrderNorOnSignsAmongAny) {
    expect_always("any order, any signs, any turns", [] {
        using T = typename TypeParam::Scalar;
        Case<TypeParam> c;
        const int count = *whole(1, 8);
        for (int i = 0; i < count; ++i) {
            c.weights.push_back(T(*real(0.01, 1)));
            c.p.push_back(any_unit<TypeParam>(size));
        }
        const auto plain = TestFixture::blend(c);
        // Where both ways are nearly as short, rounding may tell; the test above has those it does not.
        const auto middle = pivot<T>(c.weights, c.p);
        for (const auto& p : c.p) RC_PRE(std::abs(rotation_dot(p, middle)) > T(1e-3));
        RC_ASSERT(difference_of_motions(plain.p, TestFixture::blend(in_any_order_with_any_signs(c)).p) <=
                  TestFixture::rounding);
    });
}

TYPED_TEST(ShortestTest, IsDlbWhereAllAreWithinHalfATurnOfOneAnother) {
    expect_always("the signs put right, dlb_shortest is dlb", [] {
        using T = typename TypeParam::Scalar;
        Case<TypeParam> c;
        const auto middle = any_unit<TypeParam>(size);
        const int count = *whole(1, 6);
        for (int i = 0; i < count; ++i) {
            c.weights.push_back(T(*real(0.01, 1)));
            c.p.push_back(exp(any_log<TypeParam>(T(*real(-0.7, 0.7)), size)) * middle);
        }
        const auto expected = dlb<TypeParam>(c.weights, c.p).p;
        const auto got = TestFixture::blend(in_any_order_with_any_signs(c)).p;
        RC_ASSERT(difference_of_motions(got, expected) <= TestFixture::rounding);
    });
}

TYPED_TEST(ShortestTest, PivotMaximisesTheSumOfSquares) {
    expect_always("sum w_i <p0_i, u>^2 is nowhere greater than at the pivot", [] {
        using T = typename TypeParam::Scalar;
        auto c = ties<TypeParam>();
        c.weights[0] = T(13);  // more than all the others together: one u is best
        const auto sum = [&](const TypeParam& u) {
            T total{};
            for (std::size_t i = 0; i < c.p.size(); ++i) {
                const T dot = rotation_dot(c.p[i], u);
                total += c.weights[i] * dot * dot;
            }
            return total;
        };
        const auto u = pivot<T>(c.weights, c.p), other = any_unit<TypeParam>(size);
        // The eigenvector is as near to a unit as a few rotations of the solver's leave it.
        RC_ASSERT(std::abs(rotation_dot(u, u) - 1) <= 32 * TestFixture::epsilon);
        const T tolerance = 32 * 23 * TestFixture::epsilon;  // the same, of sums of up to 23
        RC_ASSERT(sum(u) >= sum(other) - tolerance);
        for (const auto& p : c.p) RC_ASSERT(sum(u) >= sum(normalised(u + T(0.01) * p)) - tolerance);
    });
}

TYPED_TEST(ShortestTest, OfTwoHalfATurnApartGoesTheSameWayWhateverTheirSigns) {
    using P = TypeParam;
    using T = typename P::Scalar;
    const auto turn = [](double degrees) { return testing::turn_in_plane<P>(degrees); };
    const T tolerance = 8 * this->epsilon;  // a few roundings of numbers up to 1
    const auto of = [&](double a, double b, T weight) {
        return TestFixture::blend({{T(1), weight}, {turn(a), turn(b)}}).p;
    };
    // 0 and 180, weights 1 and 1: the least turn is the pivot, and from it clockwise: 90. With 2 for the
    // second that is the pivot, and from it 90 more.
    for (const double whole : {0.0, 360.0}) {
        EXPECT_LE(difference_of_motions(of(0, 180 + whole, 1), turn(90)), tolerance);
        EXPECT_LE(difference_of_motions(of(180 + whole, 0, 1), turn(90)), tolerance);
        EXPECT_LE(difference_of_motions(of(90 + whole, -90, 1), turn(180)), tolerance);
        const double further = 2 * std::atan2(1.0, 2.0) * 180 / pi;
        EXPECT_LE(difference_of_motions(of(0, 180 + whole, 2), turn(180 + further)), tolerance);
        EXPECT_LE(difference_of_motions(of(0 + whole, 180, T(0.5)), turn(further)), tolerance);
    }
}

TYPED_TEST(ShortestTest, EqualsAreRankedByHowLittleTheyTurnThenClockwise) {
    using P = TypeParam;
    using T = typename P::Scalar;
    const auto turn = [](double degrees) { return testing::turn_in_plane<P>(degrees); };
    const auto first = [&](std::vector<T> weights, std::vector<double> degrees) {
        return pivot_of_equals(std::span<const T>(weights), [&](std::size_t i) { return turn(degrees[i]); });
    };
    EXPECT_EQ(first({1, 2, 1}, {0, 90, 0}), 1u);      // the heaviest
    EXPECT_EQ(first({1, 1, 1}, {100, -80, 90}), 1u);  // the least turn
    EXPECT_EQ(first({1, 1, 1}, {-90, 90, -90}), 1u);  // clockwise
    EXPECT_EQ(first({1, 1}, {-90, 450}), 1u);         // 450 degrees are 90 and -p
    EXPECT_EQ(first({1, 1}, {120, 330}), 1u);         // 330 are -30
}

// ---- The plane inside space (MKO, arXiv 1601.01754, section 4).

template <class T>
struct PlaneInSpaceTest : ::testing::Test {
    using Plane = DualComplex<T>;
    using Space = DualQuaternion<T>;
    static constexpr T epsilon = std::numeric_limits<T>::epsilon();

    static std::vector<Space> embedded(const std::vector<Plane>& p) {
        std::vector<Space> q;
        for (const auto& x : p) q.push_back(embed(x));
        return q;
    }
};

using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(PlaneInSpaceTest, Scalars);

TYPED_TEST(PlaneInSpaceTest, EveryBlendIsTheSame) {
    expect_always("embed(blend(w, p_i)) = blend(w, embed(p_i))", [] {
        using T = TypeParam;
        Case<DualComplex<T>> c;
        const auto middle = exp(any_log<DualComplex<T>>(T(*real(-1, 1)), size));
        const int count = *whole(1, 6);
        for (int i = 0; i < count; ++i) {
            c.weights.push_back(T(*real(0.01, 1)) / T(count));
            c.p.push_back(exp(any_log<DualComplex<T>>(T(*real(-0.6, 0.6)), size)) * middle);
        }
        using Q = typename TestFixture::Space;
        const auto q = TestFixture::embedded(c.p);
        const auto& w = c.weights;
        const T rounding = 40 * 60 * TestFixture::epsilon;   // as in blend_test.cpp
        const T precision = 12 * 30 * TestFixture::epsilon;  // as there
        RC_ASSERT(difference(embed(dlb<DualComplex<T>>(w, c.p).p), dlb<Q>(w, q).p) <= rounding);
        RC_ASSERT(difference(embed(log_linear<DualComplex<T>>(w, c.p)), log_linear<Q>(w, q)) <= rounding);
        const auto plane = dib<DualComplex<T>>(w, c.p, precision), space = dib<Q>(w, q, precision);
        RC_ASSERT(plane.converged && space.converged);
        RC_ASSERT(difference(embed(plane.p), space.p) <= rounding + 4 * precision);
        RC_ASSERT(difference_of_motions(embed(dlb_shortest<DualComplex<T>>(w, c.p).p),
                                        dlb_shortest<Q>(w, q).p) <= rounding);
    });
}

TYPED_TEST(PlaneInSpaceTest, TheShortestWayIsTheSameAlsoWithTiesAndWithoutAMean) {
    expect_always("embed(dlb_shortest(w, p_i)) = dlb_shortest(w, embed(p_i)) up to sign", [] {
        using P = typename TestFixture::Plane;
        using Q = typename TestFixture::Space;
        const auto c = ties<P>();
        const auto plane = dlb_shortest<P>(c.weights, c.p);
        const auto space = dlb_shortest<Q>(c.weights, TestFixture::embedded(c.p));
        RC_ASSERT(difference_of_motions(embed(plane.p), space.p) <= ShortestTest<Q>::rounding);
    });
}

TYPED_TEST(PlaneInSpaceTest, DibGoesTheSameWayAlsoFromAWholeTurn) {
    using T = TypeParam;
    using P = DualComplex<T>;
    using Q = DualQuaternion<T>;
    // 1 and -1 with 3/4 and 1/4: log(-1) is -pi i in both, and so a quarter of it is reached.
    const std::vector<T> weights{T(0.75), T(0.25)};
    const std::vector<P> p{P{}, -P{}};
    const auto plane = dib<P>(weights, p, T(1e-5)),
               space = dib<Q>(weights, TestFixture::embedded(p), T(1e-5));
    EXPECT_TRUE(plane.converged && space.converged);
    EXPECT_NEAR(plane.p.p0.real(), std::cos(pi / 4), 1e-5);
    EXPECT_NEAR(plane.p.p0.imag(), -std::sin(pi / 4), 1e-5);
    EXPECT_LE(difference(embed(plane.p), space.p), 1e-5);
}

}  // namespace
}  // namespace probewarp
