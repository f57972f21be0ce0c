// The mesh as a Wavefront OBJ: its exact text, that every place comes back, and the files that come with it.
#include "io/obj.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "io/file.h"
#include "io/image_file.h"
#include "pictures.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::blank_document;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

Deformation deformed(const Document& document) {
    Deformation deformation;
    update(deformation, document);
    return deformation;
}

/// Eight by four pixels of one colour, the last one of which is as opaque as said.
Document coloured(std::uint8_t last_alpha) {
    Picture picture = *testing::blank_picture(8, 4);
    std::vector<std::uint8_t> rgba(8 * 4 * 4, 255);
    rgba.back() = last_alpha;
    picture.image.rgba = rgba;
    Document document;
    document.picture = std::make_shared<const Picture>(std::move(picture));
    document.mesh.cells = 2;
    return document;
}

TEST(Obj, OfTwoCells) {
    Document document = blank_document(8, 4, 2);
    add_probe(document, {-4, 2}, {-3, 2.5});  // everything by (1, 1/2)
    EXPECT_EQ(encode_obj(deformed(document), "two.mtl"),
              "# Probewarp: x right, y up, in image pixels from the picture's lower left corner\n"
              "mtllib two.mtl\n"
              "v 1 3.5 0\n"
              "v 5 3.5 0\n"
              "v 9 3.5 0\n"
              "v 1 -0.5 0\n"
              "v 5 -0.5 0\n"
              "v 9 -0.5 0\n"
              "vt 0 1\n"
              "vt 0.5 1\n"
              "vt 1 1\n"
              "vt 0 0\n"
              "vt 0.5 0\n"
              "vt 1 0\n"
              "usemtl picture\n"
              "f 1/1 5/5 2/2\n"
              "f 1/1 4/4 5/5\n"
              "f 2/2 6/6 3/3\n"
              "f 2/2 5/5 6/6\n");
}

TEST(Obj, ForStandardOutputNamesNoOtherFile) {
    const std::string text = encode_obj(deformed(blank_document(8, 4, 2)));
    EXPECT_EQ(text.find("mtl"), std::string::npos);
}

/// The mesh as a reader of OBJ sees it.
struct ReadObj {
    std::vector<glm::dvec2> v, vt;
    std::vector<std::array<std::size_t, 3>> f;

    explicit ReadObj(const std::string& text) {
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words(line);
            std::string kind;
            glm::dvec2 at;
            words >> kind;
            if (kind == "v" || kind == "vt") {
                words >> at.x >> at.y;
                (kind == "v" ? v : vt).push_back(at);
            } else if (kind == "f") {
                std::array<std::size_t, 3>& corners = f.emplace_back();
                for (std::size_t& corner : corners) {
                    std::string pair;
                    words >> pair;
                    corner = std::size_t(std::atoll(pair.c_str())) - 1;
                }
            }
        }
    }
    /// Twice the area; positive where the front is towards +z.
    double area(const std::array<std::size_t, 3>& t) const {
        const glm::dvec2 p = v[t[1]] - v[t[0]], q = v[t[2]] - v[t[0]];
        return p.x * q.y - p.y * q.x;
    }
};

TEST(Obj, AtRestLiesWhereItsTextureDoes) {
    const ReadObj read(encode_obj(deformed(blank_document(30, 20, 7))));
    ASSERT_EQ(read.v.size(), read.vt.size());
    for (std::size_t i = 0; i < read.v.size(); ++i) {
        EXPECT_NEAR(read.v[i].x, 30 * read.vt[i].x, 1e-5);
        EXPECT_NEAR(read.v[i].y, 20 * read.vt[i].y, 1e-5);
    }
}

TEST(Obj, FrontsAreTowardsTheViewer) {
    Document document = blank_document(1000, 700, 7);
    add_probe(document, {100, 200}, {130, 210}, 0.7);  // on the mesh: cells are cut at the probes
    add_probe(document, {800, 600}, {790, 640}, -0.3);
    const ReadObj read(encode_obj(deformed(document)));
    ASSERT_GT(read.f.size(), 70u);
    for (const auto& triangle : read.f) EXPECT_GT(read.area(triangle), 0);
}

TEST(Obj, HasNineDigitsSoThatEveryPlaceComesBack) {
    Document document = blank_document(1000, 700, 7);
    add_probe(document, {100, 200}, {130, 210}, 0.7);
    add_probe(document, {800, 600}, {-1.0 / 3, 1e-7}, -30);
    const Deformation deformation = deformed(document);
    const ReadObj read(encode_obj(deformation));
    ASSERT_EQ(read.v.size(), deformation.now.size());
    for (std::size_t i = 0; i < read.v.size(); ++i) {
        EXPECT_EQ(float(read.v[i].x), deformation.now[i].x);
        // 700 - y below 10,000 has five digits behind the point, and a float near 700 no more.
        EXPECT_NEAR(700 - read.v[i].y, double(deformation.now[i].y), 5e-6);
    }
}

TEST(Mtl, ShowsThePictureAndItsAlpha) {
    EXPECT_EQ(encode_mtl(deformed(coloured(255)), "a/cat.obj", "cat-texture.png"),
              "# Probewarp: the material of cat.obj\nnewmtl picture\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nd 1\n"
              "illum 0\nmap_Kd cat-texture.png\n");
    EXPECT_THAT(encode_mtl(deformed(coloured(254)), "cat.obj", "t.png"),
                HasSubstr("map_Kd t.png\nmap_d t.png\n"));
}

TEST(ObjCompanions, AreNamedSoThatReadersFindThem) {
    const auto named = [](const char* obj) {
        const auto [material, texture] = obj_companions(obj);
        return material.string() + " " + texture.string();
    };
    EXPECT_EQ(named("a b/cat.obj"), "a b/cat.mtl a b/cat-texture.png");
    EXPECT_EQ(named("my cat #2.obj"), "my_cat__2.mtl my_cat__2-texture.png");
    EXPECT_EQ(named("./-s 2.obj"), "./_s_2.mtl ./_s_2-texture.png");
    EXPECT_EQ(named("a\nb\\\".obj"), "a_b__.mtl a_b__-texture.png");
    EXPECT_EQ(named("猫.obj"), "猫.mtl 猫-texture.png");
    EXPECT_THAT(obj_files("d/cat.obj"), ElementsAre("d/cat-texture.png", "d/cat.mtl", "d/cat.obj"));
}

class ObjFiles : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder = fs::temp_directory_path() / fs::path(std::string("probewarp-obj-") + info->name());
        fs::remove_all(folder);
        fs::create_directory(folder);
    }
    void TearDown() override { fs::remove_all(folder); }

    std::string write(const char* name, std::uint8_t alpha = 255) {
        return error_of([&] { write_obj(obj_contents(folder / name, deformed(coloured(alpha)))); });
    }
    void put(const char* name, const std::string& text) { std::ofstream(folder / name) << text; }
    std::string text_of(const char* name) {
        const auto bytes = read_file(folder / name);
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }

    fs::path folder;
};

TEST_F(ObjFiles, HoldThePictureAsItWas) {
    ASSERT_EQ(write("my cat.obj", 7), "");
    EXPECT_THAT(text_of("my cat.obj"), HasSubstr("\nmtllib my_cat.mtl\n"));
    EXPECT_THAT(text_of("my_cat.mtl"), HasSubstr("\nmap_Kd my_cat-texture.png\n"));
    const Image texture = read_picture(folder / "my_cat-texture.png").image,
                image = coloured(7).picture->image;
    EXPECT_EQ(texture.width, image.width);
    EXPECT_EQ(texture.rgba, image.rgba);
}

TEST_F(ObjFiles, ReplaceThoseOfTheSameObj) {
    ASSERT_EQ(write("cat.obj", 255), "");
    EXPECT_EQ(text_of("cat.mtl").find("map_d"), std::string::npos);
    ASSERT_EQ(write("cat.obj", 7), "");
    EXPECT_THAT(text_of("cat.mtl"), HasSubstr("map_d"));
}

TEST_F(ObjFiles, NeverReplaceWhatIsNotTheirs) {
    put("cat.mtl", "newmtl fur\n");
    EXPECT_THAT(write("cat.obj"), HasSubstr("cat.mtl: would be written with cat.obj, but is there already"));
    EXPECT_EQ(text_of("cat.mtl"), "newmtl fur\n");
    put("dog-texture.png", "a photograph");
    EXPECT_THAT(write("dog.obj"), HasSubstr("dog-texture.png: would be written with dog.obj"));
    EXPECT_EQ(text_of("dog-texture.png"), "a photograph");
    // Of two names that become one the later one is refused.
    EXPECT_EQ(write("a b.obj"), "");
    EXPECT_THAT(write("a_b.obj"), HasSubstr("a_b.mtl: would be written with a_b.obj"));
    // A dangling link is somebody's too.
    fs::create_symlink("nowhere", folder / "fox.mtl");
    EXPECT_THAT(write("fox.obj"), HasSubstr("fox.mtl"));
    for (const char* name : {"cat.obj", "dog.obj", "dog.mtl", "a_b.obj", "nowhere", "fox.obj"})
        EXPECT_FALSE(fs::exists(folder / name)) << name;
}

TEST_F(ObjFiles, DoNotComeUnderOneName) {
    EXPECT_THAT(write("cat.mtl"), HasSubstr("expected one that ends with .obj"));
    EXPECT_TRUE(fs::is_empty(folder));
}

}  // namespace
}  // namespace probewarp
