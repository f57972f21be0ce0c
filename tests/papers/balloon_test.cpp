// The regression paper's squashed balloon (section B), on our shape: what the table claims.
#include "balloon.h"

#include <gtest/gtest.h>

namespace probewarp::papers {
namespace {

const Balloon& balloon(double tilt) {
    static const Balloon little(20, 0.1), much(45, 0.1);
    return tilt < 30 ? little : much;
}

TEST(Balloon, HasAsManyMarkersAndPosturesAsThePaper) {
    EXPECT_EQ(balloon(45).markers.size(), 15u);
    EXPECT_EQ(balloon(45).readings.size(), 855u * 3);
    // One posture is the rest, and everything turns by the principal angle.
    EXPECT_GT(furthest_turn(balloon(45)), 90);
    EXPECT_LT(furthest_turn(balloon(45)), 180);
}

TEST(Balloon, StandsStillAtRest) {
    const auto& b = balloon(45);
    int rests = 0;
    for (std::size_t n = 0; n < Balloon::posture_count; ++n) {
        const double* r = &b.readings[n * Balloon::variables];
        if (r[0] != 0 || r[1] != 0 || r[2] != 0) continue;
        ++rests;
        // Central differences in steps of 0.006 mm round numbers of 60 mm by 1e-14.
        for (std::size_t m = 0; m < b.markers.size(); ++m)
            EXPECT_LT(marker_distance(b.truth[m][n], DualQuaternion<double>{}, b.markers[m]), 1e-9);
    }
    EXPECT_EQ(rests, 1);
}

TEST(Balloon, TooFewPosturesAreReportedUnlessThereIsAnL2Term) {
    const auto rank = [](int degree, int count) {
        try {
            balloon_errors(balloon(45), degree, count, 0);
            return std::pair(0, 0);
        } catch (const RankDeficient& e) {
            return std::pair(int(e.rank), int(e.feature_count));
        }
    };
    EXPECT_EQ(rank(2, 5), std::pair(5, 9));
    EXPECT_EQ(rank(3, 15), std::pair(15, 19));
    // Far from rubbish: what 5 postures tell of a motion of 30 mm on average.
    EXPECT_LT(balloon_errors(balloon(45), 2, 5, 1e-3).log_linear, 15);
    EXPECT_LT(balloon_errors(balloon(45), 3, 15, 1e-3).log_linear, 3);
}

TEST(Balloon, MorePosturesAndHigherDegreesAreNearer) {
    const auto error = [](int degree, int count) {
        return balloon_errors(balloon(45), degree, count, 0).log_linear;
    };
    EXPECT_LT(error(1, 15), error(1, 5));
    EXPECT_LT(error(2, 45), error(2, 15));
    EXPECT_LT(error(3, 95), error(3, 45));
    EXPECT_LT(error(2, 95), error(1, 95) / 5);
    EXPECT_LT(error(3, 95), error(2, 95) / 2);
    EXPECT_LT(error(3, 95), 0.15);  // near the noise, 0.1
}

TEST(Balloon, LogLinearIsFirstWhereItTurnsFar) {
    for (const int count : {15, 45, 95}) {
        const auto e = balloon_errors(balloon(45), 2, count, 0);
        EXPECT_EQ(e.unsettled, 0);
        EXPECT_LT(e.log_linear, e.dib);
        EXPECT_LT(e.dib, e.dlb);
        EXPECT_LT(e.dlb, e.ridge);
    }
}

TEST(Balloon, MethodsDifferLittleWhereItTurnsLittle) {
    const auto e = balloon_errors(balloon(20), 3, 95, 0);
    // Here polynomials of the points themselves are as good as any: the table says so.
    EXPECT_LT(e.ridge, e.log_linear);
    for (const double other : {e.dib, e.dlb, e.ridge}) EXPECT_NEAR(other, e.log_linear, 0.02);
}

}  // namespace
}  // namespace probewarp::papers
