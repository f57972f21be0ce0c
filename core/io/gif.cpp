// GIF's first frame, by hand: stb_image spends minutes on a stream that names strings beyond the frame
// (lzw.h). What follows that frame is not looked at.
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "io/colours.h"
#include "io/formats.h"
#include "io/lzw.h"

namespace probewarp {

namespace {

/// The data of a block, in sub-blocks of up to 255 bytes of which the last is empty.
class SubBlocks {
  public:
    /// at: the first sub-block's length
    SubBlocks(Bytes file, std::size_t at) : file_(file), at_(at) {}

    /// -1 at the end.
    int next() {
        if (left_ == 0 && !ended_) {
            left_ = at_ < file_.size() ? u8(file_, at_++) : 0;
            ended_ = left_ == 0;
        }
        if (ended_ || at_ >= file_.size()) return -1;
        --left_;
        return int(u8(file_, at_++));
    }

    bool at_end_of_file() const { return at_ >= file_.size(); }

    /// What follows the last sub-block.
    std::size_t skip() {
        while (!ended_ && !at_end_of_file()) {
            at_ += left_;
            left_ = at_end_of_file() ? 0 : u8(file_, at_++);
            ended_ = left_ == 0;
        }
        return at_;
    }

  private:
    Bytes file_;
    std::size_t at_, left_ = 0;
    bool ended_ = false;
};

std::size_t palette_bytes(std::uint32_t flags) { return flags & 0x80 ? std::size_t{6} << (flags & 7) : 0; }

/// The first frame, and what the extensions before it say.
struct Frame {
    std::size_t at = 0;  // its image descriptor in the file
    int transparent = -1;
    std::size_t profile_at = 0;  // the sub-blocks of the first profile in the file; 0: there is none
};

std::vector<std::byte> read_profile(Bytes file, std::size_t at) {
    if (at == 0) return {};
    std::vector<std::byte> profile;
    SubBlocks blocks(file, at);
    for (int byte = blocks.next(); byte >= 0 && profile.size() <= max_icc_bytes; byte = blocks.next())
        profile.push_back(std::byte(byte));
    return rgb_profile(profile);
}

/// `extension`: the bytes from the block's mark on.
void read_extension(Bytes file, std::size_t at, Frame& frame) {
    const Bytes extension = file.subspan(at);
    // A graphic control extension: size 4, flags, delay, transparent colour.
    if (extension.size() > 7 && begins_with(extension.subspan(1), "\xF9\4"))
        frame.transparent = u8(extension, 3) & 1 ? int(u8(extension, 6)) : -1;
    // Read once the frame is found, so that many of them cost no more than one.
    if (frame.profile_at == 0 && extension.size() > 14 &&
        begins_with(extension.subspan(1), "\xFF\x0BICCRGBG1012"))
        frame.profile_at = at + 14;
}

/// Walks the blocks up to the first frame. Bytes between blocks that begin none are passed over, as all
/// other readers do.
Frame find_frame(Bytes file) {
    if (file.size() < 13) throw truncated("GIF");
    Frame frame;
    for (std::size_t at = 13 + palette_bytes(u8(file, 10));;) {
        if (at >= file.size()) throw truncated("GIF");
        const std::uint32_t mark = u8(file, at);
        if (mark == 0x3B) throw damaged("GIF", "there is no picture in it");
        if (mark == 0x21) {
            read_extension(file, at, frame);
            at = SubBlocks(file, at + 2).skip();
        } else if (mark == 0x2C) {
            // The descriptor, the frame's palette, and the length of the codes.
            if (file.size() - at < 10 || file.size() - at < 11 + palette_bytes(u8(file, at + 9)))
                throw truncated("GIF");
            frame.at = at;
            return frame;
        } else {
            ++at;
        }
    }
}

struct Indices {
    std::vector<std::uint8_t> values;  // in the order in which they are stored
    std::size_t count = 0;             // how many of them are there
};

/// `at`: the length of the LZW stream's first codes.
Indices read_indices(Bytes file, std::size_t at, std::size_t count, const DecodeOptions& options) {
    const int literal_bits = int(u8(file, at));
    if (literal_bits < 1 || literal_bits > max_literal_bits)
        throw damaged("GIF", "its codes have an impossible length");
    Indices indices{std::vector<std::uint8_t>(count), 0};
    SubBlocks blocks(file, at + 1);
    const std::ptrdiff_t got = decode_lzw([&] { return blocks.next(); }, literal_bits, indices.values);
    const bool sound = got >= 0;
    indices.count = std::size_t(sound ? got : -1 - got);
    if (indices.count == count || (options.salvage && indices.count > 0)) return indices;
    if (indices.count == 0 && blocks.at_end_of_file()) throw truncated("GIF");
    if (!sound) throw IncompleteFile(damaged("GIF", "its codes make no sense").what());
    if (blocks.at_end_of_file()) throw incomplete("GIF");
    throw IncompleteFile(damaged("GIF", "pixels are missing").what());
}

/// Which row of the frame the `n`th stored one of an interlaced frame is.
std::vector<int> row_order(int height, bool interlaced) {
    constexpr std::array<std::array<int, 2>, 4> passes{{{0, 8}, {4, 8}, {2, 4}, {1, 2}}};  // first row, step
    std::vector<int> rows;
    for (const auto& [first, step] : passes)
        for (int y = first; interlaced && y < height; y += step) rows.push_back(y);
    for (int y = 0; !interlaced && y < height; ++y) rows.push_back(y);
    return rows;
}

/// Grey: the number of a colour is its brightness, for a file without a palette.
std::array<std::byte, 768> grey_palette() {
    std::array<std::byte, 768> grey{};
    for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = std::byte(i / 3);
    return grey;
}

struct Rectangle {
    std::size_t left, top, width, height;
};

/// What the frame does not cover, and colours that the palette does not have, stay transparent.
void place(const Indices& indices, const Rectangle& where, bool interlaced, Bytes palette, int transparent,
           Image& image) {
    std::vector<std::uint8_t>& rgba = samples_8(image);
    std::size_t from = 0;
    for (const int row : row_order(int(where.height), interlaced)) {
        std::size_t to = ((where.top + std::size_t(row)) * std::size_t(image.width) + where.left) * 4;
        for (std::size_t x = 0; x < where.width && from < indices.count; ++x, ++from, to += 4) {
            const std::size_t index = indices.values[from], colour = index * 3;
            if (colour >= palette.size()) continue;
            for (std::size_t c = 0; c < 3; ++c) rgba[to + c] = std::uint8_t(palette[colour + c]);
            rgba[to + 3] = int(index) == transparent ? 0 : 255;
        }
    }
}

/// A pixel's width over its height is (value + 15) / 64, unless the value is 0; square pixels need no word.
std::optional<Resolution> aspect_of(std::uint32_t value) {
    if (value == 0 || value + 15 == 64) return {};
    return Resolution{64, value + 15};
}

}  // namespace

Image decode_gif(Bytes file, const DecodeOptions& options) {
    const Frame frame = find_frame(file);
    const Rectangle rectangle{le16(file, frame.at + 1), le16(file, frame.at + 3), le16(file, frame.at + 5),
                              le16(file, frame.at + 7)};
    if (rectangle.width == 0 || rectangle.height == 0) throw damaged("GIF", "its first frame is empty");
    // The canvas holds the frame even where it is said to be smaller.
    const auto width = std::max<std::size_t>(le16(file, 6), rectangle.left + rectangle.width);
    const auto height = std::max<std::size_t>(le16(file, 8), rectangle.top + rectangle.height);
    check_image_size((long long)(width), (long long)(height), 8);

    const std::uint32_t flags = u8(file, frame.at + 9);
    const std::size_t local = palette_bytes(flags), global = palette_bytes(u8(file, 10));
    const std::array<std::byte, 768> grey = grey_palette();
    const Bytes palette = local    ? file.subspan(frame.at + 10, local)
                          : global ? file.subspan(13, global)
                                   : Bytes(grey);
    const std::size_t pixels = rectangle.width * rectangle.height;
    const Indices indices = read_indices(file, frame.at + 10 + local, pixels, options);
    Image image = blank_image((long long)(width), (long long)(height), 8);
    place(indices, rectangle, (flags & 0x40u) != 0, palette, frame.transparent, image);
    image.incomplete = indices.count < pixels;
    image.description.icc = read_profile(file, frame.profile_at);
    image.description.aspect = aspect_of(u8(file, 12));
    return image;
}

}  // namespace probewarp
