// PNG out: rows filtered and deflated in strips, by as many threads as there are. Private to io.
#pragma once

#include <tbb/task_group.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "io/bytes.h"
#include "io/file.h"
#include "io/image_file.h"

namespace probewarp {

/// What samples there are, in memory and in the file.
struct PngShape {
    int width = 0, height = 0;
    int bits = 0;      ///< 8 or 16
    int channels = 0;  ///< in memory: 1 grey, 2 grey and alpha, 4 RGBA
    int kept = 0;      ///< in the file: as many, or 3 of RGBA
};

/// Whole rows of samples in memory: rows x width x channels, row-major, in the machine's byte order.
struct PngBand {
    std::shared_ptr<const std::byte> first;  ///< there as long as any copy of this is
    int rows = 0;
};

/// A run of whole rows, ready for the file.
struct PngStrip {
    std::vector<std::byte> chunk;    ///< an IDAT chunk, without the Adler-32 that ends the last one's stream
    std::uint32_t adler = 1;         ///< of the filtered rows
    std::size_t filtered = 0;        ///< bytes of those
    std::atomic<bool> done = false;  ///< and never changed again
};

/// A PNG's rows on their way into the file. Strips are put to work as rows come, so that the next ones may be
/// drawn meanwhile. What comes out does not depend on how many threads there are or in how many bands the
/// rows came. (Its bytes may differ between kinds of processors, for which ISA-L has code of their own; what
/// they unpack to does not.)
class PngRows {
  public:
    PngRows(const PngShape& shape, Compression compression);
    PngRows(const PngRows&) = delete;
    PngRows& operator=(const PngRows&) = delete;
    ~PngRows();

    /// The next rows, from the top. Works on them itself where too many are under way, so that they do not
    /// pile up. Throws as finish() does.
    void add(const PngBand& band);

    /// The chunks of the strips that are done, behind those taken before and in their order; never the last.
    FileParts take();

    /// Waits for the rest: their chunks, the last of which ends the stream. Requires all rows. Throws Error
    /// and std::bad_alloc.
    FileParts finish();

  private:
    std::vector<std::byte> chunk_of(PngStrip& strip);

    struct Placed {
        PngBand band;
        int top = 0;
    };
    friend struct PngStripRows;

    PngShape shape_;
    Compression compression_;
    int rows_ = 0;                         ///< that came
    int strip_rows_ = 0;                   ///< of every strip but the last
    std::size_t started_ = 0, taken_ = 0;  ///< strips
    std::uint32_t adler_ = 1;              ///< of those taken
    std::deque<Placed> bands_;             ///< that strips to come need
    std::vector<PngStrip> strips_;
    std::atomic<std::size_t> under_way_ = 0;
    tbb::task_group tasks_;
};

/// Of an image's file, with its alpha where `transparent`.
PngShape png_shape(const Image& image, bool transparent);

/// What stands before the strips.
std::vector<std::byte> png_beginning(const PngShape& shape, const Description& description);

/// What is left of the file. Throws as PngRows::finish.
FileParts png_rest(PngRows& rows);

}  // namespace probewarp
