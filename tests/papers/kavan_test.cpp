// Kavan, sections 4 and 5: the bounds of DLB against ScLERP, Lemma 3, and DIB's steps.
#include "kavan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "random.h"

namespace probewarp::papers {
namespace {

using std::numbers::pi;

TEST(DlbAgainstSclerp, TheExactWorstIsThePapers) {
    const WorstGaps exact = closed_form_worst();
    // To the digits that the paper gives: 8.15 degrees, 15 %.
    EXPECT_NEAR(exact.angle.most * 180 / pi, 8.15, 0.005);
    EXPECT_LT(exact.angle.most * 180 / pi, 8.15);
    EXPECT_NEAR(100 * exact.shift.most, 15, 0.5);
}

TEST(DlbAgainstSclerp, TheSearchedWorstIsTheExactOne) {
    const WorstGaps searched = searched_worst(), exact = closed_form_worst();
    // Values: roundings of numbers up to pi. Places: a maximum is flat to the root of that.
    EXPECT_NEAR(searched.angle.most, exact.angle.most, 1e-14);
    EXPECT_NEAR(searched.shift.most, exact.shift.most, 1e-14);
    EXPECT_NEAR(searched.angle.t, exact.angle.t, 1e-6);
    EXPECT_NEAR(searched.shift.t, exact.shift.t, 1e-6);
}

TEST(DlbAgainstSclerp, AMillionRandomPairsStayBelowTheWorstAndComeWithinAHundredthOfIt) {
    const Gap random = worst_of_random_pairs(1'000'000);
    const WorstGaps exact = closed_form_worst();
    EXPECT_LT(random.angle, exact.angle.most);
    EXPECT_LT(random.shift, exact.shift.most);
    EXPECT_GT(random.angle, 0.99 * exact.angle.most);
    EXPECT_GT(random.shift, 0.99 * exact.shift.most);
    EXPECT_LT(random.axis, 1e-14);  // two products of numbers up to 5 differ by roundings
}

TEST(DlbAgainstSclerp, TheGapIsNothingAtTheEndsAndHalfway) {
    Random random;
    const auto p = random.anywhere(), q = random.within(2) * p;
    const auto near = rotation_dot(p, q) < 0 ? -q : q;
    // Roundings of numbers up to 3; at the ends an angle is the root of one.
    for (const double t : {0.0, 0.5, 1.0}) {
        EXPECT_LT(gap(p, near, t).angle, 1e-14) << t;
        EXPECT_LT(gap(p, near, t).shift, 1e-13) << t;
    }
    EXPECT_GT(gap(p, near, 0.25).angle, 1e-3);
}

TEST(Dib, OfTwoIsSclerpAfterOneStep) {
    EXPECT_LT(lemma3_difference(100'000), 1e-14);  // some 50 roundings of numbers up to 3
}

TEST(Dib, OfManyTakesOneToFourSteps) {
    const Steps limbs = dib_steps(pi / 3, 1e-5, 20'000);
    EXPECT_EQ(limbs.unconverged, 0);
    EXPECT_GE(limbs.least(), 1);
    EXPECT_LE(limbs.most(), 4);
    const Steps wide = dib_steps(pi / 2, 1e-4, 20'000);
    EXPECT_EQ(wide.unconverged, 0);
    EXPECT_GE(wide.least(), 1);
    EXPECT_LE(wide.most(), 4);
}

TEST(Dib, ConvergesToAFinerPrecisionAndFromAnywhereToo) {
    const auto rows = all_dib_steps();
    ASSERT_EQ(rows.size(), 12u);
    for (const Steps& row : rows) {
        EXPECT_EQ(row.unconverged, 0) << row.spread << " " << row.precision;
        int sets = 0;
        for (const int n : row.sets) sets += n;
        EXPECT_EQ(sets, 20'000);
    }
    EXPECT_GT(rows[3].most(), 4);  // the steps do shrink by a factor only: in 1e-12 they are more
}

}  // namespace
}  // namespace probewarp::papers
