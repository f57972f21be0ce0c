// Pictures whose rows come out of their files one after the other, so that the first can be drawn while the
// last are still being decoded. Private to io.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "model/image.h"

namespace probewarp {

class RowReader {
  public:
    virtual ~RowReader() = default;

    /// The picture with all but its pixels, for which there is room. Throws Error.
    virtual Image blank() = 0;

    /// Decodes a little more into the pixels of blank() and returns how many rows of it, from the top, are
    /// there: all of them in the end. Throws Error.
    virtual int read(std::span<std::byte> pixels) = 0;
};

/// image: the reader's blank()
void read_all(RowReader& reader, Image& image);

/// The reader's picture with all its rows.
Image read_whole(RowReader& reader);

/// read_all on a thread of its own, which ends with what is returned. Only the pixels must stay where they
/// are meanwhile. name: what errors call it
std::shared_ptr<const ArrivingRows> read_beside(std::unique_ptr<RowReader> reader, Image& image,
                                                const std::string& name);

}  // namespace probewarp
