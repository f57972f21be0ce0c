// MKO, Table 1: DCN costs at most what the paper says, and the counting itself is right.
#include "flops.h"

#include <gtest/gtest.h>

#include "counting.h"
#include "math/matrix.h"

namespace probewarp::papers {
namespace {

TEST(Counting, CountsEachOperationAndNotNegationsNorComparisons) {
    const Counting a = 2, b = 3;
    const auto done = count([&] {
        Counting c = a + b - a;  // 2 additions
        c += a * b;              // 1, and 1 multiplication
        c /= sqrt(-a * -b);      // 1 division, 1 root, 1 multiplication
        if (c < a) c = sin(c);   // (2 + 3 - 2 + 6) / sqrt(6) = 3.67: not done
        c = atan2(abs(c), b);    // 1 function
    });
    EXPECT_EQ(done,
              (Operations{.additions = 3, .multiplications = 2, .divisions = 1, .roots = 1, .functions = 1}));
    EXPECT_EQ(done.flops(), 7);
}

TEST(Counting, ComplexAndQuaternionProductsCostWhatTheirFormulasSay) {
    const std::complex<Counting> z(1, 2), w(3, 4);
    EXPECT_EQ(count([&] { z* w; }), (Operations{.additions = 2, .multiplications = 4}));
    const Quaternion<Counting> p(1, 2, 3, 4), q(5, 6, 7, 8);
    EXPECT_EQ(count([&] { p* q; }), (Operations{.additions = 12, .multiplications = 16}));
}

TEST(Counting, ReckonsAsDoubleDoes) {
    const DualComplex<double> p = rotation(0.5, std::complex<double>(3, 4));
    const DualComplex<Counting> c{{p.p0.real(), p.p0.imag()}, {p.p1.real(), p.p1.imag()}};
    const auto expected = act(p, std::complex<double>(1, 2));
    const auto counted = act(c, std::complex<Counting>(1, 2));
    // The compiler may contract one of the two: a rounding each of numbers up to 10.
    EXPECT_NEAR(counted.real().value, expected.real(), 1e-14);
    EXPECT_NEAR(counted.imag().value, expected.imag(), 1e-14);
}

TEST(Flops, NoneIsAboveThePapers) {
    int compared = 0;
    for (const auto& [name, ours, paper] : representations()) {
        if (!paper) continue;
        ++compared;
        EXPECT_LE(ours.transform, paper->transform) << name;
        EXPECT_LE(ours.compose, paper->compose) << name;
        EXPECT_LE(ours.convert, paper->convert) << name;
        EXPECT_LE(ours.scalars, paper->scalars) << name;
    }
    EXPECT_EQ(compared, 1);
}

TEST(Flops, DcnIsTheSmallestAndTheCheapestToCompose) {
    const auto rows = representations();
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_EQ(rows[0].name, "DCN");
    for (std::size_t i = 1; i < rows.size(); ++i) {
        EXPECT_LT(rows[0].ours.scalars, rows[i].ours.scalars) << rows[i].name;
        EXPECT_LT(rows[0].ours.compose, rows[i].ours.compose) << rows[i].name;
    }
}

TEST(Flops, TheTableIsWhatTheFormulasCostByHand) {
    const auto rows = representations();
    const auto expect = [&](std::size_t i, int transform, int compose, int convert, int scalars) {
        EXPECT_EQ(rows[i].ours.transform, transform) << rows[i].name;
        EXPECT_EQ(rows[i].ours.compose, compose) << rows[i].name;
        EXPECT_EQ(rows[i].ours.convert, convert) << rows[i].name;
        EXPECT_EQ(rows[i].ours.scalars, scalars) << rows[i].name;
    };
    // Two complex products (6 each), one doubling and one sum (2 each). Three products and a sum. A product,
    // and 6 for the cosine, the sine and two doublings.
    expect(0, 16, 20, 12, 4);
    // Two cross products (9) and nine vectors' sums or multiples (3). Three quaternions' products (28) and a
    // sum (4). 30 for the rotation, a quaternions' product and three doublings.
    expect(1, 45, 88, 61, 8);
    // As DCN. Eight complex products and four sums. As DCN.
    expect(2, 16, 56, 12, 8);
    // Four products and four sums. 27 and 18. Nothing.
    expect(3, 8, 45, 0, 9);
}

}  // namespace
}  // namespace probewarp::papers
