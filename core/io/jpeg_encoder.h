// JPEG out, row by row. Private to io.
#pragma once

#include <memory>
#include <vector>

#include "io/image_file.h"

namespace probewarp {

class JpegRows {
  public:
    /// like: has the image's size, depth and description. Throws Error and std::bad_alloc, as all
    /// here.
    JpegRows(const Image& like, const EncodeOptions& options);
    ~JpegRows();

    /// The next rows, from the top: an image as wide.
    void add(const Image& band);
    /// The file. Requires all rows.
    std::vector<std::byte> finish();

  private:
    struct Encoder;
    std::unique_ptr<Encoder> encoder_;
    Colour background_;
};

}  // namespace probewarp
