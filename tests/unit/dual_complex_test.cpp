// What is anti-commutative dual complex numbers' own (MKO, arXiv 1601.01754), over float and double, and its
// examples against numbers worked by hand. The laws they share with space are in transformation_test.cpp.
#include "math/dual_complex.h"

#include <array>

#include "generators.h"

namespace probewarp {
namespace {

using testing::angle;
using testing::expect_always;
using testing::magnitude;
using testing::point;
using testing::real;
using testing::unit_dcn;

constexpr double pi = std::numbers::pi;
constexpr double size = 10;  // of the shifts in the laws

template <class T>
struct DualComplexTest : ::testing::Test {
    static constexpr T epsilon = std::numeric_limits<T>::epsilon();
    // The laws join up to three DCNs of |p1| <= 10 sqrt 2 and one point: some twenty operations, each
    // rounding numbers of up to 60 by half an epsilon.
    static constexpr T rounding = 20 * 60 * epsilon / 2;

    static bool near(const DualComplex<T>& p, const DualComplex<T>& q, T tolerance = rounding) {
        return std::abs(p.p0 - q.p0) <= tolerance && std::abs(p.p1 - q.p1) <= tolerance;
    }
    static DualComplex<T> any() { return *unit_dcn<T>(size); }
    static std::complex<T> any_point() { return *point<T>(size); }
};

using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DualComplexTest, Scalars);

/// A rigid transformation as the matrix of homogeneous coordinates, in double: the turn by t about c, then
/// the shift by d.
struct Rigid {
    double t;
    std::complex<double> c, d;

    using Matrix = std::array<std::array<double, 3>, 3>;
    Matrix matrix() const {
        const double cos = std::cos(t), sin = std::sin(t);
        return {{{cos, -sin, c.real() - cos * c.real() + sin * c.imag() + d.real()},
                 {sin, cos, c.imag() - sin * c.real() - cos * c.imag() + d.imag()},
                 {0, 0, 1}}};
    }
    template <class T>
    DualComplex<T> dcn() const {
        return translation(std::complex<T>(d)) * rotation(T(t), std::complex<T>(c));
    }
    static Rigid any() { return {*angle(1), *point<double>(size), *point<double>(size)}; }
};

Rigid::Matrix operator*(const Rigid::Matrix& a, const Rigid::Matrix& b) {
    Rigid::Matrix product{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) product[i][j] += a[i][k] * b[k][j];
    return product;
}

TYPED_TEST(DualComplexTest, MultipliesAsMatricesDo) {
    expect_always("the matrix of pq is the matrix of p times the matrix of q", [] {
        using T = TypeParam;
        const Rigid a = Rigid::any(), b = Rigid::any();
        const auto v = TestFixture::any_point();
        const Rigid::Matrix m = a.matrix() * b.matrix();
        const std::complex<double> expected{m[0][0] * v.real() + m[0][1] * v.imag() + m[0][2],
                                            m[1][0] * v.real() + m[1][1] * v.imag() + m[1][2]};
        const std::complex<double> got(act(a.dcn<T>() * b.dcn<T>(), v));
        // Besides the laws' rounding, the angles themselves (up to 2 pi) are rounded to T, and turn points
        // that are up to 40 away from a centre.
        RC_ASSERT(std::abs(got - expected) <=
                  double(TestFixture::rounding + 2 * 40 * 8 * TestFixture::epsilon));
    });
}

/// Half angles in all of [-pi, pi], and at its edges and at the threshold of sinc's Taylor branch, on both
/// sides.
template <class T>
rc::Gen<T> half_angle() {
    const auto to_T = [](double h) { return T(h); };
    const double threshold = std::pow(double(std::numeric_limits<T>::epsilon()), 0.25);
    return rc::gen::map(
        rc::gen::oneOf(real(-pi, pi), rc::gen::element(-pi, pi, 0.0, threshold, -threshold),
                       magnitude(-40, -4),
                       rc::gen::map(magnitude(-18, -3), [](double d) { return d < 0 ? -pi - d : pi - d; }),
                       rc::gen::map(magnitude(-18, -1), [=](double d) { return threshold * (1 + d); })),
        to_T);
}

TYPED_TEST(DualComplexTest, ExpOfLogIsTheSame) {
    expect_always("exp(log p) = p and log p is in [-pi, pi)", [] {
        using T = TypeParam;
        const DualComplex<T> p{std::polar(T(1), *half_angle<T>()), TestFixture::any_point()};
        const auto x = log(p);
        RC_ASSERT(x.h >= -std::numbers::pi_v<T> && x.h < std::numbers::pi_v<T>);
        // p0: the roundings of arg (numbers up to pi), cos and sin. p1: one division and one multiplication
        // by the same sinc; numbers up to 15.
        RC_ASSERT(TestFixture::near(exp(x), p, 16 * TestFixture::epsilon));
    });
}

TYPED_TEST(DualComplexTest, ExpOfLogAtExactlyHalfATurnOfTheHalfAngle) {
    using T = TypeParam;
    for (const T zero : {T(0), -T(0)}) {
        const DualComplex<T> p{{T(-1), zero}, {T(3), T(-4)}};
        EXPECT_EQ(log(p).h, -std::numbers::pi_v<T>);
        EXPECT_TRUE(this->near(exp(log(p)), p, 16 * this->epsilon));
    }
}

TYPED_TEST(DualComplexTest, ProductByHand) {
    using D = DualComplex<TypeParam>;
    // p = (1 + 2i) + (3 - i) e, q = (2 - i) + (1 + i) e. By (3.1):
    //   p0 q0          = (1 + 2i)(2 - i) = 4 + 3i
    //   p1 ~q0 + p0 q1 = (3 - i)(2 + i) + (1 + 2i)(1 + i) = (7 + i) + (-1 + 3i) = 6 + 4i
    //   q1 ~p0 + q0 p1 = (1 + i)(1 - 2i) + (2 - i)(3 - i) = (3 - i) + (5 - 5i) = 8 - 6i
    const D p{{1, 2}, {3, -1}}, q{{2, -1}, {1, 1}};
    EXPECT_EQ(p * q, (D{{4, 3}, {6, 4}}));
    EXPECT_EQ(q * p, (D{{4, 3}, {8, -6}}));
    // e i = -i e, e e = 0.
    const D e{{0, 0}, {1, 0}}, i{{0, 1}, {0, 0}};
    EXPECT_EQ(e * i, (D{{0, 0}, {0, -1}}));
    EXPECT_EQ(i * e, (D{{0, 0}, {0, 1}}));
    EXPECT_EQ(e * e, (D{{0, 0}, {0, 0}}));
    EXPECT_EQ(conj(p), (D{{1, -2}, {3, -1}}));
    EXPECT_EQ(norm(D{{3, 4}, {7, 8}}), TypeParam(5));
}

TYPED_TEST(DualComplexTest, RotationByHand) {
    using T = TypeParam;
    // MKO example 3.1 with theta = 90 degrees and c = 2 + i; r = sqrt(1/2):
    //   p0 = e^{i pi/4} = r (1 + i)
    //   p1 = (e^{-i pi/4} - e^{i pi/4}) c/2 = -2 i r (2 + i)/2 = r (1 - 2i)
    // It fixes c, and the point 3 + i, one to the right of c, goes to c + i = 2 + 2i.
    const T r = std::sqrt(T(0.5));
    const std::complex<T> c{2, 1};
    const auto p = rotation(T(pi / 2), c);
    const T tolerance = 8 * this->epsilon;  // a few roundings of numbers up to 4
    EXPECT_TRUE(this->near(p, {{r, r}, {r, -2 * r}}, tolerance)) << p;
    EXPECT_LE(std::abs(act(p, c) - c), tolerance);
    EXPECT_LE(std::abs(act(p, {3, 1}) - std::complex<T>(2, 2)), tolerance);
}

TYPED_TEST(DualComplexTest, RotationTurnsByItsAngleAboutItsCentre) {
    expect_always("p <> (c + v) = c + e^{it} v", [] {
        using T = TypeParam;
        const T t = T(*angle(1));
        const auto c = TestFixture::any_point(), v = TestFixture::any_point();
        const auto p = rotation(t, c);
        RC_ASSERT(std::abs(act(p, c) - c) <= TestFixture::rounding);
        RC_ASSERT(std::abs(act(p, c + v) - (c + std::polar(T(1), t) * v)) <= TestFixture::rounding);
    });
}

TYPED_TEST(DualComplexTest, TranslationByHand) {
    const std::complex<TypeParam> d{6, -4};
    EXPECT_EQ(translation(d), (DualComplex<TypeParam>{{1, 0}, {3, -2}}));
    EXPECT_EQ(act(translation(d), {1, 1}), (std::complex<TypeParam>{7, -3}));
}

TYPED_TEST(DualComplexTest, SlerpByHand) {
    using T = TypeParam;
    using D = DualComplex<T>;
    const T r = std::sqrt(T(0.5)), tolerance = 8 * this->epsilon;  // a few roundings of numbers up to 2
    // (5.1) from p = 1 to q, the turn by 180 degrees about 1: q0 = e^{i pi/2} = i, q1 = (-i - i)/2 = -i.
    //   log q = i pi/2 - (pi/2) i e        (sinc(pi/2) = 2/pi)
    //   t = 1/2: exp(i pi/4 - (pi/4) i e) = r (1 + i) - r i e, the turn by 90 degrees about 1.
    const D half = slerp(D{}, D{{0, 1}, {0, -1}}, T(0.5));
    EXPECT_TRUE(this->near(half, {{r, r}, {0, -r}}, tolerance)) << half;
    // The same from p = 1 + e (a shift by 2) to q p = (i - i e)(1 + e) = i + (-i + i) e = i:
    //   (r (1 + i) - r i e)(1 + e) = r (1 + i) + r (-i + 1 + i) e = r (1 + i) + r e.
    const D after = slerp(D{{1, 0}, {1, 0}}, D{{0, 1}, {0, 0}}, T(0.5));
    EXPECT_TRUE(this->near(after, {{r, r}, {r, 0}}, tolerance)) << after;
    // Between the shifts by 2 and 2 + 4i, a quarter of the way: the shift by 2 + i = 1 + (1 + i/2) e.
    const D shift = slerp(translation(std::complex<T>(2, 0)), translation(std::complex<T>(2, 4)), T(0.25));
    EXPECT_TRUE(this->near(shift, {{1, 0}, {1, T(0.5)}}, tolerance)) << shift;
}

TEST(DualComplex, AWholeTurnIsTheOtherSign) {
    const auto once = rotation(2 * pi, std::complex<double>(3, 4)),
               twice = rotation(4 * pi, std::complex<double>(3, 4));
    // pi itself is rounded by 1.2e-16, and the centre is 5 away.
    EXPECT_LT(std::abs(once.p0 + 1.0), 1e-15);
    EXPECT_LT(std::abs(once.p1), 1e-14);
    EXPECT_LT(std::abs(twice.p0 - 1.0), 1e-15);
}

}  // namespace
}  // namespace probewarp
