// Projects that were unpacked and zipped again: whatever an archiver makes of the same members opens the
// same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bad_projects.h"
#include "io/file.h"
#include "io/zip_archive.h"
#include "model/paint_ops.h"

namespace probewarp {
namespace {

using testing::Bytes;
using testing::deflated;
using ::testing::HasSubstr;
using testing::one_pixel;
using testing::raw_zip;
using testing::RawMember;
using testing::refusal;
using testing::to_bytes;

/// A project with a member in a folder.
Bytes saved() {
    Document document;
    document.picture = std::make_shared<const Picture>(decode_picture(one_pixel(), "one.png"));
    testing::add_probe(document, {0.5, 0.25}, {0.75, 0.5}, 0.3);
    document.probes[0].paint = std::make_shared<const PaintMap>(filled(new_paint_map(1, 1), 0.25f));
    return encode_project(document);
}

std::vector<RawMember> members_of(const Bytes& project) {
    std::vector<RawMember> members;
    for (const ZipMember& member : read_zip(project, max_file_bytes))
        members.push_back({member.name, member.bytes});
    return members;
}

/// Opens them and requires what they were made of.
void expect_the_same(const std::vector<RawMember>& members, const char* what) {
    const Bytes bytes = raw_zip(members);
    ASSERT_EQ(refusal(bytes), "") << what;
    EXPECT_EQ(encode_project(decode_project(bytes, "x")), saved()) << what;
}

/// An entry of a folder, as archivers put it before what is in it.
RawMember folder(const std::string& name) { return {name + "/", {}}; }

TEST(RezippedProject, AnyOrderAndPacking) {
    std::vector<RawMember> members = members_of(saved());
    ASSERT_EQ(members.size(), 4u);
    std::ranges::reverse(members);
    expect_the_same(members, "reversed");
    for (RawMember& member : members)
        member = deflated(member.name, member.bytes, std::uint32_t(member.bytes.size()));
    expect_the_same(members, "deflated");
}

TEST(RezippedProject, FoldersAreNoMembers) {
    std::vector<RawMember> members = members_of(saved());
    members.insert(members.begin(), folder("paint"));
    members.push_back(folder("empty/and/deep"));
    members.push_back(folder("."));
    expect_the_same(members, "folders");
    members.push_back({"paint/", to_bytes("x")});
    EXPECT_NE(refusal(members), "") << "a folder holds no bytes";
}

TEST(RezippedProject, NamesAsOtherArchiversWriteThem) {
    std::vector<RawMember> members = members_of(saved());
    for (RawMember& member : members) member.name = "./" + member.name;
    expect_the_same(members, "./");
    members = members_of(saved());
    for (RawMember& member : members) std::ranges::replace(member.name, '/', '\\');
    expect_the_same(members, "backslashes");
    members.push_back({"paint/1.png", to_bytes("x")});
    EXPECT_THAT(refusal(members), HasSubstr("two members named paint/1.png"));
}

TEST(RezippedProject, TheFolderItLayInMayBeThereToo) {
    for (const std::string wrapping : {"dance/", "dance/again/", "./dance/", "d\xc3\xa9j\xc3\xa0 vu/"}) {
        std::vector<RawMember> members = members_of(saved());
        for (RawMember& member : members) member.name = wrapping + member.name;
        members.insert(members.begin(), folder(wrapping.substr(0, wrapping.size() - 1)));
        members.push_back({"__MACOSX/dance/._image.png", to_bytes("fork")});
        expect_the_same(members, wrapping.c_str());
        members[1].name = "elsewhere/" + members[1].name;
        EXPECT_NE(refusal(members), "") << wrapping;
    }
    std::vector<RawMember> members = members_of(saved());
    std::string deep;
    for (int i = 0; i < 20000; ++i) deep += "a/";
    for (RawMember& member : members) member.name = deep + member.name;
    EXPECT_THAT(refusal(members), HasSubstr("is not a Probewarp project"));
}

TEST(RezippedProject, WhatDesktopsAddIsPassedOver) {
    std::vector<RawMember> members = members_of(saved());
    for (const char* name : {"__MACOSX/._project.json", "__MACOSX/paint/._1.png", ".DS_Store",
                             "paint/.DS_Store", "Thumbs.db", "paint/Thumbs.db", "desktop.ini", "._image.png"})
        members.push_back({name, to_bytes("x")});
    members.back().method = 14;  // nobody unpacks it
    expect_the_same(members, "desktops");
    for (const char* name : {"notes.txt", "MACOSX/x", "thumbs.png", "x.DS_Store", "paint/2.png"}) {
        std::vector<RawMember> more = members;
        more.push_back({name, to_bytes("x")});
        EXPECT_THAT(refusal(more), HasSubstr("has a member " + std::string(name) + " that this version"));
    }
}

TEST(RezippedProject, StreamsThatSayTheSizeBeforehand) {
    std::vector<RawMember> members = members_of(saved());
    for (RawMember& member : members) member.streamed = true;
    expect_the_same(members, "streamed");
}

TEST(RezippedProject, OtherArchivesAreSaidToBeThat) {
    const std::vector<std::pair<std::vector<RawMember>, const char*>> others{
        {{{"notes/today.xml", to_bytes("<w/>")}}, "without the members mimetype and project.json"},
        {{{"mimetype", to_bytes("image/unheard-of")}, {"notes.xml", {}}}, "without a member project.json"},
        {{{"project.json", to_bytes("{}")}}, "without a member mimetype"},
        {{{"../evil", to_bytes("x")}}, "is a ZIP archive without"},
    };
    for (const auto& [members, said] : others) {
        EXPECT_THAT(refusal(members), HasSubstr(said));
        EXPECT_THAT(refusal(members), HasSubstr("so it is not a Probewarp project; expected"));
    }
    std::vector<RawMember> secret{{"secret.txt", to_bytes("x")}};
    secret[0].flags |= 1, secret[0].method = 14;
    EXPECT_THAT(refusal(secret), HasSubstr("is not a Probewarp project")) << "that first, not its packing";
}

}  // namespace
}  // namespace probewarp
