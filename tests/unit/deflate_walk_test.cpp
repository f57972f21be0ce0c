// The walk over deflated streams: it finds the blocks that zlib finds, in streams of every kind of block and
// code.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <random>

#include "io/deflate_strip.h"
#include "io/deflate_walk.h"
#include "model/error.h"

namespace probewarp {
namespace {

using Stream = std::vector<std::byte>;

/// zlib's word on it: zlib.h on data_type says that inflate(Z_BLOCK) stops behind each block, with 64 set
/// behind the last one, and how many bits of the last byte read are not used yet.
DeflateBlock last_block_by_zlib(const Stream& stream, std::size_t raw_bytes) {
    z_stream z{};
    EXPECT_EQ(inflateInit2(&z, -MAX_WBITS), Z_OK);
    Stream raw(raw_bytes + 1);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(stream.data()));
    z.avail_in = uInt(stream.size());
    z.next_out = reinterpret_cast<Bytef*>(raw.data());
    z.avail_out = uInt(raw.size());
    DeflateBlock block;
    for (bool last = false; !last; last = (z.data_type & 64) != 0) {
        block.first = block.end;
        EXPECT_EQ(inflate(&z, Z_BLOCK), Z_OK);
        block.end = std::size_t(z.total_in) * 8 - std::size_t(z.data_type & 7);
        if (::testing::Test::HasFailure()) break;
    }
    inflateEnd(&z);
    return block;
}

Stream deflated_by_zlib(const Stream& raw, int level, int strategy) {
    z_stream z{};
    EXPECT_EQ(deflateInit2(&z, level, Z_DEFLATED, -MAX_WBITS, 9, strategy), Z_OK);
    Stream out(raw.size() * 2 + 1000);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(raw.data()));
    z.avail_in = uInt(raw.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = uInt(out.size());
    EXPECT_EQ(deflate(&z, Z_FINISH), Z_STREAM_END);
    out.resize(z.total_out);
    deflateEnd(&z);
    return out;
}

/// Bytes whose values are the rarer the larger they are: the steeper, the longer the rarest ones' codes.
Stream skewed(std::mt19937& random, std::size_t size, double steepness) {
    std::exponential_distribution<double> value(steepness);
    Stream raw(size);
    for (auto& byte : raw) byte = std::byte(int(std::min(255.0, value(random))));
    return raw;
}

void expect_the_block(const Stream& stream, std::size_t raw_bytes) {
    const DeflateBlock found = last_block(stream), expected = last_block_by_zlib(stream, raw_bytes);
    EXPECT_EQ(found.first, expected.first);
    EXPECT_EQ(found.end, expected.end);
}

TEST(DeflateWalk, FindsTheBlockThatZlibFinds) {
    std::mt19937 random(20240612);
    for (const std::size_t size : {1u, 2u, 30u, 1000u, 70'000u, 400'000u})
        for (const double steepness : {0.001, 0.02, 0.1, 1.0, 5.0}) {
            const Stream raw = skewed(random, size, steepness);
            for (const int level : {1, 2, 6, 12}) expect_the_block(deflate_whole(raw, level), size);
            for (const int level : {0, 1, 9})
                for (const int strategy : {Z_DEFAULT_STRATEGY, Z_HUFFMAN_ONLY, Z_RLE, Z_FIXED})
                    expect_the_block(deflated_by_zlib(raw, level, strategy), size);
            expect_the_block(deflate_quickly(raw, true), size);
        }
}

TEST(DeflateWalk, LongCodesAndLongMatches) {
    // Each value twice as often as the next: codes of every length up to 15; runs of every length up to 300.
    Stream raw;
    for (int value = 0; value < 18; ++value)
        raw.insert(raw.end(), std::size_t{1} << (18 - value), std::byte(value));
    std::mt19937 random(20240613);
    std::shuffle(raw.begin(), raw.end(), random);
    for (std::size_t run = 1; run < 300; ++run) raw.insert(raw.end(), run, std::byte(run % 256));
    for (const std::size_t far : {5u, 100u, 3000u, 20'000u, 32'000u})
        for (std::size_t i = 0; i < 40; ++i) raw.push_back(raw[raw.size() - far]);
    for (const int level : {1, 6, 12}) expect_the_block(deflate_whole(raw, level), raw.size());
    for (const int strategy : {Z_DEFAULT_STRATEGY, Z_HUFFMAN_ONLY})
        expect_the_block(deflated_by_zlib(raw, 9, strategy), raw.size());
}

TEST(DeflateWalk, AStoredBlockMayFollowAnyBit) {
    std::mt19937 random(20240616);
    for (int run = 0; run < 100; ++run) {
        const Stream raw = skewed(random, 50 + random() % 200, 0.05), more = skewed(random, 100, 0.05);
        Stream stream = deflate_whole(raw, 6);
        open_end(stream);  // by an empty stored block
        const Stream rest = deflate_whole(more, 6);
        stream.insert(stream.end(), rest.begin(), rest.end());
        expect_the_block(stream, raw.size() + more.size());
    }
}

TEST(DeflateWalk, AStreamCutShortIsRefused) {
    std::mt19937 random(20240614);
    const Stream raw = skewed(random, 5000, 0.05);
    for (const Stream& whole : {deflate_whole(raw, 6), deflated_by_zlib(raw, 0, Z_DEFAULT_STRATEGY)})
        for (std::size_t size = 0; size < whole.size(); size += 7)
            EXPECT_THROW(last_block(Bytes(whole).first(size)), Error) << size;
}

TEST(DeflateWalk, AnyBytesComeToAnEnd) {
    std::mt19937 random(20240615);
    const Stream sound = deflate_whole(skewed(random, 3000, 0.05), 6);
    int refused = 0;
    for (int run = 0; run < 5000; ++run) {
        Stream stream = sound;
        for (int i = 0; i < 3; ++i) stream[random() % stream.size()] = std::byte(random());
        if (run % 2 == 0)
            for (auto& byte : stream) byte = std::byte(random());
        try {
            EXPECT_LE(last_block(stream).end, stream.size() * 8);
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace probewarp
