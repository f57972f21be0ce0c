// An image on its way into a file while its rows are still being drawn.
#pragma once

#include <memory>
#include <vector>

#include "io/image_file.h"

namespace probewarp {

class PngRows;

/// format.encode in portions: the same bytes, of which PNG's are worked out as rows come and the others' at
/// the end.
class ImageEncoding {
  public:
    /// format: one that is written. The image has its final size, and stays where it is until this is gone.
    ImageEncoding(const ImageFormat& format, const Image& image, const EncodeOptions& options);
    ~ImageEncoding();

    /// The first `rows` rows stand, no fewer than before. Returns at once.
    void advance(int rows);

    /// The file's bytes. Requires all rows. Throws Error.
    std::vector<std::byte> finish();

  private:
    const ImageFormat& format_;
    const Image& image_;
    EncodeOptions options_;
    std::unique_ptr<PngRows> png_;  ///< null for the other formats
};

}  // namespace probewarp
