// Deforming in float against the formula in double, and what must hold exactly: rest, whole pixels, whole
// turns.
#include "model/deform.h"

#include "generators.h"
#include "math/blend.h"
#include "model/deformation.h"
#include "pictures.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::angle;
using testing::blank_document;
using testing::degrees;
using testing::expect_always;
using testing::real;
using testing::whole;

Deformation deformed(const Document& document) {
    Deformation deformation;
    update(deformation, document);
    return deformation;
}

double distance(glm::dvec2 a, glm::dvec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// One vertex by the raw formula (s0^2 v + 2 s0 s1) / |s0|^2, in double, from the probes themselves.
struct Exact {
    glm::dvec2 now{0};
    double share = 0;  ///< |s0| / sum w_i

    Exact(const Document& document, glm::dvec2 vertex) {
        using C = std::complex<double>;
        const C middle(document.picture->image.width / 2.0, document.picture->image.height / 2.0);
        C s0, s1;
        double total = 0;
        for (const Probe& probe : document.probes) {
            const double w = probe.radius * probe.radius /
                             (std::pow(vertex.x - probe.rest.x, 2) + std::pow(vertex.y - probe.rest.y, 2));
            const C half = std::exp(C(0, probe.angle / 2)), c = to_complex(probe.rest) - middle;
            const C shift = to_complex(probe.now - probe.rest);
            s0 += w * half;
            s1 += w * ((std::conj(half) - half) * c / 2.0 + shift / 2.0 * std::conj(half));
            total += w;
        }
        const C v = to_complex(vertex) - middle;
        now = to_vec((s0 * s0 * v + 2.0 * s0 * s1) / std::norm(s0) + middle);
        share = std::abs(s0) / total;
    }
};

/// Probes on a picture of 8192 pixels, anywhere and turned many times.
Document any_document(double turns) {
    const bool wide = *whole(0, 1) == 1;
    Document document = blank_document(wide ? 8192 : 5000, wide ? 5000 : 8192, 12);
    const int count = *whole(1, 64);
    for (int i = 0; i < count; ++i)
        add_probe(document, {*real(0, 8192), *real(0, 8192)}, {*real(0, 8192), *real(0, 8192)}, *angle(turns),
                  *real(10, 1000));
    return document;
}

TEST(Deform, IsWithinAHundredthOfAPixelOfTheFormula) {
    expect_always("float against double, 8192 pixels", [] {
        const Document document = any_document(20);
        const Deformation deformation = deformed(document);
        for (std::size_t v = 0; v < deformation.now.size(); ++v) {
            const Exact exact(document, mesh_of(deformation).rest[v]);
            // Where the probes pull against each other the sum is short (a small share), and the floats'
            // rounding (2^-24 of up to 8192 pixels) counts 1/share times in s1 and 1/share^2 times in s0; the
            // two sums of up to 64 numbers make it up to four times that. A float knows no better.
            const double allowed = std::max(0.01, 8192 * 0x1p-22 / (exact.share * exact.share));
            if (exact.share > 2e-6) RC_ASSERT(distance(deformation.now[v], exact.now) <= allowed);
        }
    });
}

TEST(Deform, ByEveryBlendLeavesEveryVertexExactlyWhereNoProbeMoved) {
    expect_always("now = rest, in every bit", [] {
        Document document = any_document(1);
        for (Probe& probe : document.probes) probe.now = probe.rest, probe.angle = 0;
        for (const BlendMethod& method : blend_methods()) {
            document.blend = method.name;
            const Deformation deformation = deformed(document);
            RC_ASSERT(deformation.now == mesh_of(deformation).rest);
            RC_ASSERT(deformation.cancelled == 0u);
        }
    });
}

TEST(Deform, ByEveryBlendIsWhatTheBlendItselfSays) {
    expect_always("the vertices against act(blend(weights, motions), v), and the cancelled are counted", [] {
        Document document = any_document(4);
        for (const BlendMethod& method : blend_methods()) {
            document.blend = method.name;
            const Deformation deformation = deformed(document);
            const auto& rest = mesh_of(deformation).rest;
            const glm::dvec2 middle = centre(document.picture->image);
            const std::size_t probes = document.probes.size();
            std::size_t cancelled = 0;
            for (std::size_t v = 0; v < rest.size(); ++v) {
                const auto row = weights_of(deformation).subspan(v * probes, probes);
                const auto map =
                    method.blend(std::vector<double>(row.begin(), row.end()), deformation.motions);
                cancelled += map.cancelled;
                if (method.name == "dlb") continue;  // its floats have a test of their own
                const glm::dvec2 now = to_vec(act(map, to_complex(glm::dvec2(rest[v]) - middle))) + middle;
                // Both are double but for what the vertex is rounded to: two floats of that size.
                RC_ASSERT(distance(deformation.now[v], now) <= 3e-7 * (8192 + glm::length(now)));
            }
            if (method.name != "dlb") RC_ASSERT(deformation.cancelled == cancelled);
        }
    });
}

TEST(Deform, OnlyTheMovingLeastSquaresLookAtNoTurn) {
    for (const BlendMethod& method : blend_methods()) {
        Document document = blank_document(640, 480, 10);
        document.blend = method.name;
        add_probe(document, {100, 100}, {150, 90}, 0.5);
        const Deformation deformation = deformed(document);
        const bool least_squares = method.name.starts_with("mls");
        const Motion<double> motion = motion_of(document.probes[0], {320, 240});
        for (std::size_t v = 0; v < deformation.now.size(); ++v) {
            const glm::dvec2 rest = mesh_of(deformation).rest[v];
            const glm::dvec2 now =
                least_squares ? rest + glm::dvec2(50, -10)
                              : to_vec(act(similarity(motion), to_complex(rest - glm::dvec2(320, 240)))) +
                                    glm::dvec2(320, 240);
            ASSERT_LT(distance(deformation.now[v], now), 2e-4) << method.name;  // floats of 640 pixels
        }
    }
}

TEST(Deform, WithoutProbesMovesNothing) {
    const Deformation deformation = deformed(blank_document(640, 480));
    EXPECT_EQ(deformation.now, mesh_of(deformation).rest);
    EXPECT_EQ(deformation.cancelled, 0u);
}

TEST(Deform, OneProbeShiftsByWholePixelsExactly) {
    Document document =
        blank_document(1024, 512, 128);  // cells of 8 pixels: every vertex is on a pixel's corner
    add_probe(document, {301.25, 77.5}, {301.25 + 64, 77.5 - 3});
    const Deformation deformation = deformed(document);
    for (std::size_t v = 0; v < deformation.now.size(); ++v)
        ASSERT_EQ(deformation.now[v], mesh_of(deformation).rest[v] + glm::vec2(64, -3));
}

TEST(Deform, MayWriteOverItsInput) {
    Document document = blank_document(640, 480, 10);
    add_probe(document, {100, 100}, {150, 90}, 0.5);
    add_probe(document, {400, 300}, {410, 330}, -1);
    const Deformation deformation = deformed(document);
    const Pose pose{deformation.motions, deformation.transformations, {320, 240}};
    std::vector<glm::vec2> vertices = mesh_of(deformation).rest, beside(vertices.size());
    deform_dlb(vertices, weights_of(deformation), pose, beside);
    deform_dlb(vertices, weights_of(deformation), pose, vertices);
    EXPECT_EQ(vertices, beside);
}

/// Probes at the left and the right edge, the second or the first turned once round and moved to the right.
Document once_round(bool second) {
    Document document = blank_document(100, 100, 2);
    add_probe(document, {0, 50}, {second ? 0 : 7, 50}, second ? 0 : 360 * degrees);
    add_probe(document, {100, 50}, {second ? 107 : 100, 50}, second ? 360 * degrees : 0);
    return document;
}

TEST(Deform, VerticesWhoseWeightsCancelAreCountedAndFollowTheHeaviest) {
    for (const bool second : {true, false}) {
        const Deformation deformation = deformed(once_round(second));
        EXPECT_EQ(deformation.cancelled, 3u);  // the middle column, as far from the one as from the other
        for (std::size_t v = 0; v < deformation.now.size(); ++v)
            EXPECT_TRUE(std::isfinite(deformation.now[v].x) && std::isfinite(deformation.now[v].y));
        // Of equals the first: the one at rest, or the one that moved by 7.
        for (const std::size_t v : {1u, 4u, 7u})
            // A whole turn in floats: 2e-7 of the 50 pixels to the probe, and as much again for the sum.
            EXPECT_LT(
                distance(deformation.now[v], mesh_of(deformation).rest[v] + glm::vec2(second ? 0 : 7, 0)),
                3e-5);
    }
}

TEST(Deform, AProbeThatIsALittleHeavierEndsTheCancelling) {
    Document document = once_round(true);
    document.probes[1].radius *= 1.00001;  // 2e-5 of the weight: a share of 1e-5, ten times the threshold
    EXPECT_EQ(deformed(document).cancelled, 0u);
    document.probes[1].radius = document.probes[0].radius * (1 + 2e-7);  // a share of 2e-7, a fifth of it
    EXPECT_EQ(deformed(document).cancelled, 3u);
}

TEST(Deform, HalfwayThroughThreeQuartersOfATurnIs135Degrees) {
    Document document = blank_document(200, 100, 4);
    add_probe(document, {0, 50}, {0, 50});
    add_probe(document, {200, 50}, {200, 50}, 270 * degrees);
    const Deformation deformation = deformed(document);
    const auto pose = pose_at(deformation, deformation.now[7]);  // the middle vertex
    ASSERT_TRUE(pose);
    EXPECT_NEAR(pose->angle, 135 * degrees, 1e-5);  // the float vertex is off the middle by 1e-5 pixels
}

TEST(Deform, MethodsAreFoundByName) {
    for (const BlendMethod& method : blend_methods()) EXPECT_EQ(find_blend_method(method.name), &method);
    EXPECT_EQ(find_blend_method("no such method"), nullptr);
}

}  // namespace
}  // namespace probewarp
