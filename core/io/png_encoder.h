// PNG out: rows filtered and deflated in strips, by as many threads as there are. Private to io.
#pragma once

#include <tbb/task_group.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/bytes.h"
#include "io/image_file.h"

namespace probewarp {

/// Samples in memory: height x width x channels, row-major, in the machine's byte order.
struct Samples {
    const std::byte* first = nullptr;
    int width = 0, height = 0;
    int channels = 0;  ///< 1 grey, 2 grey and alpha, 4 RGBA
    int bits = 0;      ///< 8 or 16
};

/// A run of whole rows, ready to be an IDAT chunk.
struct PngStrip {
    std::vector<std::byte> bytes;  ///< of the zlib stream, without the Adler-32 at its end
    std::uint32_t crc = 0;         ///< of "IDAT" and those bytes
    std::uint32_t adler = 1;       ///< of the filtered rows
    std::size_t filtered = 0;      ///< bytes of those
};

/// A PNG's rows on their way into the file. Strips are put to work as rows come, so that the next ones may be
/// drawn meanwhile. What comes out depends on the samples and the compression alone, not on how many threads
/// there are or in how many portions the rows came.
class PngRows {
  public:
    /// The samples stay where they are until this is gone.
    PngRows(const Samples& samples, Compression compression);
    PngRows(const PngRows&) = delete;
    PngRows& operator=(const PngRows&) = delete;
    ~PngRows();

    /// The first `rows` rows stand. RGBA goes without its alpha as long as it is opaque: where that ends
    /// late, what was done is done again with alpha.
    void advance(int rows);

    /// Waits for the strips. Requires advance(height). Throws Error and std::bad_alloc.
    std::vector<PngStrip> finish();

    /// Of the file: as in memory, or 3 for RGBA that is opaque as far as it stands.
    int kept_channels() const { return kept_; }

  private:
    void restart(int kept);

    Samples samples_;
    Compression compression_;
    int kept_ = 0;
    int rows_ = 0;        ///< that stand
    int strip_rows_ = 0;  ///< of every strip but the last
    std::size_t started_ = 0;
    std::vector<PngStrip> strips_;
    tbb::task_group tasks_;
};

}  // namespace probewarp
