// Projects come back as they were saved, in the same bytes wherever and whenever they are written.
#include "io/project.h"

#include <ctime>

#include "generators.h"
#include "io/file.h"
#include "io/image_file.h"
#include "io/zip_archive.h"
#include "model/paint_ops.h"
#include "pictures.h"
#include "raw_zip.h"
#include "temporary_folder.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::angle;
using testing::Bytes;
using testing::error_of;
using testing::expect_always;
using testing::magnitude;
using testing::real;
using testing::same_paint;
using testing::to_bytes;
using testing::whole;

/// A picture with a real file behind it.
PicturePtr small_picture(std::string_view format = "png") {
    Image image;
    image.width = 3;
    image.height = 2;
    image.rgba = std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255,
                                           1,   2, 3, 0,   9, 9,   9, 128, 0, 0, 0,   255};
    const ImageFormat* row = find_image_format(format);
    const std::string name = "small" + std::string(row->extensions[0]);
    return std::make_shared<const Picture>(decode_picture(row->encode(image, {}), name));
}

Document small_document() {
    Document document;
    document.picture = small_picture();
    add_probe(document, {1, 1}, {2, 1.5}, 7, 2);
    return document;
}

/// One of the places where a number is hard: an end of its range, tiny, or anywhere.
double extreme(double low, double high) {
    return *rc::gen::oneOf(
        rc::gen::element(low, high, std::nextafter(low, high), std::nextafter(high, low)), real(low, high),
        rc::gen::map(magnitude(-320, std::log10(high)), [=](double x) { return std::clamp(x, low, high); }));
}

std::string any_name() {
    const auto letter =
        rc::gen::oneOf(rc::gen::element<std::string>("\"", "\\", "/", " ", "ß", "é", "e\u0301", "日本",
                                                     "\u2028", "🐢", "\u202e", "<&>", "{}"),
                       rc::gen::map(whole(0x20, 0x7e), [](int c) { return std::string(1, char(c)); }));
    std::string name;
    for (const std::string& part : *rc::gen::container<std::vector<std::string>>(letter))
        if (name.size() + part.size() <= 200) name += part;
    return name;
}

/// Paint of any size, with a few painted rectangles; or none.
PaintPtr any_paint() {
    if (*whole(0, 2) == 0) return nullptr;
    const int width = *whole(1, 130), height = *whole(1, 130);
    PaintMap map = empty_paint_map(width, height, {extreme(1e-6, 1e6), extreme(1e-6, 1e6)});
    for (int rectangles = *whole(0, 3); rectangles > 0; --rectangles) {
        const int left = *whole(0, 129), top = *whole(0, 129);
        const auto value = from_stored(std::uint16_t(*whole(0, 65535)));
        const auto coverage = from_stored(std::uint16_t(*whole(1, 65535)));
        edit_texels(map, left, top, left + *whole(1, 70), top + *whole(1, 70), [&](int x, int y, Paint) {
            return Paint{(x + y) % 7 ? value : 1 - value, coverage};
        });
    }
    return std::make_shared<const PaintMap>(std::move(map));
}

Document any_document(const PicturePtr& base) {
    Picture picture = *base;
    picture.name = any_name();
    Document document;
    document.picture = std::make_shared<const Picture>(std::move(picture));
    document.mesh = {*whole(min_cells, max_cells), *whole(0, 1) == 1, *whole(0, 254),
                     extreme(0, max_mesh_margin)};
    const auto schemes = weight_schemes();
    document.weights.scheme = schemes[std::size_t(*whole(0, int(schemes.size()) - 1))].name;
    document.weights.exponent = extreme(min_exponent, max_exponent);
    document.weights.falloff = extreme(0, max_falloff);
    document.weights.most = *whole(0, 1) ? *whole(0, 20) : *rc::gen::element(0, 1, 10000);
    const auto blends = blend_methods();
    document.blend = blends[std::size_t(*whole(0, int(blends.size()) - 1))].name;
    document.stiffness = any_paint();
    const int count = *whole(0, 20);
    const auto place = [] { return extreme(-max_probe_coordinate, max_probe_coordinate); };
    for (int i = 0; i < count; ++i) {
        Probe& probe = add_probe(document, {place(), place()}, {place(), place()});
        if (*whole(0, 9) == 0) probe.id = max_probe_id - i;
        probe.angle = *whole(0, 1) ? *angle(1000) : extreme(-max_probe_angle, max_probe_angle);
        probe.radius = extreme(min_probe_radius, max_probe_coordinate);
        probe.name = any_name();
        probe.colour = {std::uint8_t(*whole(0, 255)), std::uint8_t(*whole(0, 255)),
                        std::uint8_t(*whole(0, 255))};
        probe.locked = *whole(0, 1);
        probe.visible = *whole(0, 1);
        if (*whole(0, 3) == 0) probe.paint = any_paint();
    }
    return document;
}

/// By their texels: documents compare by their pointers.
bool same_paint_or_none(const PaintPtr& a, const PaintPtr& b) {
    return !a == !b && (!a || same_paint(*a, *b));
}

TEST(Project, ComesBackAsItWasSaved) {
    const PicturePtr base = small_picture();
    expect_always("decode(encode(document)) = document, and encodes to the same bytes", [&base] {
        const Document document = any_document(base);
        const Bytes bytes = encode_project(document);
        Document back = decode_project(bytes, "x");
        RC_ASSERT(encode_project(back) == bytes);
        RC_ASSERT(back.picture->name == document.picture->name);
        RC_ASSERT(back.picture->format == document.picture->format);
        RC_ASSERT(back.picture->original == document.picture->original);
        RC_ASSERT(back.picture->image.rgba == document.picture->image.rgba);
        back.picture = document.picture;
        RC_ASSERT(back.probes.size() == document.probes.size());
        RC_ASSERT(same_paint_or_none(back.stiffness, document.stiffness));
        back.stiffness = document.stiffness;
        for (std::size_t i = 0; i < back.probes.size(); ++i) {
            RC_ASSERT(same_paint_or_none(back.probes[i].paint, document.probes[i].paint));
            back.probes[i].paint = document.probes[i].paint;
        }
        RC_ASSERT(back == document);  // every number in every bit
    });
}

TEST(Project, OfTheFirstFormatOpensWithTheWholeGrid) {
    const std::string json = R"({"format": 1, "image": {"file": "image.png", "name": "a.png"},
        "mesh": {"cells": 7}, "weights": "gaussian", "blend": "dlb", "probes": []})";
    const std::vector<ZipMember> members{{"mimetype", to_bytes(project_mimetype), true},
                                         {"project.json", to_bytes(json), false},
                                         {"image.png", small_picture()->original, true}};
    const Bytes bytes = write_zip(members);
    Document expected;
    expected.mesh.cells = 7;
    expected.mesh.from_alpha = false;  // it looks as it did
    expected.weights.scheme = "gaussian";
    Document back = decode_project(bytes, "x");
    expected.picture = back.picture;
    EXPECT_EQ(back, expected);
    // Saved again, it is of the second format and still the whole grid.
    EXPECT_FALSE(decode_project(encode_project(back), "x").mesh.from_alpha);
}

TEST(Project, KeepsThePaintAsItWasNamed) {
    Document document = small_document();
    document.probes[0].id = 17;
    document.probes[0].paint = std::make_shared<const PaintMap>(filled(new_paint_map(3, 2), 0.25f));
    document.stiffness = std::make_shared<const PaintMap>(filled(new_paint_map(3, 2), 1));
    std::vector<std::string> names;
    for (const ZipMember& member : read_zip(encode_project(document), max_file_bytes))
        names.push_back(member.name);
    EXPECT_EQ(names, (std::vector<std::string>{"mimetype", "project.json", "image.png", "paint/17.png",
                                               "stiffness.png"}));
}

TEST(Project, KeepsThePictureInItsOwnFormat) {
    for (const std::string_view format : {"png", "jpeg", "bmp", "tga"}) {  // TGA is known by its name alone
        Document document;
        document.picture = small_picture(format);
        const Bytes bytes = encode_project(document);
        EXPECT_TRUE(read_zip(bytes, max_file_bytes).at(2).stored);  // a BMP would deflate well
        const Document back = decode_project(bytes, "x");
        EXPECT_EQ(back.picture->format, format);
        EXPECT_EQ(back.picture->original, document.picture->original);
        EXPECT_EQ(back.picture->name, document.picture->name);
    }
}

TEST(Project, BeginsWithItsMimetypeUncompressed) {
    // So that `file` and others know it by the bytes 30 to 60: a local header is 30 bytes long.
    const Bytes bytes = encode_project(small_document());
    const Bytes expected = to_bytes("mimetypeapplication/x-probewarp");
    ASSERT_GT(bytes.size(), 30 + expected.size());
    EXPECT_EQ(Bytes(bytes.begin() + 30, bytes.begin() + 30 + std::ptrdiff_t(expected.size())), expected);
    EXPECT_TRUE(is_project(bytes));
    EXPECT_FALSE(is_project(small_picture()->original));
    const auto members = read_zip(bytes, max_file_bytes);
    ASSERT_EQ(members.size(), 3u);
    EXPECT_TRUE(members[0].stored);
    EXPECT_EQ(members[1].name, "project.json");
    EXPECT_FALSE(members[1].stored);
    EXPECT_EQ(members[2].name, "image.png");
}

/// The four bytes of date and time of every member, in both places where an archive has them.
std::vector<std::uint32_t> times_in(const Bytes& zip) {
    std::vector<std::uint32_t> times;
    for (std::size_t i = 0; i + 16 < zip.size(); ++i) {
        const auto at = [&](std::size_t k) { return std::to_integer<std::uint32_t>(zip[i + k]); };
        const bool local = at(0) == 'P' && at(1) == 'K' && at(2) == 3 && at(3) == 4;
        const bool central = at(0) == 'P' && at(1) == 'K' && at(2) == 1 && at(3) == 2;
        const std::size_t place = central ? 12 : 10;
        if (local || central)
            times.push_back(at(place) | at(place + 1) << 8 | at(place + 2) << 16 | at(place + 3) << 24);
    }
    return times;
}

struct TimeZone {
    std::string before = std::getenv("TZ") ? std::getenv("TZ") : "";
    bool was_set = std::getenv("TZ") != nullptr;
    explicit TimeZone(const char* zone) {
        ::setenv("TZ", zone, 1);
        ::tzset();
    }
    TimeZone(const TimeZone&) = delete;
    TimeZone& operator=(const TimeZone&) = delete;
    ~TimeZone() {
        was_set ? ::setenv("TZ", before.c_str(), 1) : ::unsetenv("TZ");
        ::tzset();
    }
};

TEST(Project, KnowsNeitherTheTimeNorWhereItIs) {
    const Document document = small_document();
    const Bytes bytes = encode_project(document);
    for (const char* zone :
         {"UTC", "America/New_York", "Asia/Kathmandu", "XXX+12", "XXX-14", "XXX+11:59YYY,M3.2.0,M11.1.0"}) {
        const TimeZone there(zone);
        EXPECT_EQ(encode_project(document), bytes) << zone;
    }
    // Midnight on the first of 1980 is what the format's clock begins with.
    EXPECT_EQ(times_in(bytes), std::vector<std::uint32_t>(6, 0x00210000));
}

TEST(Project, IsNeverSavedAsSomethingThatWouldNotOpen) {
    const auto refuses = [](auto change) {
        Document document = small_document();
        change(document.probes[0]);
        return error_of([&] { encode_project(document); });
    };
    EXPECT_EQ(refuses([](Probe&) {}), "");
    EXPECT_NE(refuses([](Probe& p) { p.now.x = 2e7; }), "");
    EXPECT_NE(refuses([](Probe& p) { p.angle = std::nan(""); }), "");
    EXPECT_NE(refuses([](Probe& p) { p.radius = 0; }), "");
    EXPECT_NE(refuses([](Probe& p) { p.id = 0; }), "");
    EXPECT_NE(refuses([](Probe& p) { p.name = std::string(201, 'x'); }), "");
    const std::string error = refuses([](Probe& p) { p.rest.y = -2e7; });
    EXPECT_NE(error.find("probes[0].rest"), std::string::npos) << error;
}

TEST(Project, ProbesAreAddedAfterAnyId) {
    Document document = small_document();
    document.probes[0].id = max_probe_id;
    Document back = decode_project(encode_project(document), "x");
    back.probes.push_back(new_probe(back, {0, 0}));
    back.probes.push_back(new_probe(back, {0, 0}));
    const Document again = decode_project(encode_project(back), "x");
    EXPECT_EQ(again.probes[1].id, 1);
    EXPECT_EQ(again.probes[2].id, 2);
}

TEST(Project, AFileIsAProjectOrAPictureWhateverItsName) {
    const testing::TemporaryFolder folder;
    const auto project = folder.path / "a.png", picture = folder.path / "b\n.probewarp";
    write_file(project, encode_project(small_document()));
    write_file(picture, small_picture()->original);
    EXPECT_EQ(read_document(project).probes.size(), 1u);
    const Document plain = read_document(picture);
    EXPECT_TRUE(plain.probes.empty());
    EXPECT_EQ(plain.picture->name, "b_.probewarp");  // fit for one line of text
    EXPECT_EQ(plain.mesh.cells, default_cells);
    EXPECT_EQ(encode_project(decode_project(encode_project(plain), "x")), encode_project(plain));
}

TEST(ZipArchive, WritesWhatItReadsInTheirOrder) {
    const std::vector<ZipMember> members{
        {"b/ü.txt", to_bytes("hello"), true}, {"a", {}, true}, {"c", Bytes(5000), false}};
    const Bytes bytes = write_zip(members);
    EXPECT_LT(bytes.size(), 1000u);
    const auto back = read_zip(bytes, 5005);
    ASSERT_EQ(back.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(back[i].name, members[i].name);
        EXPECT_EQ(back[i].bytes, members[i].bytes);
        EXPECT_EQ(back[i].stored, members[i].stored);
    }
    EXPECT_NE(error_of([&] { read_zip(bytes, 5004); }), "");
}

}  // namespace
}  // namespace probewarp
