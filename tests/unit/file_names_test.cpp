// What typed, picked and dropped names mean.
#include "gui/file_names.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "temporary_folder.h"

using namespace probewarp;
namespace fs = std::filesystem;

namespace {

/// A folder with "sub", "sub.probewarp" (a folder too) and "a.png".
struct NamesTest : ::testing::Test {
    const probewarp::testing::TemporaryFolder temporary;
    const fs::path& folder = temporary.path;
    const std::vector<std::string> project{".probewarp"}, pictures{".png", ".jpg"};

    NamesTest() {
        fs::create_directory(folder / "sub");
        fs::create_directory(folder / "dir.probewarp");
        std::ofstream(folder / "a.png") << "a";
    }

    MeantPath saved(std::string_view typed) const { return meant_path(typed, folder, project, true); }
    MeantPath opened(std::string_view typed) const { return meant_path(typed, folder, pictures, false); }
};

}  // namespace

TEST_F(NamesTest, AFolderIsEnteredHoweverItIsTyped) {
    for (const bool saving : {false, true})
        for (const std::string& typed : {std::string("sub"), std::string("sub/"), std::string("./sub//"),
                                         (folder / "sub").string(), (folder / "sub").string() + "/"}) {
            const MeantPath meant = meant_path(typed, folder, project, saving);
            EXPECT_TRUE(meant.is_folder) << typed;
            EXPECT_EQ(meant.path, folder / "sub") << typed;
            EXPECT_EQ(meant.trouble, "") << typed;
        }
    EXPECT_EQ(opened("sub/..").path, folder);
    EXPECT_EQ(opened("/").path, "/");
}

TEST_F(NamesTest, WhatIsNoNameIsRefusedInASentence) {
    for (const char* typed : {"", " ", "   ", ".", "..", "...", ". .", "sub/  ", "missing/", "missing/x"})
        for (const bool saving : {false, true}) {
            const MeantPath meant = meant_path(typed, folder, project, saving);
            EXPECT_TRUE(meant.trouble.ends_with(".")) << typed;
            EXPECT_TRUE(meant.path.empty() && !meant.is_folder) << typed;
        }
    for (const char* typed : {".probewarp", "sub/.PROBEWARP", " .probewarp", "...probewarp", "dir"})
        EXPECT_NE(saved(typed).trouble, "") << typed;
    EXPECT_NE(saved(std::string(246, 'x')).trouble, "");
    EXPECT_NE(opened("b.png").trouble, "");
}

TEST_F(NamesTest, TroubleIsPrintable) {
    EXPECT_EQ(opened("no\nsuch\x1b.png").trouble, "There is no file no?such?.png in this folder.");
    EXPECT_EQ(saved("no\n/x").trouble, "There is no folder " + (folder / "no?").string() + ".");
}

TEST_F(NamesTest, EndingsAreAppendedWhereTheyAreMissing) {
    EXPECT_EQ(saved("x").path, folder / "x.probewarp");
    EXPECT_EQ(saved("x.").path, folder / "x.probewarp");
    EXPECT_EQ(saved("x.png").path, folder / "x.png.probewarp");
    EXPECT_EQ(saved("x.PROBEWARP").path, folder / "x.PROBEWARP");
    EXPECT_EQ(saved("v1.2").path, folder / "v1.2.probewarp");
    EXPECT_EQ(saved(".x").path, folder / ".x.probewarp");
    EXPECT_EQ(saved("sub/x").path, folder / "sub/x.probewarp");
    EXPECT_EQ(saved(std::string(245, 'x')).path.filename().string().size(), most_name_bytes);
    EXPECT_EQ(opened("a.png").path, folder / "a.png");
}

TEST_F(NamesTest, TildeIsHome) {
    const char* old = std::getenv("HOME");
    const std::string kept = old ? old : "";
    ::setenv("HOME", folder.c_str(), 1);
    EXPECT_TRUE(opened("~").is_folder);
    EXPECT_EQ(opened("~/a.png").path, folder / "a.png");
    EXPECT_EQ(saved("~x").path, folder / "~x.probewarp");
    ::setenv("HOME", kept.c_str(), 1);
}

TEST(Names, FitIntoWhatFileSystemsTake) {
    EXPECT_EQ(fitting_name("a", ".png"), "a.png");
    EXPECT_EQ(fitting_name(std::string(300, 'x'), ".png"), std::string(251, 'x') + ".png");
    std::string han;
    for (int i = 0; i < 100; ++i) han += "漢";  // 3 bytes each
    EXPECT_EQ(fitting_name(han, ".png"), han.substr(0, 249) + ".png");
}

TEST(Names, StemsAreMoreThanSpacesAndDots) {
    EXPECT_TRUE(has_stem("/a/b.png"));
    EXPECT_TRUE(has_stem("b"));
    EXPECT_TRUE(has_stem(".b.png"));
    for (const char* path : {"/a/.png", " .png", "/a/", "...png", ""}) EXPECT_FALSE(has_stem(path)) << path;
}

TEST(DroppedPath, IsTheFileThatTheUriMeans) {
    for (const char* dropped : {"/a/b c.png", "file:/a/b c.png", "FILE:/a/b c.png", "file:///a/b c.png",
                                "File://localhost/a/b c.png"})
        EXPECT_EQ(dropped_path(dropped), fs::path("/a/b c.png")) << dropped;
    EXPECT_EQ(dropped_path("/a/x:y.png"), fs::path("/a/x:y.png"));
    for (const char* dropped : {"http://example.org/a.png", "data:image/png;base64,AA", "file:", "file://",
                                "file:a", "file://host"})
        EXPECT_EQ(dropped_path(dropped), std::nullopt) << dropped;
}

TEST(PathField, MeansExactlyWhatWasPutUntilItIsEdited) {
    const std::string folder = "/\xFF\U0001F389",
                      file = folder + "/\x01.png";  // no UTF-8, 17 bits, a control
    PathField field;
    field.put(file);
    EXPECT_EQ(field.text, "/?\uFFFD/?.png");
    EXPECT_EQ(field.meant(), fs::path(file));
    field.text = "/?\uFFFD/new.png";  // the folder stays exact
    EXPECT_EQ(field.meant(), fs::path(folder + "/new.png"));
    field.text = "/else/new.png";
    EXPECT_EQ(field.meant(), fs::path("/else/new.png"));
    field.put_name(file);
    EXPECT_EQ(field.text, "?.png");
    EXPECT_EQ(field.meant(), fs::path(file));
    field.text = "x.png";
    EXPECT_EQ(field.meant(), fs::path("x.png"));
}
