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
         {"1,2,3", "1,2,3,4,5,6,7,8", "1,2,3,4,5,6,x", "1,2,3,4,5,6,", ",,,,,,7", "1,2,3,4,5,6,0",
          "1,2,3,4,5,6,-1", "nan,2,3,4,5,6,7", "1,inf,3,4,5,6,7", "1e999,2,3,4,5,6,7", "1e7,2,3,4,5,6,7",
          "1,2,3,4,5,6,7 8", "hello", "0x10,2,3,4,5,6,7"}) {
        const std::string error =
            error_in(std::string("#vertices x,y\n\n#probes\n1,2,0,3,4,5,6\n") + row + "\n");
        EXPECT_THAT(error, HasSubstr("line 5 ")) << row;
        EXPECT_EQ(error.find('\n'), std::string::npos) << row;
    }
}

// What a spreadsheet may make of these rows. The numbers are exact in binary, so that they compare equal.
const std::string plain =
    "#vertices x,y\n0,0\n#probes ix,iy,itheta,x,y,theta,radius\n"
    "1.5,-2,0,3,4.25,0.5,60\n-300,2.5,0.125,4,-5,0,7\n";

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

void expect_as_plain(std::string_view text, const char* what) {
    EXPECT_EQ(error_in(text), "") << what;
    if (!error_in(text).empty()) return;
    EXPECT_EQ(decode_probes_csv(text, wide()), decode_probes_csv(plain, wide())) << what;
}

TEST(ProbesCsv, AnySeparatorAndDecimalSign) {
    ASSERT_EQ(decode_probes_csv(plain, wide()).size(), 2u);
    const std::string semicolons = replaced(plain, ",", ";"), tabs = replaced(plain, ",", "\t");
    expect_as_plain(semicolons, "semicolons, points");
    expect_as_plain(tabs, "tabs, points");
    expect_as_plain(replaced(semicolons, ".", ","), "semicolons, commas");
    expect_as_plain(replaced(tabs, ".", ","), "tabs, commas");
    expect_as_plain("sep=;\n" + replaced(semicolons, ".", ","), "Excel's first line");
    expect_as_plain("\"SEP=|\"\r\n" + replaced(plain, ",", "|"), "Excel's first line, another sign");
    expect_as_plain("sep=\t\n" + replaced(tabs, ".", ","), "Excel's first line, a tab");
    expect_as_plain("sep=,\n" + plain, "Excel's first line, a comma");
}

TEST(ProbesCsv, WhatOldSystemsAdd) {
    expect_as_plain(plain + "\x1a", "an end of file");
    expect_as_plain(plain + std::string(3, '\0'), "a block filled up");
    expect_as_plain(replaced(plain, "#probes", "# Probes"), "a heading with a space");
    expect_as_plain(replaced(plain, ",", ",\xa0"), "a space of Windows' old code page");
}

TEST(ProbesCsv, QuotesAndSigns) {
    const std::string rows = plain.substr(0, plain.find("1.5"));
    expect_as_plain(rows + "\"1,5\",-2,0,3,\"4,25\",\" 0,5 \",60\n-300,\"2,5\",\"0,125\",4,-5,0,7\n",
                    "decimal commas in quotes");
    expect_as_plain(rows +
                        "\"1.5\",\"-2\",\"0\",\"3\",\"4.25\",\"0.5\",\"60\"\n"
                        "\"-300\",\"2.5\",\"0.125\",\"4\",\"-5\",\"0\",\"7\"\n",
                    "all in quotes");
    expect_as_plain(rows + "\"1.5,-2,0,3,4.25,0.5,60\"\n\"-300,2.5,0.125,4,-5,0,7\"\n", "a row in quotes");
    expect_as_plain(rows +
                        "+1.5,\xe2\x88\x92"
                        "2,+0,3.,+4.25,.5,6e1\n-3E+02,+2.5E0,125e-3,4,-5,0,+7\n",
                    "signs and exponents");
    expect_as_plain(rows +
                        "1,5E+0;\xe2\x88\x92"
                        "2;0;3;4,25;5E-1;60\n\xc2\xa0-300\xe2\x80\xaf;2,5;0,125;4;-5;0;7\n",
                    "commas with exponents, spaces that do not break");
}

TEST(ProbesCsv, WhatSpreadsheetsAddToRows) {
    expect_as_plain(replaced(replaced(plain, ",", ";"), "\n", ";;;\n"), "empty columns");
    expect_as_plain(replaced(plain, "\n", "\n,,,,,,\n \t \n\"\",\n\n"), "empty rows");
    expect_as_plain(replaced(plain, "#probes ix,iy,itheta,x,y,theta,radius",
                             "#probes;;;;;;\nix;IY;itheta;\"x\"; y ;Theta;radius"),
                    "the columns named in a row of their own");
    for (const char* head :
         {"#probes", "\"#probes ix,iy,itheta,x,y,theta,radius\"", "#Probes;;;;;;", "  #PROBES",
          "\"#probes ix\";\"iy\";\"itheta\";\"x\";\"y\";\"theta\";\"radius\"", "#probes,,,,,,,"})
        expect_as_plain(replaced(plain, "#probes ix,iy,itheta,x,y,theta,radius", head), head);
}

TEST(ProbesCsv, AnyLineEnds) {
    expect_as_plain(replaced(plain, "\n", "\r\n"), "CR LF");
    expect_as_plain(replaced(plain, "\n", "\r"), "CR");
    expect_as_plain(plain.substr(0, plain.size() - 1), "none behind the last");
    for (const char* end : {"\n", "\r\n", "\r"})
        EXPECT_THAT(error_in(replaced("#probes\n1,2,0,3,4,5,6\n\nx\n", "\n", end)), HasSubstr("line 4 "))
            << end;
}

/// The text, which is ASCII but for U+2212, as UTF-16.
std::string utf16(std::string_view text, bool little, bool marked) {
    std::string converted;
    const auto put = [&](unsigned unit) {
        const char low = char(unit & 0xFF), high = char(unit >> 8);
        converted += little ? low : high;
        converted += little ? high : low;
    };
    if (marked) put(0xFEFF);
    for (const char c : text) put(c == '~' ? 0x2212u : unsigned(c));
    return converted;
}

TEST(ProbesCsv, AnyEncoding) {
    expect_as_plain("\xef\xbb\xbf" + plain, "UTF-8 with its mark");
    expect_as_plain("\xef\xbb\xbfsep=;\n" + replaced(plain, ",", ";"), "and Excel's first line");
    const std::string signs = replaced(replaced(plain, ",", "\t"), "-", "~");
    for (const bool little : {true, false})
        for (const bool marked : {true, false}) {
            expect_as_plain(utf16(signs, little, marked), "UTF-16");
            expect_as_plain(utf16(signs, little, marked) + "x", "UTF-16 with half a character behind it");
        }
    const std::string at_once = plain.substr(plain.find("#probes"));
    expect_as_plain("\xef\xbb\xbf" + at_once, "a mark before the line of the probes");
    for (const bool little : {true, false}) {
        expect_as_plain(utf16(at_once, little, true), "UTF-16's mark before it");
        expect_as_plain(utf16("sep=|\n" + replaced(at_once, ",", "|"), little, true),
                        "and Excel's first line");
    }
    EXPECT_NE(error_in(utf16(plain, true, true).substr(1)), "");
}

TEST(ProbesCsv, WhatCouldBeReadInTwoWaysIsRefused) {
    const auto said = [](const std::string& row) { return error_in("#probes\n" + row + "\n"); };
    const std::string commas = said("1,5,2,5,0,5,3,5,4,5,0,5,60,5");
    EXPECT_THAT(commas, HasSubstr("line 2 has 14 columns; expected seven, ix,iy,itheta,x,y,theta,radius"));
    EXPECT_THAT(commas, HasSubstr("where numbers have a decimal comma, semicolons between them, or quotes"));
    EXPECT_THAT(said("1.024,5;2;0;3;4;5;6"), HasSubstr("line 2 has \"1.024,5\" for ix; expected a number"));
    EXPECT_THAT(said("1;2;0;3;\"1,024.5\";5;6"), HasSubstr("\"1,024.5\" for y; expected a number"));
    EXPECT_THAT(said("1;2;0;3;1,000,000;5;6"), HasSubstr("\"1,000,000\" for y; expected a number"));
    EXPECT_THAT(error_in("sep=;\n#probes\n1,2,0,3,4,5,6\n"),
                HasSubstr("line 3 has 1 column; expected seven"));
}

TEST(ProbesCsv, MessagesSayWhatIsWrong) {
    const auto said = [](const std::string& row) { return error_in("#probes\n" + row + "\n"); };
    EXPECT_THAT(said("1,2,3"), HasSubstr("line 2 has 3 columns; expected seven, ix,iy,"));
    EXPECT_THAT(said("1,2,,4,5,6,7"), HasSubstr("line 2 has no itheta; expected a number"));
    EXPECT_THAT(said("1,2,3,4,5,6,x"), HasSubstr("line 2 has \"x\" for radius; expected a number"));
    EXPECT_THAT(said("1,2,3,4,5,6,-1"), HasSubstr("line 2 has a radius of -1; expected one above 0"));
    EXPECT_THAT(said("1,2,3,4,5,\x1b[31m,7"), HasSubstr("line 2 has \"?[31m\" for theta"));
    EXPECT_THAT(said(std::string(1, '\0')), HasSubstr("line 2 has 1 column"))
        << "what is no text is not empty";
    for (const char* none : {"+-1", "--1", "+", "-", "1 2", "1e", "0x1", "\"", "''1", "1e1e1"})
        EXPECT_THAT(said(std::string(none) + ";2;3;4;5;6;7"), HasSubstr("line 2 has ")) << none;
}

TEST(ProbesCsv, AHostileLineCostsItsLength) {
    const std::string quotes(1'000'000, '"'), commas(1'000'000, ',');
    EXPECT_NE(error_in("#probes\n" + quotes + "1"), "");
    EXPECT_EQ(error_in("#probes\n" + quotes + "\n"), "") << "a million quotes hold nothing";
    EXPECT_EQ(error_in("#probes\n" + commas + "\n"), "") << "a million empty columns";
    EXPECT_THAT(error_in("#probes\n" + commas + "1\n"), HasSubstr("line 2 has 1000001 columns"));
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
