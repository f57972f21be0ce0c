// Kavan, appendix B: log-matrix blending's speed follows its closed form and is not constant; ScLERP's is.
#include "kavan_speed.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace probewarp::papers {
namespace {

// A central difference over 2e-5 misses 1e-10 / 6 of a third derivative of up to 27, and adds roundings of
// 1e-16 / 1e-5.
constexpr double tolerance = 1e-9;

void expect_closed_forms(const SpeedCurve& curve) {
    ASSERT_EQ(curve.at.size(), 11u);
    for (const SpeedAt& x : curve.at) {
        EXPECT_NEAR(x.numerical, x.closed_form, tolerance) << x.t;
        EXPECT_NEAR(x.sclerp, curve.sclerp, tolerance) << x.t;
    }
}

double unevenness(const SpeedCurve& curve) {
    const auto [slowest, fastest] = std::ranges::minmax(curve.at, {}, &SpeedAt::numerical);
    return fastest.numerical / slowest.numerical;
}

TEST(LogMatrixSpeed, OfTheOriginFollowsItsClosedForm) { expect_closed_forms(moving_origin()); }

TEST(LogMatrixSpeed, OfTheTurnFollowsItsClosedForm) { expect_closed_forms(turning()); }

TEST(LogMatrixSpeed, IsNotConstant) {
    EXPECT_GT(unevenness(moving_origin()), 2);  // from 1.79 to 0.67
    EXPECT_GT(unevenness(turning()), 1.03);     // from 2.92 to 2.83: all that s between 1 and 2/pi allows
}

}  // namespace
}  // namespace probewarp::papers
