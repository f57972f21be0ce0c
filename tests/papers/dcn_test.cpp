// MKO, section 5: DLB's distributivity, SLERP's uniform angular velocity, and the candy wrapper.
#include "dcn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace probewarp::papers {
namespace {

using std::numbers::pi;

TEST(Dcn, DlbDistributesOverComposition) {
    const Distributivity d = distributivity(100'000);
    // 40 roundings of numbers up to 5, which the division by a sum of 0.1 at least makes ten times larger.
    EXPECT_LT(d.left, 4e-13);
    EXPECT_LT(d.right, 4e-13);
}

TEST(Dcn, SlerpTurnsUniformlyAboutOnePointAndDlbUnevenly) {
    for (const Evenness& e : evenness()) {
        EXPECT_NEAR(e.slerp, 1, 1e-10)
            << e.apart;  // roundings of 1e-16 over 1e-4, and as much of a slow turn
        EXPECT_LT(e.centre_moves, 1e-13) << e.apart;  // some 40 roundings of numbers up to 10
        // Differences over 2e-4 flatten a peak that is as narrow as 1 - t + t e^{i apart/2} comes near 0.
        EXPECT_NEAR(e.dlb / e.dlb_exact, 1, 1e-5) << e.apart;
        EXPECT_GT(e.dlb, 1.01) << e.apart;
    }
}

TEST(CandyWrapper, LinearBlendingFlattensTheMiddleAtHalfATurnAndDlbDoesNot) {
    const Wrapper w = wrapper(pi);
    EXPECT_LT(w.linear, 1e-9);  // the difference's own error
    EXPECT_GT(w.dlb, 0.5);
}

TEST(CandyWrapper, LinearBlendingTakesTheMiddleCrossSectionToOnePointAndDlbKeepsItsLength) {
    const Bar bar{pi};
    const std::complex<double> top(0, -Bar::half_width), bottom(0, Bar::half_width);
    // Roundings of numbers up to 2.
    EXPECT_LT(std::abs(bar.linear(top) - bar.linear(bottom)), 1e-15);
    EXPECT_NEAR(std::abs(bar.dlb(top) - bar.dlb(bottom)), 2 * Bar::half_width, 1e-15);
}

TEST(CandyWrapper, BothFollowTheProbesAtTheEnds) {
    const Bar bar{pi / 2};
    const std::complex<double> end(Bar::half_length, 0), turned = std::polar(1.0, pi / 4) * end;
    EXPECT_LT(std::abs(bar.linear(end) - turned), 1e-15);  // roundings of numbers up to 2
    EXPECT_LT(std::abs(bar.dlb(end) - turned), 1e-15);
}

TEST(CandyWrapper, DlbsJacobianIsItsClosedForms) {
    for (const Wrapper& w : wrappers()) {
        EXPECT_NEAR(w.dlb, w.dlb_exact, 1e-8) << w.apart;  // h^2 = 1e-10 of a third derivative of up to 50
        EXPECT_GT(w.dlb, 0.3) << w.apart;
    }
}

}  // namespace
}  // namespace probewarp::papers
