#include "io/deflate_walk.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "model/error.h"

namespace probewarp {

namespace {

using std::size_t, std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t;

[[noreturn]] void unsound() {
    throw Error("cannot be written as PNG: the deflated stream cannot be read back");
}

/// Section 3.1.1: the stream's bits, the lowest of each byte first.
class Bits {
  public:
    explicit Bits(Bytes stream) : stream_(stream) {}

    /// At least the 56 next bits, the first of them lowest; behind the end zeros.
    uint64_t peek() const {
        const size_t byte = at / 8;
        uint64_t next = 0;
        if (byte + 8 <= stream_.size() && std::endian::native == std::endian::little)
            std::memcpy(&next, stream_.data() + byte, 8);
        else
            for (size_t i = 0; i < 8 && byte + i < stream_.size(); ++i)
                next |= uint64_t(std::to_integer<uint8_t>(stream_[byte + i])) << (8 * i);
        return next >> (at % 8);
    }
    uint32_t take(int count) {
        const auto bits = uint32_t(peek() & ((uint64_t{1} << count) - 1));
        at += size_t(count);
        return bits;
    }
    void check() const {
        if (at > stream_.size() * 8) unsound();
    }

    size_t at = 0;  ///< the next bit

  private:
    Bytes stream_;
};

/// What a symbol is to a walk.
enum class Kind : uint8_t { literal, end_of_block, match, too_long };

struct Entry {
    uint8_t bits = 0;  ///< of the code and what belongs to it, or of two codes of literals
    Kind kind = Kind::too_long;
};

constexpr int most_code_bits = 15;  // section 3.2.7

/// A Huffman code, given by the lengths of its symbols' codes (section 3.2.2).
class Code {
  public:
    static constexpr int table_bits = 11;

    /// lengths: #symbols, 0 for those without a code; entry_of: what a symbol is, with its extra bits alone
    template <class EntryOf>
    Code(std::span<const uint8_t> lengths, const EntryOf& entry_of) {
        for (const uint8_t length : lengths) ++counts_[length];
        counts_[0] = 0;
        std::array<uint32_t, most_code_bits + 2> next{}, place{};
        for (size_t length = 1; length <= most_code_bits; ++length) {
            next[length + 1] = (next[length] + counts_[length]) << 1;
            place[length + 1] = place[length] + counts_[length];
        }
        symbols_.resize(place[most_code_bits + 1]);
        for (size_t symbol = 0; symbol < lengths.size(); ++symbol) {
            const size_t length = lengths[symbol];
            if (length == 0) continue;
            Entry entry = entry_of(symbol);
            entry.bits = uint8_t(entry.bits + length);
            symbols_[place[length]++] = entry;
            const uint32_t code = next[length]++;
            if (length <= table_bits) put(code, int(length), entry);
        }
    }

    /// The next symbol, or two literals, which are passed.
    Kind pass(Bits& bits) const {
        const Entry entry = table_[bits.peek() & (table_.size() - 1)];
        if (entry.kind == Kind::too_long) return pass_long(bits);
        bits.at += entry.bits;
        return entry.kind;
    }

    /// Passes literals until the next symbol is another, or has a long code.
    void pass_literals(Bits& bits) const {
        for (;;) {
            uint64_t next = bits.peek();
            for (int i = 0; i < 5; ++i) {  // 5 times 11 bits are there
                const Entry entry = table_[next & (table_.size() - 1)];
                if (entry.kind != Kind::literal) return;
                bits.at += entry.bits;
                next >>= entry.bits;
            }
            bits.check();
        }
    }

    /// Has each entry of a literal pass a second one, where there are bits enough to see it.
    void pair_literals() {
        const auto singles = table_;
        for (size_t i = 0; i < table_.size(); ++i) {
            const Entry first = singles[i], second = singles[i >> first.bits];
            if (first.kind == Kind::literal && second.kind == Kind::literal &&
                first.bits + second.bits <= table_bits)
                table_[i].bits = uint8_t(first.bits + second.bits);
        }
    }

  private:
    /// code: its first bit the highest
    void put(uint32_t code, int length, Entry entry) {
        uint32_t reversed = 0;
        for (int i = 0; i < length; ++i) reversed |= (code >> i & 1u) << (length - 1 - i);
        for (size_t i = reversed; i < table_.size(); i += size_t{1} << length) table_[i] = entry;
    }

    /// Bit by bit: codes of one length follow each other, and begin at twice what follows the shorter ones.
    Kind pass_long(Bits& bits) const {
        const uint64_t next = bits.peek();
        uint32_t code = 0, first = 0, place = 0;
        for (size_t length = 1; length <= most_code_bits; ++length) {
            code |= uint32_t(next >> (length - 1) & 1u);
            if (code - first < counts_[length]) {  // below `first` it is huge
                const Entry entry = symbols_[place + code - first];
                bits.at += entry.bits;
                return entry.kind;
            }
            place += counts_[length];
            first = (first + counts_[length]) << 1;
            code <<= 1;
        }
        unsound();
    }

    std::array<Entry, size_t{1} << table_bits> table_{};
    std::array<uint32_t, most_code_bits + 1> counts_{};  ///< symbols, by length
    std::vector<Entry> symbols_;                         ///< by code
};

/// Sections 3.2.5 and 3.2.6: 257 to 284 are lengths with extra bits, of which there is one more every four.
Entry literal_or_length(size_t symbol) {
    if (symbol < 256) return {0, Kind::literal};
    if (symbol == 256) return {0, Kind::end_of_block};
    const bool extra = symbol >= 265 && symbol < 285;
    return {uint8_t(extra ? (symbol - 261) / 4 : 0), Kind::match};
}

Entry distance(size_t symbol) { return {uint8_t(symbol < 4 ? 0 : symbol / 2 - 1), Kind::match}; }

void walk_codes(Bits& bits, std::span<const uint8_t> literal_lengths,
                std::span<const uint8_t> distance_lengths) {
    Code literals(literal_lengths, literal_or_length);
    literals.pair_literals();
    const Code distances(distance_lengths, distance);
    for (;;) {
        literals.pass_literals(bits);
        const Kind kind = literals.pass(bits);
        if (kind == Kind::end_of_block) return bits.check();
        if (kind == Kind::match) distances.pass(bits);
        bits.check();
    }
}

/// Section 3.2.6
void walk_fixed_codes(Bits& bits) {
    std::array<uint8_t, 288> lengths{};
    for (size_t i = 0; i < lengths.size(); ++i) lengths[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
    const std::array<uint8_t, 30> distances = [] {
        std::array<uint8_t, 30> all{};
        all.fill(5);
        return all;
    }();
    walk_codes(bits, lengths, distances);
}

/// The value of a symbol of the code lengths' code, bit by bit: there are few.
size_t length_symbol(Bits& bits, std::span<const uint8_t> lengths) {
    uint32_t code = 0, first = 0;
    for (uint8_t length = 1; length <= 7; ++length) {
        code = code << 1 | bits.take(1);
        for (size_t symbol = 0; symbol < lengths.size(); ++symbol)
            if (lengths[symbol] == length && first++ == code) return symbol;
        first <<= 1;
    }
    unsound();
}

/// Section 3.2.7
void walk_dynamic_codes(Bits& bits) {
    constexpr std::array<uint8_t, 19> order{16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    const size_t literals = bits.take(5) + 257, distances = bits.take(5) + 1, given = bits.take(4) + 4;
    std::array<uint8_t, 19> own{};
    for (size_t i = 0; i < given; ++i) own[order[i]] = uint8_t(bits.take(3));
    std::vector<uint8_t> lengths;
    while (lengths.size() < literals + distances) {
        const size_t symbol = length_symbol(bits, own);
        bits.check();
        if (symbol < 16) {
            lengths.push_back(uint8_t(symbol));
            continue;
        }
        if (symbol == 16 && lengths.empty()) unsound();
        const uint8_t repeated = symbol == 16 ? lengths.back() : uint8_t{0};
        const size_t times = symbol == 16   ? 3 + bits.take(2)
                             : symbol == 17 ? 3 + bits.take(3)
                                            : 11 + bits.take(7);
        lengths.insert(lengths.end(), times, repeated);
    }
    if (lengths.size() > literals + distances) unsound();
    walk_codes(bits, std::span(lengths).first(literals), std::span(lengths).subspan(literals));
}

/// Section 3.2.4
void walk_stored(Bits& bits) {
    bits.at = (bits.at + 7) / 8 * 8;
    const size_t length = bits.take(16);
    bits.at += 16 + 8 * length;
}

}  // namespace

DeflateBlock last_block(Bytes stream) {
    Bits bits(stream);
    for (;;) {
        DeflateBlock block{bits.at, 0};
        const bool last = bits.take(1) == 1;
        switch (bits.take(2)) {
            case 0:
                walk_stored(bits);
                break;
            case 1:
                walk_fixed_codes(bits);
                break;
            case 2:
                walk_dynamic_codes(bits);
                break;
            default:
                unsound();
        }
        bits.check();
        block.end = bits.at;
        if (last) return block;
    }
}

}  // namespace probewarp
