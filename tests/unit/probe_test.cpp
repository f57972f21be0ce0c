// A probe's transformation: what a person sees, whole turns, and the frame about the picture's centre.
#include "model/probe.h"

#include <set>

#include "generators.h"
#include "pictures.h"

namespace probewarp {
namespace {

using testing::angle;
using testing::degrees;
using testing::expect_always;
using testing::real;

Probe probe_at(glm::dvec2 rest, glm::dvec2 now, double turned) {
    Probe probe;
    probe.rest = rest;
    probe.now = now;
    probe.angle = turned;
    return probe;
}

/// Where the probe takes a point of the picture, image pixels.
glm::dvec2 moved(const Probe& probe, glm::dvec2 centre, glm::dvec2 point) {
    return centre + to_vec(act(motion_of(probe, centre).p, to_complex(point - centre)));
}

glm::dvec2 any_point(double size) { return {*real(-size, size), *real(-size, size)}; }

double distance(glm::dvec2 a, glm::dvec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(Probe, AtRestDoesExactlyNothing) {
    expect_always("the transformation of a probe that was not moved is 1", [] {
        const glm::dvec2 rest = any_point(1e5);
        RC_ASSERT(motion_of(probe_at(rest, rest, 0), any_point(1e4)).p == DualComplex<double>{});
    });
}

TEST(Probe, TakesItsPlaceAlongWhateverItsTurn) {
    expect_always("rest goes to now", [] {
        const Probe probe = probe_at(any_point(8192), any_point(8192), *angle(5));
        // A dozen roundings (1e-16) of numbers up to 16384 image pixels.
        RC_ASSERT(distance(moved(probe, any_point(4096), probe.rest), probe.now) < 1e-10);
    });
}

TEST(Probe, DoesTheSameAboutEveryCentre) {
    expect_always("the centre of the arithmetic is not seen", [] {
        const Probe probe = probe_at(any_point(8192), any_point(8192), *angle(5));
        const glm::dvec2 v = any_point(8192);
        // As above.
        RC_ASSERT(distance(moved(probe, {0, 0}, v), moved(probe, any_point(4096), v)) < 1e-10);
    });
}

TEST(Probe, TurnsClockwiseAsSeen) {
    // y points down: a quarter turn takes what is right of the probe to below it.
    const Probe probe = probe_at({100, 50}, {300, 50}, 90 * degrees);
    const glm::dvec2 to = moved(probe, {64, 64}, {110, 50});
    EXPECT_NEAR(to.x, 300, 1e-12);  // roundings of numbers up to 300
    EXPECT_NEAR(to.y, 60, 1e-12);
}

TEST(Probe, KnowsOneTurnFromTwo) {
    const glm::dvec2 rest{30, 40}, centre{10, 10};
    const auto once = motion_of(probe_at(rest, rest, 360 * degrees), centre).p;
    const auto twice = motion_of(probe_at(rest, rest, 720 * degrees), centre).p;
    EXPECT_NEAR(once.p0.real(), -1, 1e-15);  // the angle's own rounding
    EXPECT_NEAR(twice.p0.real(), 1, 1e-15);
    // Halfway through 270 degrees is 135, not -45.
    const auto three_quarters = motion_of(probe_at(rest, rest, 270 * degrees), centre).p;
    EXPECT_NEAR(std::arg(three_quarters.p0), 135 * degrees, 1e-15);
}

TEST(Probe, IsAtRestOnlyWhereItWasPutAndUnturned) {
    EXPECT_TRUE(at_rest(probe_at({1, 2}, {1, 2}, 0)));
    EXPECT_FALSE(at_rest(probe_at({1, 2}, {1, 2.5}, 0)));
    EXPECT_FALSE(at_rest(probe_at({1, 2}, {1, 2}, 360 * degrees)));
}

TEST(Probe, ColoursDifferThenComeAgain) {
    EXPECT_EQ(to_hex(probe_colour(0)), "#e69f00");
    std::set<std::string> colours;
    for (int i = 0; i < 12; ++i) colours.insert(to_hex(probe_colour(i)));
    EXPECT_EQ(colours.size(), 12u);
    EXPECT_EQ(probe_colour(12), probe_colour(0));
    EXPECT_EQ(to_hex({1, 0, 255}), "#0100ff");
}

}  // namespace
}  // namespace probewarp
