#include "io/png_chunks.h"

#include <libdeflate.h>
#include <spng.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <string_view>

#include "io/colours.h"
#include "io/formats.h"
#include "io/upright.h"

namespace probewarp {

namespace {

constexpr std::size_t signature_bytes = 8;
constexpr std::size_t checksum_bytes = 4;  // of a chunk; nobody looks at those that are made up
constexpr unsigned indexed = 3;            // a colour type: IHDR, section 11.2.1

/// One chunk, as far as it is there.
struct Chunk {
    Bytes all;           ///< from its length to its checksum
    Bytes type, data;    ///< data: what is there of it
    bool whole = false;  ///< all of it is there

    bool is(std::string_view name) const {
        return std::ranges::equal(type, name, [](std::byte a, char b) { return a == std::byte(b); });
    }
    bool is_critical() const { return (u8(type, 0) & 0x20u) == 0; }

    bool is_sound() const {
        return whole && libdeflate_crc32(0, type.data(), 4 + data.size()) == be32(all, all.size() - 4);
    }
};

/// None where the file ends, or holds something else than chunks from here on.
std::optional<Chunk> chunk_at(Bytes file, std::size_t at) {
    const Bytes rest = file.subspan(at);
    if (rest.size() < 8) return {};
    const Bytes type = rest.subspan(4, 4);
    const auto is_letter = [](std::byte b) {
        const auto c = std::to_integer<unsigned>(b) | 0x20u;
        return c >= 'a' && c <= 'z';
    };
    const std::size_t length = be32(rest, 0);
    if (length > 0x7FFFFFFF || !std::ranges::all_of(type, is_letter)) return {};
    const Bytes data = rest.subspan(8, std::min(length, rest.size() - 8));
    const Bytes all = rest.first(std::min(length + 12, rest.size()));
    return Chunk{all, type, data, all.size() == length + 12};
}

// ---- what the file says of its colours and itself ----

void read_gama(Bytes data, Description& said) {
    // What lies beyond these makes no sense as a gamma.
    constexpr std::uint32_t least = 16, most = 625'000'000;
    if (said.gamma || data.size() != 4 || be32(data, 0) < least || be32(data, 0) > most) return;
    said.gamma = be32(data, 0);
}

void read_chrm(Bytes data, Description& said) {
    Chromaticities c{};
    if (said.chromaticities || data.size() != c.size() * 4) return;
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = be32(data, i * 4);
    for (std::size_t i = 0; i < c.size(); i += 2)
        if (c[i] > 100'000 || c[i + 1] > 100'000 - c[i]) return;  // x and y are shares of a whole
    if (c[1] == 0) return;                                        // no light at all is no white
    said.chromaticities = c;
}

void read_srgb(Bytes data, Description& said) {
    if (said.srgb_intent || data.size() != 1 || u8(data, 0) > 3) return;
    said.srgb_intent = std::uint8_t(u8(data, 0));
}

/// Matrix coefficients other than 0 are for colours that are not RGB, which a PNG does not hold.
void read_cicp(Bytes data, Description& said) {
    if (said.cicp || data.size() != 4 || u8(data, 2) != 0 || u8(data, 3) > 1) return;
    said.cicp.emplace();
    for (std::size_t i = 0; i < 4; ++i) (*said.cicp)[i] = std::uint8_t(u8(data, i));
}

/// Empty where the stream is not sound and whole, or longer than `most` once inflated.
std::vector<std::byte> inflated(Bytes stream, std::size_t most) {
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
        libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
    if (!decompressor) throw std::bad_alloc();
    std::vector<std::byte> out(most);
    std::size_t size = 0;
    if (libdeflate_zlib_decompress(decompressor.get(), stream.data(), stream.size(), out.data(), most,
                                   &size) != LIBDEFLATE_SUCCESS)
        return {};
    out.resize(size);
    return out;
}

/// data: of an iCCP chunk. Empty where it holds no profile that is of use.
std::vector<std::byte> profile_in(Bytes data) {
    constexpr std::size_t longest_name = 79;
    const auto name = data.first(std::min(data.size(), longest_name + 1));
    const auto name_end = std::ranges::find(name, std::byte{0});
    const auto length = std::size_t(name_end - name.begin());
    if (length == 0 || name_end == name.end()) return {};
    if (data.size() < length + 2 || u8(data, length + 1) != 0) return {};  // 0: deflated
    return rgb_profile(inflated(data.subspan(length + 2), max_icc_bytes));
}

void read_phys(Bytes data, Description& said) {
    if (said.resolution || said.aspect || data.size() != 9) return;
    const Resolution pixels{be32(data, 0), be32(data, 4)};
    if (!is_resolution(pixels.x, pixels.y)) return;
    if (u8(data, 8) == 1) said.resolution = pixels;  // per metre
    if (u8(data, 8) == 0) said.aspect = pixels;      // per a unit that nobody knows
}

struct DescribingChunk {
    std::string_view type;
    void (*read)(Bytes data, Description& said);
};

constexpr std::array<DescribingChunk, 5> describing_chunks{{{"gAMA", read_gama},
                                                            {"cHRM", read_chrm},
                                                            {"sRGB", read_srgb},
                                                            {"cICP", read_cicp},
                                                            {"pHYs", read_phys}}};

// ---- the walk ----

class Survey {
  public:
    explicit Survey(Bytes file) { add(file.first(std::min(file.size(), signature_bytes))); }

    /// False once there is nothing more to look at.
    bool take(const Chunk& chunk) {
        if (!header_) {
            take_header(chunk);
        } else if (chunk.is("IDAT")) {
            take_pixels(chunk);
        } else if (chunk.is("IEND")) {
            found_.has_end = chunk.whole;
            end_ = chunk;
            return false;
        } else if (chunk.is_critical()) {
            take_critical(chunk);
        } else {
            take_ancillary(chunk);
        }
        return chunk.whole;
    }

    PngFile finish() {
        if (!header_) throw truncated("PNG");
        if (!begun_) throw found_.has_end ? damaged("PNG", "it has no pixels") : truncated("PNG");
        if (end_ && end_->data.empty() && end_->whole)
            add(end_->all);
        else
            make_chunk("IEND", {});
        found_.description.icc = profile_in(profile_);
        describe_by_exif();
        return std::move(found_);
    }

  private:
    void take_header(const Chunk& chunk) {
        if (!chunk.is("IHDR") || (chunk.whole && chunk.data.size() != 13))
            throw damaged("PNG", "it does not start with IHDR");
        if (!chunk.whole) throw truncated("PNG");
        require_sound(chunk);
        // Before libspng sees it, which would only say that some limit is exceeded.
        check_image_size(be32(chunk.data, 0), be32(chunk.data, 4), u8(chunk.data, 8) == 16 ? 16 : 8);
        depth_ = u8(chunk.data, 8);
        if (depth_ > 16) throw damaged("PNG", spng_strerror(SPNG_EBIT_DEPTH));
        colour_type_ = u8(chunk.data, 9);
        header_ = true;
        add(chunk.all);
    }

    void take_critical(const Chunk& chunk) {
        if (!chunk.whole) return;
        require_sound(chunk);
        if (chunk.is("IHDR")) throw damaged("PNG", spng_strerror(SPNG_ECHUNK_POS));
        if (!chunk.is("PLTE")) throw damaged("PNG", spng_strerror(SPNG_ECHUNK_UNKNOWN_CRITICAL));
        // Elsewhere it is a suggestion to screens with few colours.
        if (colour_type_ != indexed || begun_) return;
        const std::size_t length = chunk.data.size();
        if (palette_) throw damaged("PNG", "it has two palettes");
        if (length == 0 || length > 768 || length % 3 != 0)
            throw damaged("PNG", "its palette has a wrong length");
        palette_ = chunk;
    }

    void take_ancillary(const Chunk& chunk) {
        if (chunk.is("eXIf")) {  // may stand anywhere
            if (exif_.empty() && chunk.is_sound()) exif_ = chunk.data;
            return;
        }
        if (begun_) return;
        // Unpacked once the whole file has been seen, so that many of them cost no more than one.
        if (chunk.is("iCCP") && profile_.empty() && chunk.is_sound()) profile_ = chunk.data;
        if (chunk.is("tRNS") && !transparency_ && chunk.is_sound()) transparency_ = chunk;
        for (const DescribingChunk& row : describing_chunks)
            if (chunk.is(row.type) && chunk.is_sound()) row.read(chunk.data, found_.description);
    }

    void take_pixels(const Chunk& chunk) {
        if (!begun_) begin_pixels();
        if (found_.end != PngEnd::whole) return;
        found_.idat_bytes += chunk.data.size();
        if (!chunk.whole) {
            found_.end = PngEnd::cut;
            add(keep(chunk_head("IDAT", chunk.data.size())));
            add(chunk.data);
            return add(keep(std::vector<std::byte>(checksum_bytes)));
        }
        if (!chunk.is_sound()) found_.end = PngEnd::damaged;
        add(chunk.all);
    }

    /// Of what comes before the pixels, what libspng needs, in the order that it wants.
    void begin_pixels() {
        begun_ = true;
        const std::size_t colours = std::size_t{1} << std::min(depth_, 8u);
        std::size_t entries = 0;
        if (colour_type_ == indexed) {
            if (!palette_) throw damaged("PNG", "it has no palette");
            // A longer one has colours that no pixel can name.
            entries = std::min(palette_->data.size() / 3, colours);
            add_chunk(*palette_, palette_->data.first(entries * 3));
        }
        if (!transparency_) return;
        const std::vector<std::byte> data = transparency(transparency_->data, entries);
        if (data.empty()) return;
        add_chunk(*transparency_, data);
        found_.transparent = true;
    }

    /// tRNS as libspng needs it, section 11.3.1.1: of a sample only the bits that it has, and no alpha of a
    /// colour that is not in the palette. Empty where it says nothing.
    std::vector<std::byte> transparency(Bytes data, std::size_t palette_entries) const {
        if (colour_type_ == indexed) {
            const Bytes used = data.first(std::min(data.size(), palette_entries));
            return {used.begin(), used.end()};
        }
        if (data.size() != (colour_type_ == 0 ? 2u : colour_type_ == 2 ? 6u : 0u)) return {};
        std::vector<std::byte> masked(data.begin(), data.end());
        const unsigned mask = (1u << depth_) - 1;
        for (std::size_t i = 0; i < masked.size(); i += 2) {
            masked[i] &= std::byte(mask >> 8);
            masked[i + 1] &= std::byte(mask & 0xFF);
        }
        return masked;
    }

    void describe_by_exif() {
        Exif exif = parse_exif(exif_);
        Description& said = found_.description;
        found_.orientation = exif.orientation;
        said.exif = std::move(exif.block);
        if (!said.resolution && !said.aspect) said.resolution = exif.resolution;
        if (!turned_on_its_side(exif.orientation)) return;
        if (said.resolution) std::swap(said.resolution->x, said.resolution->y);
        if (said.aspect) std::swap(said.aspect->x, said.aspect->y);
    }

    static void require_sound(const Chunk& chunk) {
        if (!chunk.is_sound()) throw damaged("PNG", spng_strerror(SPNG_ECHUNK_CRC));
    }

    void add(Bytes bytes) {
        if (bytes.empty()) return;
        std::vector<Bytes>& parts = found_.parts;
        if (!parts.empty() && parts.back().data() + parts.back().size() == bytes.data())
            parts.back() = Bytes(parts.back().data(), parts.back().size() + bytes.size());
        else
            parts.push_back(bytes);
    }

    /// The chunk with these data, which may be its own.
    void add_chunk(const Chunk& chunk, Bytes data) {
        if (std::ranges::equal(data, chunk.data))
            add(chunk.all);
        else
            make_chunk({reinterpret_cast<const char*>(chunk.type.data()), 4}, data);
    }

    Bytes keep(std::vector<std::byte> bytes) { return found_.made.emplace_back(std::move(bytes)); }
    static std::vector<std::byte> chunk_head(std::string_view type, std::size_t length) {
        std::vector<std::byte> head;
        put_be32(head, length);
        for (const char c : type) head.push_back(std::byte(c));
        return head;
    }

    void make_chunk(std::string_view type, Bytes data) {
        std::vector<std::byte> chunk = chunk_head(type, data.size());
        chunk.insert(chunk.end(), data.begin(), data.end());
        chunk.resize(chunk.size() + checksum_bytes);
        add(keep(std::move(chunk)));
    }

    PngFile found_;
    unsigned depth_ = 0, colour_type_ = 0;  ///< IHDR's
    bool header_ = false, begun_ = false;   ///< IHDR is there; the pixels have begun
    std::optional<Chunk> palette_, transparency_, end_;
    Bytes exif_, profile_;  ///< the data of the first eXIf and iCCP
};

}  // namespace

PngFile survey_png(Bytes file) {
    Survey survey(file);
    for (std::size_t at = std::min(file.size(), signature_bytes);;) {
        const std::optional<Chunk> chunk = chunk_at(file, at);
        if (!chunk || !survey.take(*chunk)) return survey.finish();
        at += chunk->all.size();
    }
}

}  // namespace probewarp
