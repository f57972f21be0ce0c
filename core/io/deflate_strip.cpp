// ISA-L is the quickest there is, and ends a strip on a byte where it is asked to. libdeflate packs best for
// its speed, but it only makes whole streams: the last block says that it is the last, and it ends at any
// bit. inflate(Z_BLOCK) of zlib tells where blocks begin and end, as it does for joining streams in zlib's
// own examples/gzjoin.c.
#include "io/deflate_strip.h"

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>
#include <zlib.h>

#include <cassert>
#include <memory>
#include <new>

#include "model/error.h"

namespace probewarp {

namespace {

using Compressor = std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)>;

struct Inflater {
    z_stream stream{};

    Inflater() {
        if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();  // negative: no zlib header
    }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    ~Inflater() { inflateEnd(&stream); }
};

struct LastBlock {
    std::size_t first = 0, end = 0;  ///< bits from the stream's begin; in a byte from the lowest on
};

LastBlock last_block(std::span<std::byte> deflated, std::size_t raw_bytes) {
    Inflater inflater;
    z_stream& stream = inflater.stream;
    // One byte to spare: the code that ends a block is looked for only where there is room for another byte.
    const auto raw = std::make_unique_for_overwrite<Bytef[]>(raw_bytes + 1);
    stream.next_in = reinterpret_cast<Bytef*>(deflated.data());
    stream.avail_in = uInt(deflated.size());
    stream.next_out = raw.get();
    stream.avail_out = uInt(raw_bytes + 1);
    LastBlock block;
    for (;;) {
        // zlib.h on data_type: 128 behind a block, 64 where it was the last one, and below them the bits of
        // the last byte read that are not used yet.
        const int result = inflate(&stream, Z_BLOCK);
        if (result != Z_OK || (stream.data_type & 128) == 0)
            throw Error("cannot be written as PNG: libdeflate's stream cannot be read back");
        block.end = std::size_t(stream.total_in) * 8 - std::size_t(stream.data_type & 7);
        if ((stream.data_type & 64) != 0) return block;
        block.first = block.end;
    }
}

/// Room for deflating: this thread's, until it asks again. To get some each time would be to have it cleared
/// each time.
std::span<std::byte> room(std::size_t bytes) {
    thread_local std::vector<std::byte> kept;
    if (kept.size() < bytes) kept.resize(bytes);
    return std::span(kept).first(bytes);
}

std::vector<std::byte> copy(std::span<const std::byte> bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

std::vector<std::byte> deflate_whole(Bytes raw, int level) {
    const Compressor compressor(libdeflate_alloc_compressor(level), &libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    const auto out = room(libdeflate_deflate_compress_bound(compressor.get(), raw.size()));
    const std::size_t size =
        libdeflate_deflate_compress(compressor.get(), raw.data(), raw.size(), out.data(), out.size());
    assert(size > 0);
    return copy(out.first(size));
}

void open_end(std::vector<std::byte>& deflated, std::size_t raw_bytes) {
    const LastBlock last = last_block(deflated, raw_bytes);
    // RFC 1951, section 3.2.3: a block's first bit says whether it is the last.
    deflated[last.first / 8] &= ~(std::byte{1} << (last.first % 8));
    // Section 3.2.4: an empty stored block, which is three zero bits, zero bits up to the next byte, and the
    // length 0 with its complement.
    if (last.end % 8 != 0) deflated[last.end / 8] &= ~(std::byte{0xFF} << (last.end % 8));
    deflated.resize((last.end + 3 + 7) / 8);
    for (const unsigned byte : {0x00u, 0x00u, 0xFFu, 0xFFu}) deflated.push_back(std::byte(byte));
}

std::vector<std::byte> deflate_quickly(Bytes raw, bool whole, int level) {
    assert(level >= 1 && level <= 3);
    constexpr std::uint32_t sizes[] = {0, ISAL_DEF_LVL1_DEFAULT, ISAL_DEF_LVL2_DEFAULT,
                                       ISAL_DEF_LVL3_DEFAULT};
    const auto buffer = std::make_unique_for_overwrite<std::uint8_t[]>(sizes[level]);
    isal_zstream stream;
    isal_deflate_init(&stream);
    stream.level = std::uint32_t(level);
    stream.level_buf = buffer.get();
    stream.level_buf_size = sizes[level];
    // The empty block of a flush ends on a byte.
    stream.flush = whole ? NO_FLUSH : SYNC_FLUSH;
    stream.end_of_stream = whole ? 1 : 0;
    stream.next_in = const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(raw.data()));
    stream.avail_in = std::uint32_t(raw.size());
    const auto out = room(raw.size() + raw.size() / 16 + 512);
    stream.next_out = reinterpret_cast<std::uint8_t*>(out.data());
    stream.avail_out = std::uint32_t(out.size());
    if (isal_deflate(&stream) != COMP_OK || stream.avail_in > 0 || stream.avail_out == 0)
        throw Error("cannot be written as PNG: ISA-L cannot deflate it");
    return copy(out.first(stream.total_out));
}

std::vector<std::byte> deflate_by_zlib(Bytes raw, bool whole) {
    constexpr int level = 9, memory = 9;
    z_stream stream{};
    if (deflateInit2(&stream, level, Z_DEFLATED, -MAX_WBITS, memory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::bad_alloc();
    const auto out = room(deflateBound(&stream, uLong(raw.size())) + 16);  // 16: for the flush
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(raw.data()));
    stream.avail_in = uInt(raw.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = uInt(out.size());
    const int result = deflate(&stream, whole ? Z_FINISH : Z_SYNC_FLUSH);
    const bool good = result == (whole ? Z_STREAM_END : Z_OK) && stream.avail_in == 0 && stream.avail_out > 0;
    deflateEnd(&stream);
    if (!good) throw Error("cannot be written as PNG: zlib cannot deflate it");
    return copy(out.first(stream.total_out));
}

}  // namespace probewarp
