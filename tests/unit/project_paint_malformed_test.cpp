// Projects of the second format whose settings or paint are not what they should be: each is refused with one
// line that names the file and what is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bad_projects.h"
#include "io/paint_file.h"
#include "model/paint_ops.h"

namespace probewarp {
namespace {

using testing::Bytes;
using ::testing::HasSubstr;
using testing::one_pixel;
using testing::raw_zip;
using testing::RawMember;
using testing::refusal;
using testing::to_bytes;
using testing::with_other_json;

const std::string good_json = R"({"format": 2, "image": {"file": "image.png", "name": "a.png"},
    "mesh": {"cells": 10, "from_alpha": true, "threshold": 7, "margin": 2.5},
    "weights": {"scheme": "harmonic", "exponent": 3, "falloff": 4, "most": 8}, "blend": "dlb",
    "stiffness": {"file": "stiffness.png", "extent": [1, 0.5]},
    "probes": [{"id": 3, "name": "P", "colour": "#e69f00", "rest": [1.5, 2], "now": [3, 4],
                "angle_radians": 0.25, "radius": 10, "locked": false, "visible": true,
                "paint": {"file": "paint/3.png", "extent": [1, 0.75]}}]})";

Bytes paint_png(float value) { return encode_paint(filled(new_paint_map(4, 3), value)); }

constexpr std::size_t paint_at = 3, stiffness_at = 4;  // in the members

std::vector<RawMember> good_members() {
    return {{"mimetype", to_bytes(project_mimetype)},
            {"project.json", to_bytes(good_json)},
            {"image.png", one_pixel()},
            {"paint/3.png", paint_png(0.5f)},
            {"stiffness.png", paint_png(1)}};
}

std::vector<RawMember> members_with(const std::string& from, const std::string& to) {
    return with_other_json(good_members(), from, to);
}

std::string refusal_with(const std::string& from, const std::string& to) {
    return refusal(members_with(from, to));
}

/// With other bytes as the probe's paint.
std::string refusal_of_paint(Bytes bytes) {
    auto members = good_members();
    members[paint_at].bytes = std::move(bytes);
    return refusal(members);
}

TEST(MalformedPaintedProject, TheGoodOneOpens) {
    EXPECT_EQ(refusal(good_members()), "");
    const Document document = decode_project(raw_zip(good_members()), "x");
    EXPECT_EQ(document.mesh, (MeshSettings{10, true, 7, 2.5}));
    EXPECT_EQ(document.weights, (WeightSettings{"harmonic", 3, 4, 8}));
    ASSERT_TRUE(document.stiffness && document.probes.at(0).paint);
    EXPECT_EQ(document.stiffness->extent, glm::dvec2(1, 0.5));
    EXPECT_EQ(document.probes[0].paint->extent, glm::dvec2(1, 0.75));
    // The ends of every range, and no paint.
    for (const auto& [from, to] :
         std::initializer_list<std::pair<const char*, const char*>>{{"7", "0"},
                                                                    {"7", "254"},
                                                                    {"2.5", "0"},
                                                                    {"2.5", "1000"},
                                                                    {"\"exponent\": 3", "\"exponent\": 0.5"},
                                                                    {"\"exponent\": 3", "\"exponent\": 8"},
                                                                    {"\"falloff\": 4", "\"falloff\": 0"},
                                                                    {"\"falloff\": 4", "\"falloff\": 1000"},
                                                                    {"\"most\": 8", "\"most\": 0"},
                                                                    {"\"most\": 8", "\"most\": 10000"},
                                                                    {"[1, 0.5]", "[1e-6, 1e6]"}})
        EXPECT_EQ(refusal_with(from, to), "") << to;
    auto members = members_with(R"({"file": "stiffness.png", "extent": [1, 0.5]})", "null");
    members.pop_back();
    EXPECT_EQ(refusal(members), "");
}

constexpr struct {
    const char *from, *to, *said;
} wrong_values[] = {
    {"\"from_alpha\": true", "\"from_alpha\": 1", "mesh.from_alpha"},
    {"\"from_alpha\": true", "\"from_alpha\": null", "mesh.from_alpha"},
    {"\"from_alpha\": true", "\"from_alpha\": \"true\"", "mesh.from_alpha"},
    {"\"threshold\": 7", "\"threshold\": -1", "mesh.threshold"},
    {"\"threshold\": 7", "\"threshold\": 255", "mesh.threshold"},
    {"\"threshold\": 7", "\"threshold\": 7.5", "mesh.threshold"},
    {"\"threshold\": 7", "\"threshold\": 4294967303", "mesh.threshold"},  // 2^32 + 7
    {"\"threshold\": 7", "\"threshold\": true", "mesh.threshold"},
    {"\"margin\": 2.5", "\"margin\": -0.1", "mesh.margin"},
    {"\"margin\": 2.5", "\"margin\": 1000.1", "mesh.margin"},
    {"\"margin\": 2.5", "\"margin\": \"2.5\"", "mesh.margin"},
    {"\"margin\": 2.5", "\"margin\": [2.5]", "mesh.margin"},
    {"\"scheme\": \"harmonic\"", "\"scheme\": \"magic\"", "weights.scheme"},
    {"\"scheme\": \"harmonic\"", "\"scheme\": 1", "weights.scheme"},
    {"\"exponent\": 3", "\"exponent\": 0.49", "weights.exponent"},
    {"\"exponent\": 3", "\"exponent\": 8.01", "weights.exponent"},
    {"\"exponent\": 3", "\"exponent\": null", "weights.exponent"},
    {"\"falloff\": 4", "\"falloff\": -1", "weights.falloff"},
    {"\"falloff\": 4", "\"falloff\": 1001", "weights.falloff"},
    {"\"falloff\": 4", "\"falloff\": {}", "weights.falloff"},
    {"\"most\": 8", "\"most\": -1", "weights.most"},
    {"\"most\": 8", "\"most\": 10001", "weights.most"},
    {"\"most\": 8", "\"most\": 1.5", "weights.most"},
    {"{\"scheme\": \"harmonic\", \"exponent\": 3, \"falloff\": 4, \"most\": 8}", "\"harmonic\"", "weights"},
    {"{\"file\": \"stiffness.png\", \"extent\": [1, 0.5]}", "true", "stiffness"},
    {"{\"file\": \"stiffness.png\", \"extent\": [1, 0.5]}", "\"stiffness.png\"", "stiffness"},
    {"{\"file\": \"stiffness.png\", \"extent\": [1, 0.5]}", "{}", "stiffness.file"},
    {"\"file\": \"stiffness.png\"", "\"file\": null", "stiffness.file"},
    {"\"file\": \"stiffness.png\"", "\"file\": \"a\\nb\"", "stiffness.file"},
    {"[1, 0.5]", "[1]", "stiffness.extent"},
    {"[1, 0.5]", "[1, 0]", "stiffness.extent"},
    {"[1, 0.5]", "[-1, 0.5]", "stiffness.extent"},
    {"[1, 0.5]", "[1e-7, 0.5]", "stiffness.extent"},
    {"{\"file\": \"paint/3.png\", \"extent\": [1, 0.75]}", "[]", "probes[0].paint"},
    {"{\"file\": \"paint/3.png\", \"extent\": [1, 0.75]}", "false", "probes[0].paint"},
    {"\"file\": \"paint/3.png\"", "\"file\": 3", "probes[0].paint.file"},
    {"\"file\": \"paint/3.png\", ", "", "probes[0].paint.file"},
    {", \"extent\": [1, 0.75]", "", "probes[0].paint.extent"},
    {"[1, 0.75]", "[1, 0.75, 1]", "probes[0].paint.extent"},
    {"[1, 0.75]", "[1, 1.1e6]", "probes[0].paint.extent"},
    {"[1, 0.75]", "[\"1\", 0.75]", "probes[0].paint.extent"},
    {"[1, 0.75]", "{\"x\": 1}", "probes[0].paint.extent"},
    // Of another version:
    {"\"most\": 8", "\"most\": 8, \"least\": 1", "\"least\" in weights"},
    {"\"margin\": 2.5", "\"margin\": 2.5, \"round\": 1", "\"round\" in mesh"},
    {"[1, 0.5]", "[1, 0.5], \"opacity\": 1", "\"opacity\" in stiffness"},
    {"[1, 0.75]", "[1, 0.75], \"opacity\": 1", "\"opacity\" in probes[0].paint"},
    {"\"format\": 2", "\"format\": 1", "project.json"},
};

TEST(MalformedPaintedProject, WrongValuesNameTheirField) {
    for (const auto& c : wrong_values) EXPECT_THAT(refusal_with(c.from, c.to), HasSubstr(c.said)) << c.to;
    EXPECT_THAT(refusal_with("stiffness.png", std::string(81, 'x')), HasSubstr("stiffness.file"));
}

TEST(MalformedPaintedProject, MissingFields) {
    for (const char* field :
         {"from_alpha", "threshold", "margin", "scheme", "exponent", "falloff", "most", "stiffness", "paint"})
        EXPECT_THAT(refusal_with('"' + std::string(field) + '"', "\"other\""), HasSubstr(field)) << field;
    for (const char* number : {"NaN", "Infinity", "1e999"})
        EXPECT_NE(refusal_with("\"exponent\": 3", std::string("\"exponent\": ") + number), "") << number;
}

TEST(MalformedPaintedProject, PaintThatIsNotThere) {
    for (const std::size_t at : {paint_at, stiffness_at}) {
        auto members = good_members();
        const std::string name = members[at].name;
        members.erase(members.begin() + std::ptrdiff_t(at));
        EXPECT_THAT(refusal(members), HasSubstr("has no member " + name));
    }
    EXPECT_THAT(refusal_with("\"file\": \"paint/3.png\"", "\"file\": \"../paint.png\""),
                HasSubstr("has no member ../paint.png"));
}

TEST(MalformedPaintedProject, PaintThatNobodyNames) {
    EXPECT_THAT(refusal_with(R"({"file": "paint/3.png", "extent": [1, 0.75]})", "null"),
                HasSubstr("has a member paint/3.png that this version does not know"));
    auto members = good_members();
    members.push_back({"paint/4.png", paint_png(1)});
    EXPECT_THAT(refusal(members), HasSubstr("has a member paint/4.png"));
}

TEST(MalformedPaintedProject, AFileThatIsNamedTwice) {
    // As two maps, or as what it is besides: paint would be read as the picture, or the text as paint.
    for (const char* taken : {"paint/3.png", "image.png", "project.json", "mimetype"}) {
        auto members = members_with("\"stiffness.png\"", '"' + std::string(taken) + '"');
        members.pop_back();
        EXPECT_THAT(refusal(members), HasSubstr(std::string("names ") + taken + " twice"));
    }
}

TEST(MalformedPaintedProject, PaintThatIsNoPicture) {
    EXPECT_THAT(refusal_of_paint({}), HasSubstr("paint/3.png: is no 16-bit PNG"));
    EXPECT_THAT(refusal_of_paint(to_bytes("no picture")), HasSubstr("paint/3.png: is no 16-bit PNG"));
    Image image;
    image.width = image.height = 2;
    image.rgba = std::vector<std::uint8_t>(16, 200);
    for (const char* format : {"jpeg", "bmp"})
        EXPECT_THAT(refusal_of_paint(find_image_format(format)->encode(image, {})),
                    HasSubstr("paint/3.png: is no 16-bit PNG"));
}

TEST(MalformedPaintedProject, PaintCutAtEveryByte) {
    const Bytes whole = paint_png(0.5f);
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_THAT(refusal_of_paint(Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(size))),
                    HasSubstr("paint/3.png: "))
            << size;
}

}  // namespace
}  // namespace probewarp
