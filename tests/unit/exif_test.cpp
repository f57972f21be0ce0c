// EXIF on its way through: which way is up, the resolution, and what is handed on of the rest.
#include "io/exif.h"

#include <random>

#include "exif_files.h"
#include "image_checks.h"

namespace probewarp {
namespace {

using namespace testing;

constexpr std::array orders{ByteOrder{false}, ByteOrder{true}};

/// What a camera writes.
ExifTags camera_tags(const ByteOrder& order) {
    return {.main = {text(0x010E, "a lake"), text(0x010F, "Maker"), order.two(0x0112, 6),
                     order.rational(0x011A, 300, 1), order.rational(0x011B, 150, 1), order.two(0x0128, 2),
                     text(0x0132, "2020:01:02 03:04:05"), text(0x013B, "Ann"), text(0x8298, "(c) Ann")},
            .exif = {order.rational(0x829A, 1, 250), text(0x9003, "2020:01:02 03:04:05"),
                     undefined(0x927C, "MAKERNOTES"),
                     undefined(0x9286, std::string_view("ASCII\0\0\0hi", 10)), order.two(0xA001, 1),
                     order.four(0xA002, 640), order.four(0xA003, 480), text(0xA434, "a lens")},
            .gps = {text(1, "N"),
                    {2, TagType::rational, 3,
                     join({order.number(4, 52), order.number(4, 1), order.number(4, 30), order.number(4, 1),
                           order.number(4, 155), order.number(4, 10)})}},
            .thumbnail = {order.two(0x0103, 6)},
            .thumbnail_file = bytes({0xFF, 0xD8, 0xFF, 0xD9})};
}

TEST(Exif, WhatIsSaidOfThePictureIsHandedOn) {
    for (const ByteOrder order : orders) {
        const ExifTags tags = camera_tags(order);
        const Exif exif = parse_exif(make_exif(order, tags));
        EXPECT_EQ(exif.orientation, 6);
        EXPECT_EQ(exif.resolution, (Resolution{11811, 5906}));
        const auto kept = tags_of(exif.block);
        EXPECT_EQ(exif.block[0], std::byte(order.big ? 'M' : 'I'));
        for (const int tag : {0x010E, 0x010F, 0x0132, 0x013B, 0x8298}) {
            const auto original = std::ranges::find(tags.main, tag, &Tag::tag);
            EXPECT_EQ(kept.at("main").at(tag), original->value) << tag;
        }
        for (const int tag : {0x829A, 0x9003, 0x9286, 0xA001, 0xA434}) {
            const auto original = std::ranges::find(tags.exif, tag, &Tag::tag);
            EXPECT_EQ(kept.at("exif").at(tag), original->value) << tag;
        }
        EXPECT_EQ(kept.at("gps").at(2), tags.gps[1].value);
        EXPECT_EQ(kept.at("main").at(0x0112), order.number(2, 1)) << "upright";
    }
}

TEST(Exif, WhatDescribesTheStoredPixelsIsLeftOut) {
    for (const ByteOrder order : orders) {
        const auto kept = tags_of(parse_exif(make_exif(order, camera_tags(order))).block);
        for (const int tag : {0x011A, 0x011B, 0x0128}) EXPECT_FALSE(kept.at("main").contains(tag)) << tag;
        for (const int tag : {0xA002, 0xA003, 0x927C}) EXPECT_FALSE(kept.at("exif").contains(tag)) << tag;
        EXPECT_FALSE(kept.contains("next")) << "the thumbnail";
        // As in a TIFF file: where strips and further directories lie, which is nowhere now.
        const ExifTags tiff{.main = {order.four(0x0100, 9), order.four(0x0101, 9), order.two(0x0103, 1),
                                     text(0x010E, "x"), order.four(0x0111, 8), order.four(0x0117, 8),
                                     order.four(0x014A, 8)}};
        const auto of_tiff = tags_of(parse_exif(make_exif(order, tiff)).block).at("main");
        EXPECT_EQ(of_tiff.size(), 1u);
        EXPECT_TRUE(of_tiff.contains(0x010E));
    }
}

TEST(Exif, NothingIsAddedThatNobodyStated) {
    for (const ByteOrder order : orders) {
        const Exif exif = parse_exif(make_exif(order, {.main = {text(0x8298, "me")}}));
        EXPECT_EQ(exif.resolution, std::nullopt) << "no 72 dots per inch";
        const auto kept = tags_of(exif.block);
        EXPECT_EQ(kept.size(), 1u);
        EXPECT_EQ(kept.at("main").size(), 1u);
        // Nothing but the way up and the resolution, which are applied: nothing is left to be said.
        const ExifTags applied{.main = {order.two(0x0112, 3), order.rational(0x011A, 72, 1),
                                        order.rational(0x011B, 72, 1), order.two(0x0128, 2)}};
        EXPECT_TRUE(parse_exif(make_exif(order, applied)).block.empty());
        EXPECT_EQ(parse_exif(make_exif(order, applied)).resolution, (Resolution{2835, 2835}));
    }
}

TEST(Exif, ResolutionsThatMeanNothingAreNone) {
    const auto resolution = [](std::uint64_t x, std::uint64_t over, int unit) {
        const ByteOrder order{true};
        return parse_exif(make_exif(order, {.main = {order.rational(0x011A, x, over),
                                                     order.rational(0x011B, x, over),
                                                     order.two(0x0128, std::uint64_t(unit))}}))
            .resolution;
    };
    EXPECT_EQ(resolution(50, 1, 3), (Resolution{5000, 5000}));
    EXPECT_EQ(resolution(254, 10, 2), (Resolution{1000, 1000}));
    EXPECT_EQ(resolution(300, 1, 1), std::nullopt) << "of no unit";
    EXPECT_EQ(resolution(300, 1, 9), std::nullopt);
    EXPECT_EQ(resolution(300, 0, 2), std::nullopt);
    EXPECT_EQ(resolution(0, 1, 2), std::nullopt);
}

TEST(Exif, IsTheSameOnceMore) {
    for (const ByteOrder order : orders) {
        const Exif once = parse_exif(make_exif(order, camera_tags(order)));
        const Exif twice = parse_exif(once.block);
        EXPECT_EQ(twice.block, once.block);
        EXPECT_EQ(twice.orientation, 1);
        EXPECT_EQ(twice.resolution, std::nullopt);
    }
}

TEST(Exif, BadBlocksAreHarmless) {
    const File sound = make_exif(orders[0], camera_tags(orders[0]));
    for (std::size_t size = 0; size < sound.size(); ++size)
        EXPECT_NO_THROW(tags_of(parse_exif(Bytes(sound).first(size)).block)) << size;
    std::mt19937 random(3);
    for (int run = 0; run < 3000; ++run) {
        File bad = sound;
        for (int i = 0; i < 3; ++i) bad[random() % bad.size()] = std::byte(random());
        const Exif exif = parse_exif(bad);
        EXPECT_TRUE(exif.orientation >= 1 && exif.orientation <= 8);
        EXPECT_LE(exif.block.size(), max_exif_bytes);
    }
    EXPECT_TRUE(parse_exif(File(max_exif_source_bytes + 1)).block.empty());
}

TEST(Exif, GoesThroughPngAndJpeg) {
    const File tiff = make_exif(orders[1], camera_tags(orders[1]));
    const File block = parse_exif(tiff).block;
    std::vector<std::uint8_t> samples(24 * 16 * 3, 100);
    const File jpeg = with_marker(make_jpeg(24, 16, 3, JCS_RGB, samples), exif_app1(tiff));
    const Image image = decode(jpeg);
    EXPECT_EQ(image.description.exif, block);
    EXPECT_EQ(image.width, 16) << "turned upright";
    for (const char* format : {"png", "jpeg"}) {
        const File written = encode(image, format);
        const Image back = decode(written);
        EXPECT_EQ(back.width, 16) << "and not once more";
        EXPECT_EQ(back.description.exif, block);
        EXPECT_EQ(encode(image, format), written);
    }
}

TEST(Exif, ThatIsTooLongForJpegIsLeftOut) {
    Image image{1, 1, std::vector<std::uint8_t>{1, 2, 3, 255}, {}};
    const File bare = encode(image, "jpeg");
    image.description.exif = parse_exif(make_exif(orders[0], {.main = {text(0x8298, "me")}})).block;
    image.description.exif.resize(max_exif_bytes);
    EXPECT_EQ(encode(image, "jpeg").size(), bare.size() + 65535 + 2);
    image.description.exif.push_back({});
    EXPECT_EQ(encode(image, "jpeg"), bare);
}

}  // namespace
}  // namespace probewarp
