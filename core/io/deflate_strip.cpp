// libdeflate packs best for its speed, but it only makes whole streams: the last block says that it is the
// last, and it ends at any bit. Joining such streams as zlib's own examples/gzjoin.c does takes a walk to the
// last block; zlib's would cost two thirds of the fastest deflating, ours, which unpacks nothing, a quarter.
#include "io/deflate_strip.h"

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>
#include <zlib.h>

#include <cassert>
#include <memory>
#include <new>

#include "io/deflate_walk.h"
#include "model/error.h"

namespace probewarp {

namespace {

using Compressor = std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)>;

}  // namespace

namespace {

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

void open_end(std::vector<std::byte>& deflated) {
    const DeflateBlock last = last_block(deflated);
    // RFC 1951, section 3.2.3: a block's first bit says whether it is the last.
    deflated[last.first / 8] &= ~(std::byte{1} << (last.first % 8));
    // Section 3.2.4: an empty stored block, which is three zero bits, zero bits up to the next byte, and the
    // length 0 with its complement.
    if (last.end % 8 != 0) deflated[last.end / 8] &= ~(std::byte{0xFF} << (last.end % 8));
    deflated.resize((last.end + 3 + 7) / 8);
    for (const unsigned byte : {0x00u, 0x00u, 0xFFu, 0xFFu}) deflated.push_back(std::byte(byte));
}

std::vector<std::byte> deflate_quickly(Bytes raw, bool whole) {
    // Level 2: 3 is no smaller but on photographs, by a hundredth, and much larger on drawings.
    const auto buffer = std::make_unique_for_overwrite<std::uint8_t[]>(ISAL_DEF_LVL2_DEFAULT);
    isal_zstream stream;
    isal_deflate_init(&stream);
    stream.level = 2;
    stream.level_buf = buffer.get();
    stream.level_buf_size = ISAL_DEF_LVL2_DEFAULT;
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
