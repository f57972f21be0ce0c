// The laws of dual numbers (Kavan et al., TCD-CS-2006-46, section 3), and the functions with a removable
// singularity that exp and log need, on both sides of their thresholds.
#include "math/dual.h"

#include "generators.h"
#include "math/sinc.h"

namespace probewarp {
namespace {

using testing::expect_always;
using testing::real;

template <class T>
struct DualTest : ::testing::Test {
    static constexpr T epsilon = std::numeric_limits<T>::epsilon();

    static bool near(const Dual<T>& x, const Dual<T>& y, T tolerance) {
        return std::abs(x.real - y.real) <= tolerance && std::abs(x.dual - y.dual) <= tolerance;
    }
    static Dual<T> any() { return {T(*real(-3, 3)), T(*real(-3, 3))}; }
};

using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DualTest, Scalars);

TYPED_TEST(DualTest, IsACommutativeRing) {
    expect_always("(xy)z = x(yz), xy = yx, x(y + z) = xy + xz, (x - y) + y = x", [] {
        const auto x = TestFixture::any(), y = TestFixture::any(), z = TestFixture::any();
        const TypeParam tolerance = 8 * 81 * TestFixture::epsilon;  // eight roundings of sums of 3 * 27
        RC_ASSERT(TestFixture::near((x * y) * z, x * (y * z), tolerance));
        RC_ASSERT(TestFixture::near(x * y, y * x, tolerance));
        RC_ASSERT(TestFixture::near(x * (y + z), x * y + x * z, tolerance));
        RC_ASSERT(TestFixture::near((x - y) + y, x, tolerance));
    });
}

TYPED_TEST(DualTest, ByHand) {
    using D = Dual<TypeParam>;
    // (2 + 3e)(5 - e) = 10 + (-2 + 15) e; e e = 0; (2 + 3e)^-1 = 1/2 - (3/4) e; sqrt(4 + 3e) = 2 + (3/4) e.
    EXPECT_EQ((D{2, 3} * D{5, -1}), (D{10, 13}));
    EXPECT_EQ((D{0, 1} * D{0, 1}), (D{0, 0}));
    EXPECT_EQ((D{2, 3} + D{5, -1}), (D{7, 2}));
    EXPECT_EQ((D{2, 3} - D{5, -1}), (D{-3, 4}));
    EXPECT_EQ(conj(D{2, 3}), (D{2, -3}));
    EXPECT_EQ(inverse(D{2, 3}), (D{TypeParam(0.5), TypeParam(-0.75)}));
    EXPECT_EQ(sqrt(D{4, 3}), (D{2, TypeParam(0.75)}));
    // sin(x + y e) = sin x + y cos x e, cos(x + y e) = cos x - y sin x e.
    EXPECT_EQ(sin(D{0, 3}), (D{0, 3}));
    EXPECT_EQ(cos(D{0, 3}), (D{1, 0}));
    EXPECT_EQ(cos(D{TypeParam(0.5), 2}).dual, -2 * std::sin(TypeParam(0.5)));
}

TYPED_TEST(DualTest, ConjugateOfAProduct) {
    expect_always("~(xy) = ~x ~y; x ~x is real", [] {
        const auto x = TestFixture::any(), y = TestFixture::any();
        RC_ASSERT(conj(x * y) == conj(x) * conj(y));  // exactly: the same products
        RC_ASSERT((x * conj(x)).dual == 0);
    });
}

TYPED_TEST(DualTest, InverseAndRootUndo) {
    expect_always("x x^-1 = 1, sqrt(x)^2 = x", [] {
        using T = TypeParam;
        const Dual<T> x{T(*real(0.1, 3)), T(*real(-3, 3))};
        // The inverse's dual part is up to 300, the root's up to 3 / 0.6.
        RC_ASSERT(TestFixture::near(x * inverse(x), {T(1), T(0)}, 2 * 300 * TestFixture::epsilon));
        RC_ASSERT(TestFixture::near(sqrt(x) * sqrt(x), x, 4 * 5 * TestFixture::epsilon));
    });
}

TYPED_TEST(DualTest, SineAndCosineAddAngles) {
    expect_always("sin(x + y) = sin x cos y + cos x sin y, sin^2 + cos^2 = 1", [] {
        const auto x = TestFixture::any(), y = TestFixture::any();
        const TypeParam tolerance = 8 * 12 * TestFixture::epsilon;  // eight roundings of sums of 4 * 3
        RC_ASSERT(TestFixture::near(sin(x + y), sin(x) * cos(y) + cos(x) * sin(y), tolerance));
        RC_ASSERT(TestFixture::near(cos(x + y), cos(x) * cos(y) - sin(x) * sin(y), tolerance));
        RC_ASSERT(TestFixture::near(sin(x) * sin(x) + cos(x) * cos(x), {1, 0}, tolerance));
    });
}

/// Numbers about a threshold and away from it.
template <class T>
std::vector<T> both_sides(T threshold) {
    return {T(0),
            threshold / 1000,
            threshold / 8,
            threshold / 2,
            std::nextafter(threshold, T(0)),
            threshold,
            std::nextafter(threshold, T(9)),
            2 * threshold,
            T(1),
            T(2),
            T(3),
            T(3.14)};
}

TYPED_TEST(DualTest, SincIsExactOnBothSidesOfItsThreshold) {
    using T = TypeParam;
    for (const T h : both_sides(std::sqrt(std::sqrt(this->epsilon))))
        for (const T sign : {T(1), T(-1)}) {
            const long double x = h;
            const long double expected = x == 0 ? 1 : std::sin(x) / x;
            // Two roundings of a number up to 1, and the Taylor polynomial's next term, h^4/120 <
            // epsilon/120.
            EXPECT_NEAR(double(sinc(sign * h)), double(expected), double(1.1 * this->epsilon)) << h;
        }
}

/// The series of (cos h - sinc h) / h^2 = sum over n >= 1 of (-1)^n 2n h^{2n-2} / (2n + 1)!, in long double.
long double sinc_slope_series(long double h) {
    long double sum = 0, term = 1;  // (-1)^n h^{2n-2} / (2n + 1)!, but for h^2 at n = 0
    for (int n = 1; n < 30; ++n) {
        term *= -1.0L / ((2 * n) * (2 * n + 1)) * (n == 1 ? 1 : h * h);
        sum += 2 * n * term;
    }
    return sum;
}

TYPED_TEST(DualTest, SincSlopeIsExactOnBothSidesOfItsThreshold) {
    using T = TypeParam;
    const T threshold = std::pow(T(1e6) * this->epsilon, T(0.125));
    for (const T h : both_sides(threshold))
        for (const T sign : {T(1), T(-1)}) {
            // Below: the next term, h^8/3991680 <= epsilon/4, and three roundings of numbers up to 1/3.
            // Above: three roundings of numbers up to 1, divided by h^2.
            const double tolerance =
                h < threshold ? 0.75 * double(this->epsilon) : 1.5 * double(this->epsilon) / double(h * h);
            EXPECT_NEAR(double(sinc_slope(sign * h)), double(sinc_slope_series(h)), tolerance) << h;
        }
}

TEST(SincSlope, IsTheDerivativeOfSincOverH) {
    // By a central difference of sinc: its error is step^2 / 6 times the third derivative, below 1/5, and the
    // rounding of sinc over the step.
    const double step = 1e-5;
    for (const double h : {0.01, 0.06, 0.065, 0.5, 1.5, 3.0}) {
        const double difference = (sinc(h + step) - sinc(h - step)) / (2 * step);
        EXPECT_NEAR(h * sinc_slope(h), difference, step * step / 30 + 2e-16 / step) << h;
    }
}

}  // namespace
}  // namespace probewarp
