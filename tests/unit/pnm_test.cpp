// Netpbm's P1 to P6, PAM and PFM.
#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "image_checks.h"
#include "salvage.h"

namespace probewarp {
namespace {

using namespace testing;

constexpr Rgba black{0, 0, 0, 255}, white{255, 255, 255, 255}, clear{0, 0, 0, 0};
constexpr Rgba red{255, 0, 0, 255}, blue{0, 0, 255, 255};

std::vector<Rgba> of(std::string_view text) { return pixels(decode(bytes_of(text))); }

TEST(Pnm, OfEveryKind) {
    EXPECT_EQ(of("P1 # a comment\n3 1\n1 0\n1"), (std::vector<Rgba>{black, white, black}));
    EXPECT_EQ(of("P1\n3 1\n101"), (std::vector<Rgba>{black, white, black}));
    EXPECT_EQ(of("P2\n2 1\n4\n0#x\n1\n"), (std::vector<Rgba>{black, {64, 64, 64, 255}}));
    EXPECT_EQ(of("P3 1 2 255 255 0 0 0 0 255 "), (std::vector<Rgba>{red, blue}));
    EXPECT_EQ(of("P4\n9 2\n\x80\x80\x7f\x7f"), ([&] {
                  std::vector<Rgba> all(18, white);
                  all[0] = all[8] = black;
                  for (std::size_t i = 10; i < 17; ++i) all[i] = black;
                  return all;
              }()));
    EXPECT_EQ(of("P5 2 1 255\n\x01\xfe"), (std::vector<Rgba>{{1, 1, 1, 255}, {254, 254, 254, 255}}));
    EXPECT_EQ(of("P6 1 1 100\nd2#"), (std::vector<Rgba>{{255, 128, 89, 255}}));
    const Image deep = decode(bytes_of("P6 1 1 65535\n\x01\x02\x03\x04\x05\x06"));
    EXPECT_EQ(deep.bits(), 16);
    EXPECT_EQ(pixels(deep), (std::vector<Rgba>{{258, 772, 1286, 65535}}));
    EXPECT_EQ(decode(bytes_of("P2 1 1 256 256 ")).bits(), 16);
}

TEST(Pnm, BadOnesAreRefused) {
    expect_refused(bytes_of("P5 2 1 0\n\x01\x01"), "a.pgm", "its highest sample is not 1 to 65535");
    expect_refused(bytes_of("P5 2 1 65536\n\x01\x01"), "a.pgm", "its highest sample is not 1 to 65535");
    expect_refused(bytes_of("P5 2 -1 255\n\x01\x01"), "a.pgm", "a number is missing");
    expect_refused(bytes_of("P5 2 99999999999 255\n\x01\x01"), "a.pgm", "a number is too large");
    expect_refused(bytes_of("P5 0 1 255\n\x01\x01"), "a.pgm", "is 0 x 1 pixels");
    expect_refused(bytes_of("P1 2 1\n12\n"), "a.pbm", "a bit is neither 0 nor 1");
    for (const char kind : {'1', '2', '3', '4', '5', '6'})
        expect_refused(bytes_of(std::string("P").append(1, kind).append(" 9000 9000 255\n1")), "a.pnm",
                       "is truncated");
}

TEST(Pnm, CommentsAnywhereInTheHeader) {
    EXPECT_EQ(of("P5#a\n#b\n2#c\n#d\n 1 # e\n255#f\n\x01\x02"),
              (std::vector<Rgba>{{1, 1, 1, 255}, {2, 2, 2, 255}}));
    // One space ends the header: what follows are samples, whatever they look like.
    EXPECT_EQ(of("P5 2 1 255 #\n"), (std::vector<Rgba>{{35, 35, 35, 255}, {10, 10, 10, 255}}));
    EXPECT_EQ(of("P1\n3 1\n1#x\n0 # y\n1"), (std::vector<Rgba>{black, white, black}));
}

TEST(Pnm, SamplesAboveTheHighestOneAreFull) {
    EXPECT_EQ(of("P5 2 1 100\n2\xff"), (std::vector<Rgba>{{128, 128, 128, 255}, white}));
    EXPECT_EQ(of("P2 2 1 100 0 70000 "), (std::vector<Rgba>{black, white}));
}

TEST(Pnm, NumbersEndWithWhiteSpace) {
    for (const char* header : {"P6 1 1 1e3\n", "P6 1 1 0x10\n", "P6 1,5 1 255\n", "P7\nWIDTH 1.0\n"})
        expect_refused(join({bytes_of(header), File(20)}), "a.ppm", "a number ends in something else");
}

// ---- PAM ----

std::string pam(int depth, int highest, std::string_view type, std::string_view data) {
    const std::string line = type.empty() ? "" : "TUPLTYPE " + std::string(type) + "\n";
    return "P7\nWIDTH 2\nHEIGHT 1\nDEPTH " + std::to_string(depth) + "\nMAXVAL " + std::to_string(highest) +
           "\n" + line + "ENDHDR\n" + std::string(data);
}

TEST(Pnm, PamOfEveryType) {
    EXPECT_EQ(of(pam(1, 1, "BLACKANDWHITE", std::string_view("\0\1", 2))), (std::vector<Rgba>{black, white}))
        << "1 is white, unlike in PBM";
    EXPECT_EQ(of(pam(2, 1, "BLACKANDWHITE_ALPHA", std::string_view("\0\1\1\0", 4))),
              (std::vector<Rgba>{black, {255, 255, 255, 0}}));
    const std::vector<Rgba> grey{{97, 97, 97, 255}, {98, 98, 98, 255}};
    EXPECT_EQ(of(pam(1, 255, "GRAYSCALE", "ab")), grey);
    EXPECT_EQ(of(pam(1, 255, "", "ab")), grey);
    const std::vector<Rgba> grey_alpha{{97, 97, 97, 98}, {99, 99, 99, 100}};
    EXPECT_EQ(of(pam(2, 255, "GRAYSCALE_ALPHA", "abcd")), grey_alpha);
    EXPECT_EQ(of(pam(2, 255, "", "abcd")), grey_alpha);
    const std::vector<Rgba> rgb{{97, 98, 99, 255}, {100, 101, 102, 255}};
    EXPECT_EQ(of(pam(3, 255, "RGB", "abcdef")), rgb);
    EXPECT_EQ(of(pam(3, 255, "", "abcdef")), rgb);
    const std::vector<Rgba> rgba{{97, 98, 99, 100}, {101, 102, 103, 104}};
    EXPECT_EQ(of(pam(4, 255, "RGB_ALPHA", "abcdefgh")), rgba);
    EXPECT_EQ(of(pam(4, 255, "", "abcdefgh")), rgba);
    EXPECT_EQ(of(pam(5, 255, "RGB_ALPHA", "abcd!efgh!")), rgba) << "a sample more, which says nothing to us";
    EXPECT_EQ(of(pam(3, 127, "RGB", "abcdef"))[0], (Rgba{195, 197, 199, 255}));
    const Image deep = decode(bytes_of(pam(2, 65535, "GRAYSCALE_ALPHA", "\1\2\3\4\5\6\7\x08")));
    EXPECT_EQ(deep.bits(), 16);
    EXPECT_EQ(pixels(deep), (std::vector<Rgba>{{258, 258, 258, 772}, {1286, 1286, 1286, 1800}}));
}

TEST(Pnm, PamHeadersInAnyOrderWithComments) {
    EXPECT_EQ(of("P7\n# one\nMAXVAL 255\n\nDEPTH 1\n  HEIGHT 1\n# two\nWIDTH 1\nENDHDR\n#"),
              (std::vector<Rgba>{{35, 35, 35, 255}}));
}

TEST(Pnm, BadPamsAreRefused) {
    expect_refused(bytes_of(pam(4, 255, "CMYK", "abcdefgh")), "a.pam",
                   "has tuples of the type CMYK; expected");
    expect_refused(bytes_of(pam(2, 255, "RGB", "abcd")), "a.pam", "its depth does not go with its type");
    expect_refused(bytes_of(pam(0, 255, "", "abcd")), "a.pam", "its depth does not go with its type");
    expect_refused(bytes_of(pam(1, 0, "", "ab")), "a.pam", "its highest sample is not 1 to 65535");
    expect_refused(bytes_of("P7\nWIDTH 1\nENDHDR\n"), "a.pam", "is damaged");
    expect_refused(bytes_of("P7\nWIDTH 1\nCOLOUR 1\nENDHDR\n"), "a.pam", "the unknown field COLOUR");
    expect_refused(bytes_of("P7\n" + std::string(70, 'A') + "\n"), "a.pam",
                   "a word of its header is too long");
    expect_refused(bytes_of("P7\nWIDTH 9000\nHEIGHT 9000\nDEPTH 4\nMAXVAL 255\nENDHDR\nabc"), "a.pam",
                   "is truncated");
    expect_each_cut_refused(bytes_of(pam(4, 255, "RGB_ALPHA", "abcdefgh")), "a.pam");
}

// ---- PFM ----

File floats(const std::vector<float>& values, bool big_endian) {
    File file;
    for (const float v : values) {
        const auto bits = std::bit_cast<std::uint32_t>(v);
        file += big_endian ? be(4, bits) : le(4, bits);
    }
    return file;
}

TEST(Pnm, PfmOfBothByteOrders) {
    const std::vector<float> values{0.25f, 0.5f, 1, 0};
    const std::vector<Rgba> meaning{{65535, 65535, 65535, 65535},
                                    {0, 0, 0, 65535},
                                    {16384, 16384, 16384, 65535},
                                    {32768, 32768, 32768, 65535}};
    EXPECT_EQ(pixels(decode(join({bytes_of("Pf\n2 2\n-1.0\n"), floats(values, false)}))), meaning)
        << "rows from the bottom up";
    EXPECT_EQ(pixels(decode(join({bytes_of("Pf\n2 2\n+1\n"), floats(values, true)}))), meaning);
    EXPECT_EQ(pixels(decode(join({bytes_of("PF 1 1 1e0 "), floats({0.25f, 0.5f, 1}, true)}))),
              (std::vector<Rgba>{{16384, 32768, 65535, 65535}}));
    EXPECT_EQ(pixels(decode(join({bytes_of("PF 1 1 -0.5 "), floats({0.5f, 1, 2}, false)}))),
              (std::vector<Rgba>{{16384, 32768, 65535, 65535}}))
        << "times the scale";
}

TEST(Pnm, PfmValuesThatNoPictureHolds) {
    using Limits = std::numeric_limits<float>;
    const auto grey = [](float v) {
        return pixels(decode(join({bytes_of("Pf\n1 1\n1\n"), floats({v}, true)})))[0][0];
    };
    for (const float none : {-0.0f, -1.0f, -Limits::infinity(), Limits::quiet_NaN(), Limits::denorm_min()})
        EXPECT_EQ(grey(none), 0) << none;
    for (const float full : {1.5f, Limits::max(), Limits::infinity()}) EXPECT_EQ(grey(full), 65535) << full;
    for (const char* scale : {"0", "x", "1x", "nan", "inf", "1e999", "--1"})
        expect_refused(join({bytes_of("Pf\n1 1\n"), bytes_of(scale), bytes_of("\n"), File(4)}), "a.pfm",
                       "its scale is no number");
    expect_refused(bytes_of("PF\n9000 9000\n1\nabc"), "a.pfm", "is 9000 x 9000 pixels");
    expect_each_cut_refused(join({bytes_of("PF\n1 2\n-1.0\n"), File(24)}), "a.pfm");
}

// ---- files that end too soon ----

TEST(Pnm, WhatIsThereIsSalvaged) {
    const Rgba a{97, 97, 97, 255};
    EXPECT_EQ(pixels(salvaged(bytes_of("P5 2 2 255 aa"))), (std::vector<Rgba>{a, a, clear, clear}));
    EXPECT_EQ(pixels(salvaged(bytes_of("P6 1 2 255 aaabb"))), (std::vector<Rgba>{a, clear}));
    EXPECT_EQ(pixels(salvaged(bytes_of("P2 2 1 255 97 9"))), (std::vector<Rgba>{a, clear}));
    EXPECT_EQ(pixels(salvaged(bytes_of("P1 2 1 0"))), (std::vector<Rgba>{white, clear}));
    EXPECT_EQ(pixels(salvaged(bytes_of("P4 9 1 \xff"))).back(), clear);
    EXPECT_EQ(pixels(salvaged(bytes_of(pam(2, 255, "", "aa")))),
              (std::vector<Rgba>{{97, 97, 97, 97}, clear}));
    EXPECT_EQ(pixels(salvaged(join({bytes_of("Pf\n1 2\n1\n"), floats({1}, true)}))),
              (std::vector<Rgba>{clear, {65535, 65535, 65535, 65535}}));
    expect_nothing_to_salvage(bytes_of("P5 2 2 255 "));
    expect_nothing_to_salvage(bytes_of("P5 2 2 25"));
}

}  // namespace
}  // namespace probewarp
