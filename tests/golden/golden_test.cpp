// Golden pictures: the real program renders, through OSMesa and through EGL, what was looked at and kept.
// To accept a changed picture, look at NAME-actual.png in the folder that the failure names and copy it over
// tests/golden/expected/NAME.png.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/program.h"

namespace probewarp::test {
namespace {

namespace fs = std::filesystem;

const fs::path golden = PROBEWARP_GOLDEN;

struct Golden {
    const char* name;
    const char* input;
    std::vector<std::string> arguments;
};

std::ostream& operator<<(std::ostream& out, const Golden& g) { return out << g.name; }

const std::vector<std::string> ten_probes{"--probe", "10,10:8,12,-10",    "--probe", "48,8:50,12,15",
                                          "--probe", "86,10:88,8,15",     "--probe", "10,48:4,44,10",
                                          "--probe", "40,40:44,42,30,16", "--probe", "58,56:56,50,-30,16",
                                          "--probe", "86,48:86,52,-12",   "--probe", "10,86",
                                          "--probe", "48,86:46,82,20,8",  "--probe", "86,86:82,88,10"};

/// In the fork's arms and foot; what is between the arms is near to both, and within the shape to neither.
std::vector<std::string> in_the_fork(std::vector<std::string> more) {
    std::vector<std::string> arguments{
        "--mesh", "24", "--probe", "27,18:33,22,25", "--probe", "69,18:71,12,-20", "--probe", "48,76:48,76"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

/// Three probes, one of them turned so far that the blends part.
std::vector<std::string> by_blend(const char* blend) {
    return {"--blend",         blend,     "--probe",        "24,24:20,30,10", "--probe",
            "70,30:74,26,-40", "--probe", "48,70:48,66,230"};
}

const std::vector<Golden> goldens{
    {"opposite", "card.png", {"--probe", "20,48", "--probe", "76,48:76,48,180"}},
    {"ten-probes", "card.png", ten_probes},
    {"alpha-edges", "soft.png", {"--probe", "20,32:16.5,28.25,-15", "--probe", "46,32:50.5,36.75,25"}},
    {"shrinking", "card.png", {"--probe", "20,20:26,24,20", "--probe", "70,70", "--scale", "0.3"}},
    {"canvas-fit",
     "card.png",
     {"--canvas", "fit", "--probe", "48,48:60,40,30", "--probe", "80,20:120,-10,60"}},
    {"tiles",
     "wide.png",
     {"--probe", "900,20:910,14,4", "--probe", "1024,20:1020,24,-6", "--probe", "200,20"}},
    {"samples", "card.png", {"--samples", "4", "--probe", "48,48:48,48,30"}},
    {"deep", "deep.png", {"--probe", "12,12:14.5,10.5,12", "--probe", "36,36"}},
    {"background", "soft.png", {"--background", "#204060", "--probe", "32,32:36,30,10"}},
    {"size", "wide.png", {"--size", "300x80", "--probe", "550,20:550,24,3", "--probe", "100,20"}},
    {"inverse-distance", "fork.png", in_the_fork({"--weights", "inverse-distance"})},
    {"gaussian", "fork.png", in_the_fork({"--weights", "gaussian"})},
    {"geodesic", "fork.png", in_the_fork({"--weights", "geodesic"})},
    {"harmonic", "fork.png", in_the_fork({"--weights", "harmonic"})},
    {"biharmonic", "fork.png", in_the_fork({"--weights", "biharmonic"})},
    {"heat-one", "fork.png", in_the_fork({"--weights", "geodesic", "--heat", "2", "--iso-lines"})},
    {"heat-all", "fork.png", in_the_fork({"--weights", "biharmonic", "--heat", "all"})},
    {"heat-faint",
     "soft.png",
     {"--probe", "20,32:16,28", "--probe", "46,32", "--heat", "1", "--opacity", "0.3"}},
    {"blend-dlb", "card.png", by_blend("dlb")},
    {"blend-dlb-shortest", "card.png", by_blend("dlb-shortest")},
    {"blend-dib", "card.png", by_blend("dib")},
    {"blend-log-linear", "card.png", by_blend("log-linear")},
    {"blend-spiral", "card.png", by_blend("spiral")},
    {"blend-linear", "card.png", by_blend("linear")},
    {"blend-mls-rigid", "card.png", by_blend("mls-rigid")},
    {"blend-mls-similarity", "card.png", by_blend("mls-similarity")},
    {"painted", "painted.probewarp", {}},
    {"painted-heat", "painted.probewarp", {"--heat", "Left", "--iso-lines"}},
};

class GoldenTest : public testing::TestWithParam<std::tuple<Golden, const char*>> {};

TEST_P(GoldenTest, LooksAsItDid) {
    const auto& [g, backend] = GetParam();
    const fs::path folder = scratch_folder();
    const fs::path actual = folder / (std::string(g.name) + "-actual.png");
    const fs::path expected = golden / "expected" / (std::string(g.name) + ".png");
    std::vector<std::string> arguments{"render", golden / "input" / g.input, "-o", actual, "--backend",
                                       backend};
    arguments.insert(arguments.end(), g.arguments.begin(), g.arguments.end());
    const Outcome run = run_program(arguments);
    ASSERT_EQ(run.code, 0) << run.errors;
    ASSERT_TRUE(fs::exists(expected)) << "There is no baseline yet; what was rendered lies at " << actual;
    const Image a = read(actual), e = read(expected);
    fs::copy_file(expected, folder / (std::string(g.name) + "-expected.png"));
    ASSERT_TRUE(a.width == e.width && a.height == e.height && a.bits() == e.bits()) << "see " << folder;
    const Difference d = difference(a, e);
    // Another version of Mesa may round a texel's weight or a triangle's edge otherwise: few samples, or
    // little.
    const bool close = d.mean <= 0.02 && (d.most <= 3 || d.mean <= 0.002);
    if (!close) write_png(folder / (std::string(g.name) + "-difference.png"), difference_picture(a, e));
    EXPECT_TRUE(close) << "off by at most " << d.most << "/255, " << d.mean << "/255 on average; see "
                       << folder;
}

INSTANTIATE_TEST_SUITE_P(All, GoldenTest,
                         testing::Combine(testing::ValuesIn(goldens),
                                          testing::Values("auto", "osmesa", "egl")),
                         [](const auto& p) {
                             std::string name =
                                 std::string(std::get<0>(p.param).name) + "_" + std::get<1>(p.param);
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

/// What a rendering must be is known here from the input alone.
const std::vector<std::string> blends{"dlb",    "dlb-shortest", "dib",       "log-linear",
                                      "spiral", "linear",       "mls-rigid", "mls-similarity"};

TEST(Blends, EachMakesAnotherPictureOfOneProject) {
    const fs::path folder = scratch_folder();
    std::vector<Image> pictures;
    for (const std::string& blend : blends) {
        const fs::path output = folder / (blend + ".png");
        const Outcome run = run_program({"render", fs::path(PROBEWARP_IMAGES) / "lighthouse.probewarp", "-o",
                                         output, "--scale", "0.125", "--blend", blend});
        ASSERT_EQ(run.code, 0) << run.errors;
        pictures.push_back(read(output));
    }
    for (std::size_t i = 0; i < blends.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)  // the nearest two differ by 0.9 levels on average
            EXPECT_GT(difference(pictures[i], pictures[j]).mean, 0.4) << blends[i] << " and " << blends[j];
}

TEST(Blends, WhereOneProbeAloneActsAllAgreeButMovingLeastSquaresOnlyTranslate) {
    const fs::path folder = scratch_folder();
    const auto rendered = [&](const std::string& blend, const std::string& probe) {
        const fs::path output = folder / (blend + ".png");
        const Outcome run = run_program(
            {"render", golden / "input/card.png", "-o", output, "--blend", blend, "--probe", probe});
        EXPECT_EQ(run.code, 0) << run.errors;
        return read(output);
    };
    const Image turned = rendered("dlb", "40,50:46,44,-130"), shifted = rendered("dlb", "40,50:46,44");
    for (const std::string& blend : blends) {
        const Image picture = rendered(blend, "40,50:46,44,-130");
        const bool least_squares = blend.starts_with("mls");
        // Their sums round differently in the last bits, and with them a sample here and there.
        EXPECT_LE(difference(picture, least_squares ? shifted : turned).mean, 0.002) << blend;
        EXPECT_GT(difference(picture, least_squares ? turned : shifted).mean, 10) << blend;
    }
}

class ExactTest : public testing::TestWithParam<const char*> {
  protected:
    Image render(const std::string& input, std::vector<std::string> more) {
        const fs::path output = scratch_folder() / "actual.png";
        std::vector<std::string> arguments{"render",  golden / "input" / input, "-o", output, "--backend",
                                           GetParam()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome run = run_program(arguments);
        EXPECT_EQ(run.code, 0) << run.errors;
        return read(output);
    }
};

TEST_P(ExactTest, UndeformedEqualsItsInputInEveryByte) {
    for (const char* input : {"card.png", "soft.png", "deep.png", "wide.png", "checks.png"})
        for (const std::vector<std::string>& probes : {std::vector<std::string>{},
                                                       {"--probe", "11.3,7.9", "--probe", "30,30"},
                                                       {"--mesh", "7", "--canvas", "fit"}}) {
            const Image in = read(golden / "input" / input), out = render(input, probes);
            EXPECT_EQ(out.bits(), in.bits()) << input;
            EXPECT_EQ(out.rgba, in.rgba) << input << " with " << probes.size() << " arguments";
        }
}

TEST_P(ExactTest, WholePixelTranslationIsAnExactShift) {
    for (const char* input : {"card.png", "deep.png", "wide.png"}) {
        const Image in = read(golden / "input" / input), out = render(input, {"--probe", "20,20:33,13"});
        for (int y = 0; y < in.height; ++y)
            for (int x = 0; x < in.width; ++x) {
                const int from_x = x - 13, from_y = y + 7;
                const bool covered = from_x >= 0 && from_y < in.height;
                const auto expected = covered ? pixel(in, from_x, from_y) : std::array<int, 4>{};
                ASSERT_EQ(pixel(out, x, y), expected) << input << " at " << x << ", " << y;
            }
    }
}

TEST_P(ExactTest, QuarterTurnAboutTheCentreIsExactWithinOneLevel) {
    const Image in = read(golden / "input/card.png"), out = render("card.png", {"--probe", "48,48:48,48,90"});
    int off = 0;
    for (int y = 0; y < in.height; ++y)
        for (int x = 0; x < in.width; ++x)
            for (std::size_t k = 0; k < 4; ++k)  // clockwise as seen: right comes from up
                off = std::max(off, std::abs(pixel(out, x, y)[k] - pixel(in, y, in.height - 1 - x)[k]));
    EXPECT_LE(off, 1);
}

TEST_P(ExactTest, SoftEdgesHaveNoFringe) {
    // All that can be seen of the picture is one colour, so all that can be seen after filtering is it too.
    const Image in = read(golden / "input/soft.png");
    const auto colour = pixel(in, 32, 32);
    const Image out = render("soft.png", {"--probe", "32,32:35.3,30.6,17"});
    int seen = 0;
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const auto p = pixel(out, x, y);
            if (p[3] == 0) continue;
            ++seen;
            for (std::size_t k = 0; k < 3; ++k) ASSERT_LE(std::abs(p[k] - colour[k]), 1) << x << ", " << y;
        }
    EXPECT_GT(seen, 1500);
}

TEST_P(ExactTest, ShrinkingDoesNotAlias) {
    // The finest checkerboard, shrunk, is grey: 127.5, give or take the mipmaps' rounding and what a level
    // blends in.
    for (const char* scale : {"0.5", "0.25", "0.11"}) {
        const Image out = render("checks.png", {"--scale", scale});
        for (int y = 0; y < out.height; ++y)
            for (int x = 0; x < out.width; ++x)
                ASSERT_NEAR(pixel(out, x, y)[0], 127.5, 2) << scale << " at " << x << ", " << y;
    }
}

TEST_P(ExactTest, AnExportMayBeLargerThanATexture) {
    // 17600 pixels wide; drivers hold 16384. The input is smooth, so that a sixteenth of a pixel changes
    // little.
    const Image in = read(golden / "input/wide.png"), out = render("wide.png", {"--scale", "16"});
    ASSERT_EQ(out.width, 17600);
    ASSERT_EQ(out.height, 640);
    for (int y = 0; y < in.height; ++y)
        for (int x = 0; x < in.width; ++x)
            for (std::size_t k = 0; k < 4; ++k)
                ASSERT_NEAR(pixel(out, 16 * x + 8, 16 * y + 8)[k], pixel(in, x, y)[k], 2) << x << ", " << y;
}

INSTANTIATE_TEST_SUITE_P(All, ExactTest, testing::Values("auto", "osmesa", "egl"),
                         [](const auto& p) { return std::string(p.param); });

TEST(Refusal, OfAPictureLargerThanATexture) {
    const fs::path folder = scratch_folder();
    Image image;
    image.width = 20000;
    image.height = 2;
    image.rgba = std::vector<std::uint8_t>(20000 * 2 * 4, 255);
    write_png(folder / "long.png", image);
    const Outcome run =
        run_program({"render", folder / "long.png", "-o", folder / "out.png", "--backend", "osmesa"});
    EXPECT_EQ(run.code, 1);
    EXPECT_NE(
        run.errors.find("the picture is 20000 x 2 pixels; this graphics driver holds at most 16384 x 16384"),
        std::string::npos)
        << run.errors;
    EXPECT_FALSE(fs::exists(folder / "out.png"));
    // The processor needs no texture.
    EXPECT_EQ(run_program({"render", folder / "long.png", "-o", folder / "out.png"}).code, 0);
    EXPECT_EQ(read(folder / "out.png").rgba, image.rgba);
}

TEST(Refusal, OfAnExportThatIsTooLarge) {
    const fs::path output = scratch_folder() / "out.png";
    const Outcome run = run_program({"render", golden / "input/card.png", "-o", output, "--scale", "400"});
    EXPECT_EQ(run.code, 1);
    EXPECT_NE(run.errors.find("the export would be 38400 x 38400 pixels; at most 32768 along a side"),
              std::string::npos)
        << run.errors;
    EXPECT_FALSE(fs::exists(output));
}

}  // namespace
}  // namespace probewarp::test
