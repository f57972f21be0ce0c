// io/psd*.cpp: files that are not read, by what they are, damaged ones, and what is salvaged of them.
#include <gtest/gtest.h>

#include "image_checks.h"
#include "psd_files.h"

namespace probewarp {
namespace {

using namespace testing;

TEST(PsdMalformed, WhatIsNotReadIsNamed) {
    const File data = bytes({1, 2, 3});
    ASSERT_EQ(error_of(make_psd({.rows = data}), "a.psd"), "");
    expect_refused(make_psd({.mode = 6, .rows = data}), "a.psd",
                   "is a PSD in HSB mode; expected bitmap, grey, indexed, RGB, CMYK, multichannel, duotone "
                   "or Lab");
    expect_refused(make_psd({.mode = 300, .rows = data}), "a.psd", "is a PSD in mode 300, which is unknown");
    expect_refused(make_psd({.mode = 4, .bits = 32, .channels = 4, .rows = data}), "a.psd",
                   "has 32 bits a channel in CMYK mode; expected a PSD with 8 or 16");
    expect_refused(make_psd({.bits = 0, .rows = data}), "a.psd",
                   "has 0 bits a channel in RGB mode; expected a PSD with 8, 16 or 32");
    expect_refused(make_psd({.rows = data, .compression = 4}), "a.psd",
                   "is packed in an unknown way (4); expected a PSD whose merged picture is raw, RLE or ZIP");
    expect_refused(make_psd({.mode = 6, .rows = data, .large = true}), "a.psb", "is a PSB in HSB mode");
    File future = make_psd({.rows = data});
    future[5] = std::byte{3};
    expect_refused(future, "a.psd", "is a PSD of version 3; expected version 1 (PSD) or 2 (PSB)");
}

TEST(PsdMalformed, BadOnesAreRefused) {
    const File data = bytes({1, 2, 3});
    expect_refused(make_psd({.channels = 2, .rows = data}), "a.psd", "too few or too many channels");
    expect_refused(make_psd({.channels = 57, .rows = File(57)}), "a.psd", "too few or too many channels");
    expect_refused(make_psd({.mode = 7, .channels = 0, .rows = data}), "a.psd", "too few or too many");
    expect_refused(make_psd({.width = 40000, .rows = data}), "a.psd", "is 40000 x 1 pixels");
    expect_refused(make_psd({.width = 300000, .rows = data, .large = true}), "a.psb", "is 300000 x 1 pixels");
    expect_refused(make_psd({.width = 9000, .height = 9000, .rows = data}), "a.psd", "is truncated");
    expect_refused(make_psd({.mode = 2, .channels = 1, .rows = data}), "a.psd", "it has no palette");
    const auto packed = [](const File& row) {
        return make_psd(
            {.mode = 1, .channels = 1, .width = 2, .rows = join({be(2, row.size()), row}), .compression = 1});
    };
    ASSERT_EQ(error_of(packed(bytes({1, 2, 3})), "a.psd"), "");
    expect_refused(packed(bytes({2, 2, 3, 4})), "a.psd", "a row has the wrong length");
    expect_refused(packed(bytes({1, 2})), "a.psd", "a row has the wrong length");
    expect_refused(packed(bytes({0, 2})), "a.psd", "a row is too short");
}

TEST(PsdMalformed, BadDeflatedOnesAreRefused) {
    const auto zip = [](const File& rows, int compression = 2) {
        return make_psd({.width = 2, .rows = rows, .compression = compression});
    };
    const File sound = deflated(bytes({1, 2, 3, 4, 5, 6}));
    ASSERT_EQ(error_of(zip(sound), "a.psd"), "");
    File wrong_sum = sound;
    wrong_sum.back() ^= std::byte{1};
    expect_refused(zip(wrong_sum), "a.psd", "its ZIP data make no sense");
    expect_refused(zip(bytes({1, 2, 3, 4})), "a.psd", "its ZIP data make no sense");
    expect_refused(zip(deflated(bytes({1, 2, 3, 4, 5}))), "a.psd", "pixels are missing");
    expect_refused(
        make_psd({.mode = 0, .bits = 1, .channels = 1, .rows = deflated(bytes({1})), .compression = 3}),
        "a.psd", "differences of single bits");
    // Far more than the picture needs.
    EXPECT_EQ(pixels(decode(zip(deflate_bomb(64)))), std::vector<Rgba>(2, Rgba{0, 0, 0, 255}));
}

TEST(PsdMalformed, TransparencyBehindAGigabyteOfOtherChannelsIsRefused) {
    // Zeros for the first channel: without the limit, gigabytes could follow in a file of some megabytes.
    const auto psd = [](int before, int compression, const File& rows) {
        File ids;
        for (int i = 0; i < before; ++i) ids += be(4, 5);
        return make_psd({.mode = 1,
                         .channels = 56,
                         .width = 10000,
                         .height = 10000,
                         .rows = rows,
                         .compression = compression,
                         .resources = psd_resource(1053, join({ids, be(4, 0)}))});
    };
    for (const int compression : {2, 3}) {
        const File rows = deflated(File(20'000));
        expect_refused(
            psd(11, compression, rows), "a.psd",
            "a.psd: has its transparency behind 11 large channels that are deflated and no part of "
            "the picture; expected a PSD that has it right behind the colours");
        expect_refused(psd(54, compression, rows), "a.psd", "behind 54 large channels");
        expect_refused(psd(10, compression, rows), "a.psd", "pixels are missing");
    }
    expect_refused(psd(54, 0, File(20'000)), "a.psd", "is truncated");  // passing over these costs nothing
}

TEST(PsdMalformed, EachCutIsRefused) {
    const PsdSpec raw{.bits = 16,
                      .channels = 4,
                      .width = 5,
                      .height = 4,
                      .rows = File(160),
                      .resources = psd_resolution(72, 72, 1),
                      .layers = psd_layer_count(-1)};
    PsdSpec large = raw;
    large.large = true;
    large.layers = psd_layer_count(-1, true);
    expect_each_cut_refused(make_psd(raw), "a.psd");
    expect_each_cut_refused(make_psd(large), "a.psb");
    expect_each_cut_refused(make_psd({.mode = 1,
                                      .channels = 1,
                                      .width = 2,
                                      .height = 2,
                                      .rows = join({be(2, 3), be(2, 2), bytes({1, 2, 3, 255, 4})}),
                                      .compression = 1}),
                            "a.psd");
    expect_each_cut_refused(
        make_psd({.width = 2, .rows = deflated(bytes({1, 2, 3, 4, 5, 6})), .compression = 2}), "a.psd");
}

// ---- salvaging ----

Image salvaged(const File& file) {
    return decode_picture(file, "a.psd", Pixels::whole, {.salvage = true}).image;
}

void expect_salvaged(const File& file, const std::vector<Rgba>& meaning) {
    EXPECT_THROW(decode_picture(file, "a.psd"), IncompleteFile);
    const Image image = salvaged(file);
    EXPECT_TRUE(image.incomplete);
    EXPECT_EQ(pixels(image), meaning);
}

TEST(PsdMalformed, SalvagedIsWhatIsThere) {
    // Two rows of two: red is whole, green has its first row, and blue is missing.
    expect_salvaged(make_psd({.width = 2, .height = 2, .rows = bytes({1, 2, 3, 4, 5, 6, 7})}),
                    {{1, 5, 0, 255}, {2, 6, 0, 255}, {3, 0, 0, 255}, {4, 0, 0, 255}});
    // What has lost its first channel is clear; missing inks are none, and missing alpha is full.
    expect_salvaged(make_psd({.mode = 1, .channels = 1, .height = 2, .rows = bytes({9})}),
                    {{9, 9, 9, 255}, {0, 0, 0, 0}});
    expect_salvaged(make_psd({.mode = 4, .channels = 4, .rows = bytes({9})}), {{9, 255, 255, 255}});
    expect_salvaged(make_psd({.mode = 1, .channels = 2, .rows = bytes({9}), .layers = psd_layer_count(-1)}),
                    {{9, 9, 9, 255}});
    // A channel that is no part of the picture is missing.
    expect_salvaged(make_psd({.channels = 4, .rows = bytes({1, 2, 3})}), {{1, 2, 3, 255}});
}

TEST(PsdMalformed, SalvagedPackedAndDeflated) {
    const auto packed = [](const File& rows) {
        return make_psd({.mode = 1,
                         .channels = 1,
                         .height = 3,
                         .rows = join({be(2, 2), be(2, 2), be(2, 2), rows}),
                         .compression = 1});
    };
    const Rgba nothing{0, 0, 0, 0}, seven{7, 7, 7, 255}, nine{9, 9, 9, 255};
    expect_salvaged(packed(bytes({0, 7, 0, 9, 0})), {seven, nine, nothing});
    expect_salvaged(packed(bytes({0, 7, 5, 8, 0, 9})), {seven, nothing, nine});
    const auto zip = [](const File& rows) {
        return make_psd({.mode = 1, .channels = 1, .height = 2, .rows = rows, .compression = 2});
    };
    expect_salvaged(zip(deflated(bytes({7}))), {seven, nothing});
}

TEST(PsdMalformed, WithoutItsFirstRowThereIsNothingToSalvage) {
    const auto refused = [](const File& file) {
        for (const bool salvage : {false, true}) {
            try {
                decode_picture(file, "a.psd", Pixels::whole, {.salvage = salvage});
                ADD_FAILURE() << "opened";
            } catch (const IncompleteFile& error) {
                ADD_FAILURE() << "as if it could be salvaged: " << error.what();
            } catch (const Error&) {
            }
        }
    };
    refused(make_psd({.width = 2, .height = 2, .rows = bytes({1})}));
    refused(make_psd({.width = 2, .height = 2, .rows = join({be(2, 2), be(2, 2)}), .compression = 1}));
    refused(make_psd({.mode = 1,
                      .channels = 1,
                      .height = 2,
                      .rows = join({be(2, 2), be(2, 2), bytes({9, 9, 0, 1})}),
                      .compression = 1}));
    refused(make_psd({.width = 2, .rows = deflated(bytes({1})), .compression = 2}));
    File cut = make_psd({.rows = bytes({1, 2, 3}), .resources = psd_resolution(72, 72, 1)});
    cut.resize(40);
    refused(cut);
}

}  // namespace
}  // namespace probewarp
