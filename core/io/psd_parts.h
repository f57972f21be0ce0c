// What the parts of the reader of Photoshop's files hand each other: PSD, and PSB for large pictures. Private
// to io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/bytes.h"
#include "model/error.h"
#include "model/image.h"

namespace probewarp {

/// As the file numbers them.
enum class PsdMode : std::uint32_t {
    bitmap = 0,
    grey = 1,
    indexed = 2,
    rgb = 3,
    cmyk = 4,
    multichannel = 7,
    duotone = 8,
    lab = 9,
};

/// What a file says up to its merged picture. The spans lie in the file's bytes.
struct Psd {
    bool large = false;  ///< PSB
    std::size_t channels = 0, width = 0, height = 0;
    int bits = 8;  ///< of a sample: 1, 8, 16, or 32 of a floating-point one
    PsdMode mode = PsdMode::rgb;
    std::size_t colours = 3;  ///< so many channels stand first, and make the colours

    Bytes palette;                            ///< of an indexed file: its reds, its greens, its blues
    std::optional<std::uint8_t> clear_index;  ///< of an indexed file: the colour that is transparent
    Bytes icc;
    Bytes exif;                                    ///< from the byte order on
    std::optional<Resolution> resolution, aspect;  ///< as in Description
    bool merged = true;                            ///< false: the file says that its merged picture is none
    bool layered = false;
    std::optional<std::size_t> alpha;  ///< the channel that is the merged picture's transparency

    std::uint32_t compression = 0;
    Bytes rows;  ///< of the merged picture, as they are stored

    std::string label() const { return large ? "PSB" : "PSD"; }
    std::size_t row_bytes() const { return (width * std::size_t(bits) + 7) / 8; }
};

/// How much may be inflated of channels that are no part of the picture: ten of 8 bits in the largest
/// picture.
constexpr std::uint64_t max_psd_bytes_between = std::uint64_t{1} << 30;

/// Throws Error, and checks the picture's size.
Psd read_psd_sections(Bytes file);

/// One channel of the merged picture, row after row from the top.
class PsdChannel {
  public:
    virtual ~PsdChannel() = default;
    /// row: row_bytes() long, for big-endian samples. Throws IncompleteFile where the row is missing or
    /// damaged; the next one may be there all the same.
    virtual void read(std::span<std::byte> row) = 0;
    /// One that goes on from the same row.
    virtual std::unique_ptr<PsdChannel> copy() const = 0;
};

struct PsdChannels {
    /// The colours, and then the alpha where there is one.
    std::vector<std::unique_ptr<PsdChannel>> list;
    std::optional<IncompleteFile> fault;  ///< that some of the rows, of whichever channels, are missing
};

/// At their first rows. Looks through the rows that are deflated, so a picture that is read more than once is
/// read from copies. Throws Error where nothing can be read of the picture, or where more than
/// max_psd_bytes_between would have to be inflated that are no part of it.
PsdChannels psd_channels(const Psd& psd);

/// The merged picture as RGBA. With `salvage`, what is missing is clear, or is without that colour; the image
/// is then marked as incomplete. Throws Error; IncompleteFile where salvaging would open the file.
Image read_psd_pixels(const Psd& psd, bool salvage);

}  // namespace probewarp
