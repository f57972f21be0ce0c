// The CSV files of the iPad program: their frame, and that a wrong row names its line.
#include "io/probes_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/project.h"
#include "pictures.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::blank_document;
using testing::error_of;
using ::testing::HasSubstr;

/// Twice as long as the 1024 that the numbers are for; the centre is (1024, 512).
Document wide() { return blank_document(2048, 1024); }

std::string error_in(std::string_view text) {
    return error_of([&] { decode_probes_csv(text, wide()); });
}

TEST(ProbesCsv, AreTakenIntoThePicturesFrame) {
    const auto probes = decode_probes_csv(
        "#vertices x,y\n"
        "0,0\n"
        "1.5,-2\n"
        "#probes ix,iy,itheta,x,y,theta,radius\n"
        "100,50,0,110,-50,1.5,200\n"
        "-3e1,0,0.5,-30,0,0.25,1\n",
        wide());
    ASSERT_EQ(probes.size(), 2u);
    EXPECT_EQ(probes[0].rest, glm::dvec2(1024 + 200, 512 - 100));  // y up becomes y down
    EXPECT_EQ(probes[0].now, glm::dvec2(1024 + 220, 512 + 100));
    EXPECT_EQ(probes[0].angle, -1.5);  // anticlockwise becomes clockwise
    EXPECT_EQ(probes[0].radius, 400);
    EXPECT_EQ(probes[1].rest, glm::dvec2(1024 - 60, 512));
    EXPECT_EQ(probes[1].angle, 0.25);  // from 0.5 back to 0.25 is clockwise
    EXPECT_EQ(probes[0].id, 1);
    EXPECT_EQ(probes[1].id, 2);
}

TEST(ProbesCsv, ScaleWithTheLongerSide) {
    const char* text = "#probes ix,iy,itheta,x,y,theta,radius\n512,256,0,512,256,0,64\n";
    const auto tall = decode_probes_csv(text, blank_document(256, 512));
    EXPECT_EQ(tall[0].rest, glm::dvec2(128 + 256, 256 - 128));
    EXPECT_EQ(tall[0].radius, 32);
}

TEST(ProbesCsv, TakeLineEndsAndSpacesAsTheyCome) {
    const auto probes = decode_probes_csv(
        "#vertices x,y\r\n1,2\r\n\r\n#probes ix,iy,itheta,x,y,theta,radius\r\n"
        "\r\n 1 , 2,0 ,3,4,\t5,6\r\n   \r\n\n7,8,0,9,10,11,12",  // the last line without an end
        wide());
    ASSERT_EQ(probes.size(), 2u);
    EXPECT_EQ(probes[0].now, glm::dvec2(1024 + 6, 512 - 8));
    EXPECT_EQ(probes[1].radius, 24);
}

TEST(ProbesCsv, PassOverSectionsTheyDoNotKnow) {
    const auto probes = decode_probes_csv(
        "#probes ix,iy,itheta,x,y,theta,radius\n1,2,0,3,4,5,6\n#later "
        "rows\nanything\n#probes\n1,2,0,3,4,5,6\n",
        wide());
    EXPECT_EQ(probes.size(), 2u);
}

TEST(ProbesCsv, MayHoldNone) {
    EXPECT_TRUE(decode_probes_csv("#vertices x,y\n#probes ix,iy,itheta,x,y,theta,radius\n", wide()).empty());
}

TEST(ProbesCsv, IdsGoOnAfterTheDocuments) {
    Document document = wide();
    add_probe(document, {1, 1}, {1, 1}).id = 6;
    const auto probes = decode_probes_csv("#probes\n1,2,0,3,4,5,6\n1,2,0,3,4,5,6\n", document);
    EXPECT_EQ(probes[0].id, 7);
    EXPECT_EQ(probes[1].id, 8);
}

TEST(ProbesCsv, AWrongRowNamesItsLine) {
    for (const char* row :
         {"1,2,3", "1,2,3,4,5,6,7,8", "1,2,3,4,5,6,x", "1,2,3,4,5,6,", ",,,,,,", "1,2,3,4,5,6,0",
          "1,2,3,4,5,6,-1", "nan,2,3,4,5,6,7", "1,inf,3,4,5,6,7", "1e999,2,3,4,5,6,7", "1e7,2,3,4,5,6,7",
          "1,2,3,4,5,6,7 8", "hello", "0x10,2,3,4,5,6,7"}) {
        const std::string error =
            error_in(std::string("#vertices x,y\n\n#probes\n1,2,0,3,4,5,6\n") + row + "\n");
        EXPECT_THAT(error, HasSubstr("line 5 ")) << row;
        EXPECT_EQ(error.find('\n'), std::string::npos) << row;
    }
}

TEST(ProbesCsv, WithoutProbesAreNoneOfThese) {
    for (const char* text : {"", "\n\n", "1,2,0,3,4,5,6\n", "#vertices x,y\n1,2\n", "\xff\xfe garbage"})
        EXPECT_THAT(error_in(text), HasSubstr("#probes")) << text;
}

TEST(ProbesCsv, HoldNothingThatAProjectCouldNot) {
    // A picture of 32768 pixels makes 1e6 units 3.2e7 pixels, and both angles may be 1e6.
    for (const char* row :
         {"1e6,0,0,0,0,0,1", "0,0,0,0,-1e6,0,1", "0,0,0,0,0,0,1e6", "0,0,1e6,0,0,-1e6,1", "0,0,0,0,0,0,1e-9"})
        EXPECT_THAT(error_of([&] {
                        decode_probes_csv(std::string("#probes\n") + row + "\n", blank_document(32768, 10));
                    }),
                    HasSubstr("line 2 "))
            << row;
}

TEST(ProbesCsv, AreNoMoreThanAProjectHolds) {
    std::string text = "#probes\n";
    for (int i = 0; i < 10000; ++i) text += "1,2,0,3,4,5,6\n";
    EXPECT_EQ(decode_probes_csv(text, wide()).size(), 10000u);
    EXPECT_THAT(error_in(text + "1,2,0,3,4,5,6\n"), HasSubstr("line 10002 "));
}

}  // namespace
}  // namespace probewarp
