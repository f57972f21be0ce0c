// The rows of a Photoshop file's merged picture, which lie channel after channel: as they are, packed by
// PackBits, or deflated. All channels are read side by side, so that no more than a row of each is in memory.
#include <zlib.h>

#include <algorithm>
#include <new>

#include "io/formats.h"
#include "io/psd_parts.h"

namespace probewarp {

namespace {

// ---- as they are ----

class RawChannel final : public PsdChannel {
  public:
    RawChannel(Bytes rows, std::string label) : rows_(rows), label_(std::move(label)) {}

    void read(std::span<std::byte> row) override {
        if (rows_.size() < row.size()) throw incomplete(label_);
        std::copy_n(rows_.begin(), row.size(), row.begin());
        rows_ = rows_.subspan(row.size());
    }
    std::unique_ptr<PsdChannel> copy() const override { return std::make_unique<RawChannel>(*this); }

  private:
    Bytes rows_;
    std::string label_;
};

// ---- packed ----

/// 0 to 127: that many bytes and one more follow; 129 to 255: the next byte 257 minus that many times; 128
/// means nothing.
void unpack_bits(Bytes from, std::span<std::byte> to, const std::string& label) {
    const auto bad = [&](std::string_view what) { return IncompleteFile(damaged(label, what).what()); };
    while (!to.empty()) {
        if (from.size() < 2) throw bad("a row is too short");
        const std::size_t code = u8(from, 0);
        if (code == 128) {
            from = from.subspan(1);
            continue;
        }
        const std::size_t count = code < 128 ? code + 1 : 257 - code, stored = code < 128 ? count : 1;
        if (count > to.size() || stored > from.size() - 1) throw bad("a row has the wrong length");
        for (std::size_t i = 0; i < count; ++i) to[i] = from[stored == 1 ? 1 : 1 + i];
        from = from.subspan(1 + stored);
        to = to.subspan(count);
    }
}

/// The lengths of packed rows, big-endian; in a PSB they have four bytes.
struct RowLengths {
    Bytes bytes;
    bool large;

    std::size_t operator[](std::size_t row) const {
        return large ? be32(bytes, row * 4) : be16(bytes, row * 2);
    }
    std::uint64_t sum(std::size_t first, std::size_t count) const {
        std::uint64_t all = 0;
        for (std::size_t row = first; row < first + count; ++row) all += (*this)[row];
        return all;
    }
};

class PackedChannel final : public PsdChannel {
  public:
    /// first: its first row's place among the lengths
    PackedChannel(RowLengths lengths, std::size_t first, Bytes rows, std::string label)
        : lengths_(lengths), row_(first), rows_(rows), label_(std::move(label)) {}

    void read(std::span<std::byte> row) override {
        const std::size_t stored = lengths_[row_++];
        if (stored > rows_.size()) {
            rows_ = {};
            throw incomplete(label_);
        }
        const Bytes packed = rows_.first(stored);
        rows_ = rows_.subspan(stored);
        unpack_bits(packed, row, label_);
    }
    std::unique_ptr<PsdChannel> copy() const override { return std::make_unique<PackedChannel>(*this); }

  private:
    RowLengths lengths_;
    std::size_t row_;
    Bytes rows_;
    std::string label_;
};

// ---- deflated ----

/// A zlib stream, inflated in portions.
class Inflater {
  public:
    explicit Inflater(Bytes bytes) {
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
        stream_.avail_in = uInt(bytes.size());
        if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
    }
    /// A copy goes on from the same place of the stream.
    Inflater(const Inflater& original) {
        if (inflateCopy(&stream_, const_cast<z_stream*>(&original.stream_)) != Z_OK) throw std::bad_alloc();
    }
    Inflater& operator=(const Inflater&) = delete;
    ~Inflater() { inflateEnd(&stream_); }

    enum class Result { filled, ended, truncated, bad };
    /// Fills `to`. What cannot do so now never will.
    Result read(std::span<std::byte> to) {
        stream_.next_out = reinterpret_cast<Bytef*>(to.data());
        stream_.avail_out = uInt(to.size());
        while (stream_.avail_out > 0) {
            const int result = inflate(&stream_, Z_NO_FLUSH);
            if (result == Z_MEM_ERROR) throw std::bad_alloc();
            if (result == Z_BUF_ERROR) return Result::truncated;
            if (result == Z_STREAM_END) return stream_.avail_out > 0 ? Result::ended : Result::filled;
            if (result != Z_OK) return Result::bad;
        }
        return Result::filled;
    }

  private:
    z_stream stream_{};
};

IncompleteFile fault_of(Inflater::Result result, const std::string& label) {
    if (result == Inflater::Result::truncated) return incomplete(label);
    return IncompleteFile(damaged(label, result == Inflater::Result::ended ? "pixels are missing"
                                                                           : "its ZIP data make no sense")
                              .what());
}

/// Each sample is stored as its difference from the one before it.
void add_up(std::span<std::byte> row, int bits) {
    if (bits != 16) {
        for (std::size_t i = 1; i < row.size(); ++i) row[i] = std::byte(u8(row, i) + u8(row, i - 1));
        return;
    }
    for (std::size_t i = 2; i < row.size(); i += 2) {
        const std::uint32_t sample = be16(row, i) + be16(row, i - 2);
        row[i] = std::byte(sample >> 8);
        row[i + 1] = std::byte(sample);
    }
}

class DeflatedChannel final : public PsdChannel {
  public:
    DeflatedChannel(const Inflater& from, bool predicted, int bits, std::string label)
        : inflater_(from), predicted_(predicted), bits_(bits), label_(std::move(label)) {}

    void read(std::span<std::byte> row) override {
        const Inflater::Result result = inflater_.read(row);
        if (result != Inflater::Result::filled) throw fault_of(result, label_);
        if (predicted_) add_up(row, bits_);
        if (predicted_ && bits_ == 32) join_bytes(row);
    }
    std::unique_ptr<PsdChannel> copy() const override { return std::make_unique<DeflatedChannel>(*this); }

  private:
    /// Predicted rows of four-byte samples hold all first bytes, then all second ones, and so on.
    void join_bytes(std::span<std::byte> row) {
        apart_.assign(row.begin(), row.end());
        const std::size_t width = row.size() / 4;
        for (std::size_t i = 0; i < row.size(); ++i) row[i] = apart_[i % 4 * width + i / 4];
    }

    Inflater inflater_;
    bool predicted_;
    int bits_;
    std::string label_;
    std::vector<std::byte> apart_;  ///< row_bytes() long
};

// ---- all channels ----

enum Packing { raw = 0, packed = 1, deflated = 2, deflated_differences = 3 };

/// What has lost even the first row cannot be salvaged.
std::optional<IncompleteFile> fault_of(const Psd& psd, std::uint64_t there, std::uint64_t needed,
                                       std::uint64_t first_row) {
    if (there < first_row) throw truncated(psd.label());
    if (there < needed) return incomplete(psd.label());
    return {};
}

/// The channels that make the picture, in the order in which they are used.
std::vector<std::size_t> wanted_channels(const Psd& psd) {
    std::vector<std::size_t> wanted(psd.colours);
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = i;
    if (psd.alpha) wanted.push_back(*psd.alpha);
    return wanted;
}

Bytes from(Bytes bytes, std::uint64_t at) {
    return bytes.subspan(std::size_t(std::min<std::uint64_t>(at, bytes.size())));
}

PsdChannels raw_channels(const Psd& psd) {
    const std::uint64_t plane = std::uint64_t(psd.height) * psd.row_bytes();
    PsdChannels channels;
    channels.fault = fault_of(psd, psd.rows.size(), plane * psd.channels, psd.row_bytes());
    for (const std::size_t c : wanted_channels(psd))
        channels.list.push_back(std::make_unique<RawChannel>(from(psd.rows, c * plane), psd.label()));
    return channels;
}

PsdChannels packed_channels(const Psd& psd) {
    const std::size_t rows = psd.channels * psd.height, table = rows * (psd.large ? 4 : 2);
    if (psd.rows.size() < table) throw truncated(psd.label());
    const RowLengths lengths{psd.rows.first(table), psd.large};
    const Bytes data = psd.rows.subspan(table);
    PsdChannels channels;
    channels.fault = fault_of(psd, data.size(), lengths.sum(0, rows), lengths[0]);
    for (const std::size_t c : wanted_channels(psd)) {
        const std::size_t first = c * psd.height;
        channels.list.push_back(
            std::make_unique<PackedChannel>(lengths, first, from(data, lengths.sum(0, first)), psd.label()));
    }
    return channels;
}

/// Those before the last channel of the picture that are no part of it are inflated all the same.
void check_channels_between(const Psd& psd, const std::vector<std::size_t>& wanted) {
    const std::size_t between = wanted.back() + 1 - wanted.size();
    if (std::uint64_t(psd.height) * psd.row_bytes() * between > max_psd_bytes_between)
        throw Error("has its transparency behind " + std::to_string(between) +
                    " large channels that are deflated and no part of the picture; expected a " +
                    psd.label() + " that has it right behind the colours");
}

/// Inflates all of it once, to see that it is there and where the channels begin. Channels behind the last
/// one of the picture are left alone: a small file may hold many that are large.
PsdChannels deflated_channels(const Psd& psd) {
    const bool predicted = psd.compression == deflated_differences;
    if (predicted && psd.bits == 1) throw damaged(psd.label(), "it has differences of single bits");
    const std::vector<std::size_t> wanted = wanted_channels(psd);
    check_channels_between(psd, wanted);
    Inflater inflater(psd.rows);
    std::vector<std::byte> row(psd.row_bytes());
    PsdChannels channels;
    for (std::size_t c = 0; c <= wanted.back(); ++c) {
        if (std::find(wanted.begin(), wanted.end(), c) != wanted.end())
            channels.list.push_back(
                std::make_unique<DeflatedChannel>(inflater, predicted, psd.bits, psd.label()));
        for (std::size_t y = 0; y < psd.height && !channels.fault; ++y) {
            const Inflater::Result result = inflater.read(row);
            if (result != Inflater::Result::filled) channels.fault = fault_of(result, psd.label());
            if (channels.fault && c == 0 && y == 0) throw Error(channels.fault->what());
        }
    }
    if (channels.fault || wanted.back() + 1 < psd.channels) return channels;
    // Behind the last row stands a checksum.
    const Inflater::Result end = inflater.read(std::span(row).first(1));
    if (end == Inflater::Result::truncated || end == Inflater::Result::bad)
        channels.fault = fault_of(end, psd.label());
    return channels;
}

}  // namespace

PsdChannels psd_channels(const Psd& psd) {
    switch (psd.compression) {
        case raw:
            return raw_channels(psd);
        case packed:
            return packed_channels(psd);
        case deflated:
        case deflated_differences:
            return deflated_channels(psd);
        default:
            throw Error("is packed in an unknown way (" + std::to_string(psd.compression) + "); expected a " +
                        psd.label() + " whose merged picture is raw, RLE or ZIP");
    }
}

}  // namespace probewarp
