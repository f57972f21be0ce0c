// Files that are no pictures to us: each is called what it is, and a sentence says what to do about it.
#include "io/unread_formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image_checks.h"
#include "io/project.h"
#include "io/zip_archive.h"

namespace probewarp {
namespace {

using namespace testing;
using ::testing::EndsWith;
using ::testing::HasSubstr;

struct Case {
    std::string what;
    File start;
};

File text(std::string_view t) { return bytes_of(t); }

TEST(UnreadFormats, AreCalledWhatTheyAre) {
    const File zeros(300);
    const std::vector<Case> cases{
        {"a WebP picture", join({text("RIFF"), le(4, 99), text("WEBPVP8 ")})},
        {"an AVIF picture", join({be(4, 28), text("ftypavif"), be(4, 0), text("mif1miafavif")})},
        {"an AVIF picture", join({be(4, 24), text("ftypmif1"), be(4, 0), text("mif1avif")})},
        {"a HEIC picture", join({be(4, 24), text("ftypheic"), be(4, 0), text("mif1heic")})},
        {"a HEIC picture", join({be(4, 24), text("ftypmif1"), be(4, 0), text("mif1heic")})},
        {"a raw photograph (Canon CR3)", join({be(4, 24), text("ftypcrx "), be(4, 1), text("crx isom")})},
        {"a film", join({be(4, 24), text("ftypisom"), be(4, 512), text("isommp42")})},
        {"a TIFF picture or a raw photograph", join({text("II*"), bytes({0, 8, 0, 0, 0})})},
        {"a TIFF picture or a raw photograph", join({text("MM"), bytes({0, 42, 0, 0, 0, 8})})},
        {"a raw photograph (Canon CR2)", join({text("II*"), bytes({0, 16, 0, 0, 0}), text("CR\2")})},
        {"a JPEG XL picture", bytes({0xFF, 0x0A, 0x10})},
        {"a JPEG XL picture", join({be(4, 12), text("JXL "), bytes({13, 10, 0x87, 10})})},
        {"a JPEG 2000 picture", join({be(4, 12), text("jP  "), bytes({13, 10, 0x87, 10})})},
        {"an SVG drawing", text("<svg xmlns=\"http://www.w3.org/2000/svg\"/>")},
        {"an SVG drawing", text("\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<!-- a < b -->\n<SVG/>")},
        {"a web page", text("\n<!DOCTYPE html><html>")},
        {"an XML document", text("<?xml version=\"1.0\"?><a/>")},
        {"an icon (ICO)", join({bytes({0, 0, 1, 0, 1, 0}), File(8), le(4, 40), le(4, 22), File(1)})},
        {"a pointer (CUR)", join({bytes({0, 0, 2, 0, 1, 0}), File(8), le(4, 40), le(4, 22), File(1)})},
        {"a GIMP picture (XCF)", text("gimp xcf v011")},
        {"a PDF document", text("%PDF-1.7")},
        {"an OpenEXR picture", bytes({0x76, 0x2F, 0x31, 1})},
        {"a Radiance picture (HDR)", text("#?RADIANCE\n")},
        {"a PCX picture", bytes({10, 5, 1, 8})},
        {"a Windows metafile (EMF)", join({le(4, 1), File(36), text(" EMF")})},
        {"a file packed by gzip", bytes({0x1F, 0x8B, 8})},
        {"a TAR archive", join({File(257), text("ustar")})},
    };
    for (const auto& [what, start] : cases) {
        const File file = join({start, zeros});
        const std::string error = error_of(file, "a.tga");
        EXPECT_THAT(error, HasSubstr("a.tga: is " + what +
                                     ", which cannot be read; expected PNG, JPEG, BMP, "
                                     "TGA, GIF, PSD or PNM, so "));
    }
    EXPECT_THAT(error_of(join({text("qoif"), zeros}), "a.png"), EndsWith("so convert it to PNG first"));
    EXPECT_EQ(unread_format(text("just a text")), std::nullopt);
    EXPECT_EQ(unread_format(zeros), std::nullopt);
}

TEST(UnreadFormats, EveryBeginningIsLookedAtWithinItsEnd) {
    // Each cut is known by as much as stands in it, and at its full size by what is given here; a sanitizer
    // sees whether a byte behind the end is looked at.
    const std::vector<Case> cases{
        {"is a WebP picture", text("RIFFxxxxWEBP")},
        {"is a film", join({be(4, 128), text("ftypxxxx"), File(20)})},
        {"is an SVG drawing", text("<?xml <svg")},
        {"is an icon (ICO)", join({bytes({0, 0, 1, 0, 1, 0}), File(12), le(4, 22), File(1)})},
        {"is an OpenRaster picture", write_zip(std::vector<ZipMember>{{"stack.xml", File(3), true}})}};
    for (const auto& [what, start] : cases) {
        std::string last;
        for (std::size_t size = 0; size <= start.size(); ++size) {
            const File file(start.begin(), start.begin() + std::ptrdiff_t(size));
            const std::string archive = unread_archive(file).value_or("");
            last = archive.empty() ? unread_format(file).value_or("") : archive;
        }
        EXPECT_THAT(last, ::testing::StartsWith(what));
    }
}

TEST(UnreadFormats, ArchivesOfOtherProgramsAreNoProjects) {
    const auto error = [](const std::vector<ZipMember>& members) -> std::string {
        try {
            decode_project(write_zip(members), "a.zip");
            return "";
        } catch (const Error& e) {
            return e.what();
        }
    };
    EXPECT_EQ(
        error({{"mimetype", text("image/openraster"), true}, {"stack.xml", text("<image/>"), false}}),
        "a.zip: is an OpenRaster picture, which cannot be read; expected PNG, JPEG, BMP, TGA, GIF, PSD or "
        "PNM, so export it as PNG from the program that made it");
    EXPECT_THAT(error({{"mimetype", text("application/x-krita"), true}}), HasSubstr("is a Krita picture"));
    EXPECT_THAT(error({{"mimetype", text("application/vnd.oasis.opendocument.graphics"), true}}),
                HasSubstr("is an OpenDocument file"));
    // Packed again by another program: the mimetype is not the first, or not stored as it is.
    EXPECT_THAT(
        error({{"maindoc.xml", text("<DOC/>"), false}, {"mimetype", text("application/x-krita"), false}}),
        HasSubstr("is a Krita picture"));
    EXPECT_THAT(error({{"a.png", File(9), true}, {"stack.xml", text("<image/>"), false}}),
                HasSubstr("is an OpenRaster picture"));
    EXPECT_THAT(error({{"[Content_Types].xml", File(9), true}, {"word/document.xml", File(9), false}}),
                HasSubstr("is a Word document"));
    EXPECT_THAT(error({{"a.png", File(9), true}}), HasSubstr("is not a Probewarp project"));
    EXPECT_EQ(unread_archive(write_zip(std::vector<ZipMember>{{"project.json", File(9), true}})),
              std::nullopt);
    // Where a picture is asked for.
    const std::vector<ZipMember> project{{"mimetype", text("application/x-probewarp"), true}};
    EXPECT_THAT(error_of(write_zip(project), "a.probewarp"),
                HasSubstr("is a Probewarp project, which cannot"));
    EXPECT_THAT(error_of(write_zip(std::vector<ZipMember>{{"a.png", File(9), true}}), "a.zip"),
                HasSubstr("is a ZIP archive, which cannot"));
}

}  // namespace
}  // namespace probewarp
