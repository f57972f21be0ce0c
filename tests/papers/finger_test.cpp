// The regression paper's finger (Fig. 3 and Fig. 4): what the table claims.
#include "finger.h"

#include <gtest/gtest.h>

#include "rigid_fit.h"

namespace probewarp::papers {
namespace {

using Planar = DualComplex<double>;
using Spatial = DualQuaternion<double>;

TEST(Finger, TurnsBeyondHalfATurnFromTheFirstReferenceOnly) {
    EXPECT_GT(furthest_turn({}, 0), 180);
    EXPECT_LT(furthest_turn({}, 120), 180);
}

TEST(Finger, LogLinearIsWithinHalfAMillimetreAtLowNoise) {
    for (const double noise : {1e-3, 1e-2, 1e-1})
        for (const int side : {3, 9}) {
            EXPECT_LT(finger_errors<Planar>({}, {side, noise}).log_linear, 0.5) << side << ", " << noise;
            EXPECT_LT(finger_errors<Spatial>({}, {side, noise}).log_linear, 0.5) << side << ", " << noise;
        }
    EXPECT_LT(finger_errors<Planar>({}, {26, 1e-3}).log_linear, 0.5);
    EXPECT_LT(finger_errors<Spatial>({}, {26, 1e-3}).log_linear, 0.5);
}

void expect_the_order(const MeanErrors& e) {
    EXPECT_EQ(e.unsettled, 0);
    EXPECT_LT(e.log_linear, e.dib);
    EXPECT_LT(e.dib, e.dlb);
    EXPECT_LT(e.dlb, e.ridge);
}

TEST(Finger, LogLinearIsBeforeDibBeforeDlbBeforeRidge) {
    for (const double noise : {1e-3, 1e-1, 1.0})
        for (const int side : {3, 9}) {
            SCOPED_TRACE(testing::Message() << side << ", " << noise);
            expect_the_order(finger_errors<Planar>({}, {side, noise}));
            expect_the_order(finger_errors<Spatial>({}, {side, noise}));
        }
    expect_the_order(finger_errors<Planar>({}, {26, 1e-3}));
    expect_the_order(finger_errors<Spatial>({}, {26, 1.0}));
}

TEST(Finger, TurnsBeyondHalfATurnBreakWhatTakesThePrincipalLogarithm) {
    for (const int side : {3, 9}) {
        const auto near = finger_errors<Planar>({}, {side, 1e-3});
        const auto principal = finger_errors<Planar>({}, {side, 1e-3, 0});
        const auto carried = finger_errors<Planar>({}, {side, 1e-3, 0, Signs::carried});
        EXPECT_GT(principal.log_linear, 10 * near.log_linear);
        EXPECT_GT(principal.dlb, near.dlb);
        EXPECT_GT(principal.unsettled, 0);
        // Points know no signs.
        EXPECT_NEAR(principal.ridge, carried.ridge, 1e-9);  // roundings of some 80 mm
        // The signs were all that was wrong; what is left is the third order of twice the angles.
        EXPECT_LT(carried.log_linear, 3 * near.log_linear);
        EXPECT_EQ(carried.unsettled, 0);
        // Unlike from (120, 120), the logarithm at the reference is not the best then.
        EXPECT_LT(carried.dib, carried.dlb);
        EXPECT_LT(carried.dlb, carried.log_linear);
    }
}

TEST(Finger, IsTheSameInThePlaneAsInSpace) {
    for (const int reference : {0, 120}) {
        const FingerCase without_noise{9, 0, reference, Signs::carried};
        const auto plane = finger_errors<Planar>({}, without_noise);
        const auto space = finger_errors<Spatial>({}, without_noise);
        // Roundings of some 80 mm, and DIB's precision of 1e-9.
        EXPECT_NEAR(plane.log_linear, space.log_linear, 1e-9);
        EXPECT_NEAR(plane.dlb, space.dlb, 1e-9);
        EXPECT_NEAR(plane.ridge, space.ridge, 1e-9);
        EXPECT_NEAR(plane.dib, space.dib, 1e-6);
    }
}

TEST(Finger, ManyObservationsAverageTheNoise) {
    const auto error = [](int side, double noise) {
        return finger_errors<Planar>({}, {side, noise}).log_linear;
    };
    EXPECT_GT(error(3, 1) - error(3, 1e-3), 0.2);
    EXPECT_LT(error(26, 1) - error(26, 1e-3), 0.05);
}

TEST(Finger, LogLinearLacksTheThirdOrderOfTheAngles) {
    const auto error = [](double phalanx, double each) {
        return finger_errors<Planar>({phalanx, each}, {9, 0}).log_linear;
    };
    // Of higher order is the square of the angle, 0.9 at most, in hundredths.
    EXPECT_NEAR(error(25, 0.2) / error(25, 0.1), 8, 0.2);
    EXPECT_NEAR(error(25, 0.4) / error(25, 0.2), 8, 0.5);
    EXPECT_NEAR(error(50, 0.4) / error(25, 0.4), 2, 1e-9);
}

TEST(RigidFit, FindsWhatCarriedTheMarkers) {
    Noise noise;
    const auto plane = rotation(2.0, std::complex<double>(3, 4));
    const auto space = translation(glm::dvec3(1, 2, 3)) * rotation(2.5, glm::normalize(glm::dvec3(1, -2, 2)));
    const std::vector<std::complex<double>> two{{1, 2}, {5, -3}};
    const std::vector<glm::dvec3> three{{1, 2, 0}, {5, -3, 1}, {0, 7, 2}};  // a plane has a mirror
    // Roundings of numbers up to 10.
    EXPECT_LT(marker_distance(measured(plane, two, 0, noise), plane, two), 1e-13);
    EXPECT_LT(marker_distance(measured(space, three, 0, noise), space, three), 1e-13);
    EXPECT_NEAR(rotation_dot(measured(space, three, 0, noise), space), 1, 1e-14);
}

TEST(RigidFit, NoiseHasTheDeviationThatIsAskedFor) {
    Noise noise;
    constexpr int count = 10000;
    double sum = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
        const double x = shaken(std::complex<double>(0), 0.5, noise).imag();
        sum += x;
        squares += x * x;
    }
    // Four times the deviations of the mean, 0.005, and of the variance, 0.25 sqrt(2 / 10000).
    EXPECT_NEAR(sum / count, 0, 0.02);
    EXPECT_NEAR(squares / count, 0.25, 0.0142);
}

}  // namespace
}  // namespace probewarp::papers
