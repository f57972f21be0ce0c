// Projects that are not what they should be: each is refused with one line that names the file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bad_projects.h"
#include "io/file.h"

namespace probewarp {
namespace {

using testing::Bytes;
using testing::deflated;
using testing::error_of;
using ::testing::HasSubstr;
using testing::one_pixel;
using testing::raw_zip;
using testing::RawMember;
using testing::refusal;
using testing::to_bytes;
using testing::with_other_json;

const std::string good_json = R"({"format": 1, "image": {"file": "image.png", "name": "a.png"},
    "mesh": {"cells": 10}, "weights": "inverse-distance", "blend": "dlb",
    "probes": [{"id": 3, "name": "P", "colour": "#e69f00", "rest": [1.5, 2], "now": [3, 4],
                "angle_radians": 0.25, "radius": 10, "locked": false, "visible": true}]})";

std::vector<RawMember> good_members() {
    return {{"mimetype", to_bytes(project_mimetype)},
            {"project.json", to_bytes(good_json)},
            {"image.png", one_pixel()}};
}

std::string refusal_with(const std::string& from, const std::string& to) {
    return refusal(with_other_json(good_members(), from, to));
}

TEST(MalformedProject, TheGoodOneOpens) {
    EXPECT_EQ(refusal(good_members()), "");
    const Document document = decode_project(raw_zip(good_members()), "x");
    ASSERT_EQ(document.probes.size(), 1u);
    EXPECT_EQ(document.probes[0].now, glm::dvec2(3, 4));
    EXPECT_EQ(document.probes[0].id, 3);
    EXPECT_EQ(document.mesh.cells, 10);
    EXPECT_EQ(refusal_with("[1.5, 2]", "[-1e7, 1e7]"), "");
    EXPECT_EQ(refusal_with("\"id\": 3", "\"id\": 2000000000"), "");
}

TEST(MalformedProject, MissingMembers) {
    for (std::size_t i = 0; i < 3; ++i) {
        auto members = good_members();
        const std::string name = members[i].name;
        members.erase(members.begin() + std::ptrdiff_t(i));
        EXPECT_THAT(refusal(members), HasSubstr(name)) << name;
    }
    EXPECT_NE(refusal(std::vector<RawMember>{}), "");
}

TEST(MalformedProject, AWrongMimetype) {
    auto members = good_members();
    members[0].bytes = to_bytes("application/x-probewarp2");
    EXPECT_THAT(refusal(members), HasSubstr("is not a Probewarp project"));
    members[0].bytes = to_bytes("application/x-probewarp\n");
    EXPECT_THAT(refusal(members), HasSubstr("is not a Probewarp project"));
    members[0].bytes = to_bytes("image/openraster");
    EXPECT_THAT(refusal(members), HasSubstr("is an OpenRaster picture"));
    members[0].bytes = to_bytes("image/unheard-of");
    EXPECT_THAT(refusal(members), HasSubstr("its mimetype is \"image/unheard-of\""));
}

TEST(MalformedProject, DoubledMembers) {
    for (std::size_t i = 0; i < 3; ++i) {
        auto members = good_members();
        members.push_back(members[i]);
        EXPECT_NE(refusal(members), "") << members[i].name;
    }
}

TEST(MalformedProject, NamesThatPointOut) {
    for (const std::string name : {"../evil", "a/../../evil", "..", ".", "/etc/passwd", "\\etc", "..\\evil",
                                   "./../evil", "C:evil", "a//b", "a/./b", "/", "folder/", "new\nline", ""}) {
        auto members = good_members();
        members.push_back({name, to_bytes("x")});
        EXPECT_NE(refusal(members), "") << name;
        if (!name.empty()) {
            EXPECT_THAT(refusal(members), HasSubstr("points out of the archive")) << name;
        }
    }
}

TEST(MalformedProject, MembersAndFieldsOfALaterVersion) {
    auto members = good_members();
    members.push_back({"layers.json", to_bytes("{}")});
    EXPECT_THAT(refusal(members), HasSubstr("has a member layers.json that this version does not know"));
    members.back().name = "more\\layers.json";
    EXPECT_THAT(refusal(members), HasSubstr("has a member more/layers.json that"));
    EXPECT_THAT(refusal_with("\"format\": 1", "\"format\": 1, \"sliders\": []"),
                HasSubstr("the field \"sliders\""));
    EXPECT_THAT(refusal_with("\"cells\": 10", "\"cells\": 10, \"kind\": 1"), HasSubstr("\"kind\" in mesh"));
    EXPECT_THAT(refusal_with("\"name\": \"a.png\"", "\"name\": \"a.png\", \"x\": 1"),
                HasSubstr("\"x\" in image"));
    EXPECT_THAT(refusal_with("\"id\": 3", "\"id\": 3, \"pin\": 1"), HasSubstr("\"pin\" in probes[0]"));
    EXPECT_THAT(refusal_with("\"format\": 1", "\"format\": 1, \"\\n\\u001b\\u0000\": 1"),
                HasSubstr("\"???\""));
}

TEST(MalformedProject, MissingFields) {
    for (const char* field :
         {"format", "image", "mesh", "weights", "blend", "probes", "name", "file", "cells", "id", "colour",
          "rest", "now", "angle_radians", "radius", "locked", "visible"})
        EXPECT_THAT(refusal_with('"' + std::string(field) + '"', "\"other\""), HasSubstr("project.json"))
            << field;
}

constexpr struct {
    const char *from, *to, *said;
} wrong_values[] = {
    {"\"cells\": 10", "\"cells\": 0", "mesh.cells"},
    {"\"cells\": 10", "\"cells\": -5", "mesh.cells"},
    {"\"cells\": 10", "\"cells\": 1001", "mesh.cells"},
    {"\"cells\": 10", "\"cells\": 4294967306", "mesh.cells"},            // 2^32 + 10
    {"\"cells\": 10", "\"cells\": 18446744073709551615", "mesh.cells"},  // 2^64 - 1
    {"\"cells\": 10", "\"cells\": 10.5", "mesh.cells"},
    {"\"cells\": 10", "\"cells\": \"10\"", "mesh.cells"},
    {"\"cells\": 10", "\"cells\": null", "mesh.cells"},
    {"{\"cells\": 10}", "[]", "mesh"},
    {"\"id\": 3", "\"id\": 0", "probes[0].id"},
    {"\"id\": 3", "\"id\": -1", "probes[0].id"},
    {"\"id\": 3", "\"id\": 2000000001", "probes[0].id"},
    {"\"id\": 3", "\"id\": true", "probes[0].id"},
    {"\"name\": \"P\"", "\"name\": 7", "probes[0].name"},
    {"\"name\": \"P\"", "\"name\": \"a\\nb\"", "probes[0].name"},
    {"\"name\": \"a.png\"", "\"name\": \"a\\u0000b\"", "image.name"},
    {"#e69f00", "#E69F00", "probes[0].colour"},
    {"#e69f00", "#e69f0", "probes[0].colour"},
    {"#e69f00", "#e69f0g", "probes[0].colour"},
    {"#e69f00", "e69f000", "probes[0].colour"},
    {"[1.5, 2]", "[1.5]", "probes[0].rest"},
    {"[1.5, 2]", "[1.5, 2, 3]", "probes[0].rest"},
    {"[1.5, 2]", "[1.5, \"2\"]", "probes[0].rest"},
    {"[1.5, 2]", "{\"x\": 1}", "probes[0].rest"},
    {"[3, 4]", "[3, 1.1e7]", "probes[0].now"},
    {"0.25", "1.1e6", "probes[0].angle_radians"},
    {"0.25", "-1.1e6", "probes[0].angle_radians"},
    {"\"radius\": 10", "\"radius\": 0", "probes[0].radius"},
    {"\"radius\": 10", "\"radius\": -10", "probes[0].radius"},
    {"\"radius\": 10", "\"radius\": 1e-300", "probes[0].radius"},
    {"\"locked\": false", "\"locked\": 0", "probes[0].locked"},
    {"\"visible\": true", "\"visible\": \"yes\"", "probes[0].visible"},
    {"inverse-distance", "magic", "weights"},
    {"\"dlb\"", "\"lbs\"", "blend"},
    {"\"dlb\"", "null", "blend"},
    {"\"file\": \"image.png\"", "\"file\": 3", "image.file"},
    {"[{\"id\"", "[7, {\"id\"", "probes[0]"},
    {"\"probes\": [", "\"probes\": {\"a\": [", "JSON"},
};

TEST(MalformedProject, WrongValuesNameTheirField) {
    for (const auto& c : wrong_values) EXPECT_THAT(refusal_with(c.from, c.to), HasSubstr(c.said)) << c.to;
    EXPECT_THAT(refusal_with("\"P\"", '"' + std::string(201, 'x') + '"'), HasSubstr("probes[0].name"));
}

TEST(MalformedProject, NumbersThatAreNone) {
    for (const char* number :
         {"NaN", "nan", "Infinity", "-Infinity", "1e999", "-1e999", "0x10", "1.", ".5", "01", "+1", "1e"})
        EXPECT_NE(refusal_with("0.25", number), "") << number;
    EXPECT_THAT(refusal_with("0.25", "1e999"), HasSubstr("number that is too large"));
    EXPECT_THAT(refusal_with("0.25", "NaN"), HasSubstr("expected JSON"));
}

TEST(MalformedProject, AnotherFormat) {
    const auto said = [](const std::string& format) {
        return refusal_with("\"format\": 1", "\"format\": " + format);
    };
    for (const char* newer : {"3", "4294967297"}) {
        EXPECT_THAT(said(newer), HasSubstr("was saved by a newer version of Probewarp, in format " +
                                           std::string(newer) + "; this version reads formats 1 to 2"));
        EXPECT_THAT(said(newer), HasSubstr("update Probewarp"));
    }
    for (const char* wrong : {"0", "-1", "1.0", "\"1\"", "\"2\"", "null", "[1]", "true"})
        EXPECT_THAT(said(wrong),
                    HasSubstr("a whole number without quotes, as this version reads formats 1 to 2"))
            << wrong;
    EXPECT_THAT(said("\"2\""), HasSubstr("format is the text \"2\"; expected"));
    EXPECT_THAT(said("null"), HasSubstr("format is null; expected"));
    EXPECT_THAT(said("18446744073709551617"), HasSubstr("reads formats 1 to 2"));
}

TEST(MalformedProject, WhatStandsInAWrongPlaceIsSaid) {
    EXPECT_THAT(refusal_with("\"radius\": 10", "\"radius\": null"),
                HasSubstr("probes[0].radius is null; expected a number from"));
    EXPECT_THAT(refusal_with("[3, 4]", "[3, null]"),
                HasSubstr("probes[0].now is [3,null]; expected numbers"));
    EXPECT_THAT(refusal_with("\"radius\": 10", "\"reach\": 10"), HasSubstr("probes[0].radius is missing"));
    EXPECT_THAT(refusal_with("{\"cells\": 10}", "null"), HasSubstr("mesh is null; expected an object"));
    EXPECT_THAT(refusal_with("\"P\"", '"' + std::string(300, 'x') + '"'),
                HasSubstr("is the text \"" + std::string(40, 'x') + "\"...; expected"));
    EXPECT_THAT(refusal_with("[3, 4]", "[1, 2, 3, 4, 5]"),
                HasSubstr("probes[0].now is a list of 5; expected"));
    EXPECT_THAT(refusal_with("[3, 4]", "[\"3\", 4]"),
                HasSubstr("probes[0].now is a list of 2; expected numbers"));
    auto members = good_members();
    for (const auto& [json, said] : {std::pair{"null", "project.json is null; expected an object"},
                                     {"[1]", "project.json is [1]; expected an object"}}) {
        members[1].bytes = to_bytes(json);
        EXPECT_THAT(refusal(members), HasSubstr(said));
    }
}

TEST(MalformedProject, NoNameInAMessageIsEmpty) {
    EXPECT_THAT(refusal_with("\"file\": \"image.png\"", "\"file\": \"\""),
                HasSubstr("image.file is the text \"\"; expected the name of a member"));
    EXPECT_THAT(refusal_with("\"format\": 1", "\"format\": 1, \"\": 1"),
                HasSubstr("a field without a name; expected none"));
    EXPECT_THAT(refusal_with("\"cells\": 10", "\"cells\": 10, \"\": 1"),
                HasSubstr("a field without a name in mesh; expected none"));
    EXPECT_THAT(refusal_with("\"format\": 1", "\"format\": 1, \"\": 1, \"\": 2"),
                HasSubstr("two fields without a name"));
    auto members = good_members();
    members.push_back({"", to_bytes("x")});
    EXPECT_THAT(refusal(members), HasSubstr("a member without a name"));
}

TEST(MalformedProject, FieldsAndIdsThatStandTwice) {
    EXPECT_THAT(refusal_with("\"format\": 1", "\"format\": 1, \"format\": 1"),
                HasSubstr("the field \"format\" twice"));
    EXPECT_THAT(refusal_with("\"radius\": 10", "\"radius\": 10, \"radius\": 11"),
                HasSubstr("the field \"radius\" twice"));
    EXPECT_THAT(refusal_with("\"format\": 1", "\"a\\nb\": 1, \"a\\nb\": 1"), HasSubstr("\"a?b\" twice"));
    const auto first = good_json.find("{\"id\""), end = good_json.find("]}", first);
    const std::string probe = good_json.substr(first, end - first);
    EXPECT_THAT(refusal_with(probe, probe + ", " + probe), HasSubstr("probes[1].id stands twice"));
    std::string other = probe;
    other.replace(other.find('3'), 1, "4");
    EXPECT_EQ(refusal_with(probe, probe + ", " + other), "");  // the same fields in two probes are no double
}

TEST(MalformedProject, JsonThatIsNone) {
    for (const std::string json :
         {"", "{", "[]", "7", "null", "\"x\"", "{}", "{\"format\": 1}", "{} {}", "{'a': 1}"}) {
        auto members = good_members();
        members[1].bytes = to_bytes(json);
        EXPECT_THAT(refusal(members), HasSubstr("project.json")) << json;
    }
    auto members = good_members();
    for (const std::string_view text :
         {std::string_view("\xff\xfe{\0}\0", 6), std::string_view("\xfe\xff\0{\0}", 6)}) {
        members[1].bytes = to_bytes(text);
        EXPECT_THAT(refusal(members), HasSubstr("project.json is saved as UTF-16; expected UTF-8"));
    }
    EXPECT_NE(refusal_with("\"P\"", "\"\xff\""), "");     // no UTF-8
    EXPECT_NE(refusal_with("\"P\"", "\"\\ud800\""), "");  // half a pair
}

TEST(MalformedProject, DeepNesting) {
    for (const char* bracket : {"[", "{\"a\":"}) {
        std::string deep;
        for (int i = 0; i < 200'000; ++i) deep += bracket;
        auto members = good_members();
        members[1].bytes = to_bytes(deep);
        EXPECT_THAT(refusal(members), HasSubstr("nested deeper"));
        EXPECT_THAT(refusal_with("\"format\": 1", "\"format\": " + deep), HasSubstr("nested deeper"));
    }
}

TEST(MalformedProject, MoreThanTheLibraryCanReadInTime) {
    // Millions of empty objects, and an object of hundreds of thousands of fields: the library is quadratic
    // in both.
    std::string objects = "[{}", fields = "{\"0\":0";
    for (int i = 1; i < 2'000'000; ++i) objects += ",{}";
    for (int i = 1; i < 500'000; ++i) fields += ",\"" + std::to_string(i) + "\":0";
    EXPECT_THAT(refusal_with("\"format\": 1", "\"format\": " + objects + "]"), HasSubstr("holds too much"));
    EXPECT_THAT(refusal_with("\"format\": 1", "\"format\": " + fields + "}"), HasSubstr("too many fields"));
}

TEST(MalformedProject, AZip64DirectoryThatLies) {
    const Bytes archive = raw_zip(good_members());
    const auto with_end64 = [&](std::uint64_t members, std::uint64_t shift) {
        return testing::with_zip64_end(archive, members, shift);
    };
    EXPECT_EQ(refusal(with_end64(3, 0)), "");
    EXPECT_THAT(refusal(with_end64(5000, 0)), HasSubstr("too many members"));
    EXPECT_THAT(refusal(with_end64(std::uint64_t{1} << 60, 0)), HasSubstr("too many members"));
    for (const std::uint64_t shift : {std::uint64_t{1}, std::uint64_t{1} << 20, ~std::uint64_t{0} - 1000})
        EXPECT_THAT(refusal(with_end64(3, shift)), HasSubstr("is damaged")) << shift;
}

TEST(MalformedProject, APicturesBytesMayLookLikeADirectory) {
    auto members = good_members();
    const Bytes looks_large =
        to_bytes("PK\6\7 PK\5\6 \377\377\377\377\377\377\377\377\377\377\377\377\377\377\377\377");
    members[2].bytes.insert(members[2].bytes.end(), looks_large.begin(),
                            looks_large.end());  // after PNG's end
    EXPECT_EQ(refusal(members), "");
}

TEST(MalformedProject, MoreProbesOrWeightsThanFit) {
    const auto first = good_json.find("{\"id\""), end = good_json.find("]}", first);
    const std::string probe = good_json.substr(first, end - first);
    const auto many = [&](int count) {
        std::string list;
        for (int i = 1; i <= count; ++i) {
            std::string one = probe;
            list += (i > 1 ? "," : "") + one.replace(one.find('3'), 1, std::to_string(i));
        }
        return list;
    };
    EXPECT_THAT(refusal_with(probe, many(10001)), HasSubstr("at most 10000 probes"));
    auto members = good_members();
    std::string json = good_json;
    json.replace(json.find("10}"), 2, "1000");
    members[1].bytes = to_bytes(json.replace(json.find(probe), probe.size(), many(67)));
    EXPECT_THAT(refusal(members), HasSubstr("coarser mesh"));
}

TEST(MalformedProject, PicturesThatAreNone) {
    auto members = good_members();
    members[2].bytes = to_bytes("no picture");
    EXPECT_THAT(refusal(members), HasSubstr("image.png: is not a picture"));
    members[2].bytes = one_pixel();
    members[2].bytes.resize(members[2].bytes.size() / 2);
    EXPECT_THAT(refusal(members), HasSubstr("image.png: is truncated"));
    for (const char* other : {"project.json", "mimetype", "../image.png", ""})
        EXPECT_NE(refusal_with("\"file\": \"image.png\"", std::string("\"file\": \"") + other + "\""), "")
            << other;
}

TEST(MalformedProject, EncryptedMembers) {
    for (std::size_t i = 0; i < 3; ++i) {
        auto members = good_members();
        members[i].flags |= 1;
        EXPECT_THAT(refusal(members), HasSubstr("encrypted member " + members[i].name));
    }
}

TEST(MalformedProject, MembersThatArePackedByOtherMeans) {
    for (const auto& [method, name] : {std::pair{9u, "Deflate64"},
                                       {12u, "bzip2"},
                                       {14u, "LZMA"},
                                       {93u, "Zstandard"},
                                       {95u, "XZ"},
                                       {98u, "PPMd"},
                                       {77u, "method 77"}}) {
        auto members = good_members();
        members[1].method = method;
        EXPECT_THAT(refusal(members), HasSubstr("has a member project.json that is packed by " +
                                                std::string(name) + "; expected deflate"));
    }
}

TEST(MalformedProject, MembersThatLieAboutThemselves) {
    auto members = good_members();
    members[1].checksum = 0x12345678;
    EXPECT_THAT(refusal(members), HasSubstr("damaged"));
    members = good_members();
    members[1].method = 99;  // no such compression
    EXPECT_NE(refusal(members), "");
    members = good_members();
    members[1].size = std::uint32_t(members[1].bytes.size() + 1);  // stored, and not as long as it says
    EXPECT_NE(refusal(members), "");
}

TEST(MalformedProject, Bombs) {
    const Bytes zeros(std::size_t{20} << 20);
    auto members = good_members();
    members[1] = deflated("project.json", zeros, std::uint32_t(zeros.size()));  // 20 KiB for 20 MiB
    EXPECT_THAT(refusal(members), HasSubstr("project.json is too long"));
    members[1] = deflated("project.json", zeros, 100);  // says 100 bytes
    EXPECT_THAT(refusal(members), HasSubstr("damaged"));
    members[1] =
        deflated("project.json", zeros, std::uint32_t(max_file_bytes) + 1);  // says more than is read
    EXPECT_THAT(refusal(members), HasSubstr("expected: at most 256 MiB"));
    members = good_members();
    const RawMember packed = deflated("m", zeros, std::uint32_t(zeros.size()));
    for (int i = 0; i < 40; ++i) {  // each within the limit, not all together
        members.push_back(packed);
        members.back().name += std::to_string(i);
    }
    EXPECT_THAT(refusal(members), HasSubstr("expected: at most 256 MiB"));
    members.clear();
    for (int i = 0; i < 5000; ++i) members.push_back({"m" + std::to_string(i), {}});
    EXPECT_THAT(refusal(members), HasSubstr("has too many members; expected at most 4096"));
}

TEST(MalformedProject, CutAtEveryByte) {
    const Bytes whole = raw_zip(good_members());
    const Bytes saved = encode_project(decode_project(whole, "x"));
    for (const Bytes& bytes : {whole, saved})
        for (std::size_t size = 0; size < bytes.size(); ++size)
            EXPECT_NE(refusal(Bytes(bytes.begin(), bytes.begin() + std::ptrdiff_t(size))), "") << size;
}

TEST(MalformedProject, AnyByteWrong) {
    const Bytes whole = raw_zip(good_members());
    std::size_t opened = 0;
    for (std::size_t i = 0; i < whole.size(); ++i)
        for (const std::byte flip : {std::byte{1}, std::byte{0x80}, std::byte{0xff}}) {
            Bytes bytes = whole;
            bytes[i] ^= flip;
            opened += refusal(bytes).empty();  // a document or an Error, never anything else
        }
    // The checksums see every change of the contents; what opens has another time, version or attribute.
    EXPECT_LT(opened, 3 * 150u);
}

TEST(MalformedProject, TheFilesOwnNameIsMadePrintable) {
    const std::string error = error_of([] { decode_project(to_bytes("PK"), "a\nb\x1b"); });
    EXPECT_TRUE(error.starts_with("a?b?: ")) << error;
}

}  // namespace
}  // namespace probewarp
