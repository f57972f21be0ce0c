// GIF's variable-length LZW. Private to io; our own, because stb_image spends time on every string that a
// stream names, also on those beyond the frame: a megabyte of those takes it minutes. Here the work is bound
// by the frame's pixels.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace probewarp {

/// A picture needs no more than 8, but some writers take more, and other readers follow them.
inline constexpr int max_literal_bits = 11;

/// Decodes into `out` until it is full, the stream's end code comes, or the bytes end. `next_byte()` gives a
/// byte or -1; `literal_bits`: 1 to max_literal_bits. Of a value, the lower eight bits are kept. Returns how
/// many of `out` were written, or -1 minus that number where the code after them makes no sense.
template <class NextByte>
std::ptrdiff_t decode_lzw(NextByte next_byte, int literal_bits, std::span<std::uint8_t> out) {
    constexpr int table_size = 4096;
    std::array<std::uint16_t, table_size> prefix{}, length{};
    std::array<std::uint8_t, table_size> first{}, last{};
    const int clear = 1 << literal_bits, end = clear + 1;
    for (int i = 0; i < clear; ++i) {
        first[std::size_t(i)] = last[std::size_t(i)] = std::uint8_t(i);
        length[std::size_t(i)] = 1;
    }

    int width = literal_bits + 1, next = clear + 2, previous = -1;
    std::uint32_t bits = 0;
    int bit_count = 0;
    std::size_t done = 0;
    while (done < out.size()) {
        while (bit_count < width) {
            const int byte = next_byte();
            if (byte < 0) return std::ptrdiff_t(std::min(done, out.size()));
            bits |= std::uint32_t(byte) << bit_count;
            bit_count += 8;
        }
        const int code = int(bits & ((1u << width) - 1));
        bits >>= width;
        bit_count -= width;

        if (code == end) break;
        if (code == clear) {
            width = literal_bits + 1, next = clear + 2, previous = -1;
            continue;
        }
        // A code one ahead of the table stands for the previous string and its own first value.
        if (code > next || (code == next && previous < 0)) return -1 - std::ptrdiff_t(done);
        if (previous >= 0 && next < table_size) {
            const std::size_t n = std::size_t(next), p = std::size_t(previous);
            prefix[n] = std::uint16_t(previous);
            first[n] = first[p];
            length[n] = std::uint16_t(length[p] + 1);
            last[n] = first[std::size_t(code)];
            if (++next == 1 << width && width < 12) ++width;
        }
        std::size_t c = std::size_t(code);
        const std::size_t size = length[c];
        for (std::size_t at = done + size; at-- > done; c = prefix[c])
            if (at < out.size()) out[at] = last[c];
        done += size;
        previous = code;
    }
    return std::ptrdiff_t(std::min(done, out.size()));
}

}  // namespace probewarp
