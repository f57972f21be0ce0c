// An image on its way into a file while its rows are still being drawn.
#pragma once

#include <tbb/task_group.h>

#include <memory>
#include <vector>

#include "io/file.h"
#include "io/image_file.h"

namespace probewarp {

class PngRows;
class JpegRows;

/// format.encode in portions: the same bytes. PNG and JPEG are worked out as rows come and keep few of them;
/// the others keep all to the end.
class ImageEncoding {
  public:
    /// format: one that is written. like: has the image's size, depth and description; its pixels are
    /// not looked at. transparent: whether any of the image will be, as far as can be told; of use to PNG,
    /// which leaves the alpha of an opaque image out.
    ImageEncoding(const ImageFormat& format, const Image& like, const EncodeOptions& options,
                  bool transparent);
    ~ImageEncoding();

    /// The next rows, from the top: an image as wide. Throws Error.
    void add(Image band);

    /// False once `transparent` has turned out to be wrong: then all has to be done again, with its contrary.
    bool fits() const;

    /// What of the file is done, behind what was taken before.
    FileParts take();

    /// The rest of the file. Requires all rows, and that it fits. Throws Error.
    FileParts finish();

  private:
    void add_beginning(FileParts& parts);

    const ImageFormat& format_;
    EncodeOptions options_;
    bool transparent_, opaque_ = true;  ///< as foreseen; the rows so far
    bool begun_ = false;                ///< whether anything was taken
    int rows_ = 0;                      ///< that came
    Image whole_;                       ///< its pixels: for the formats without rows of their own
    std::unique_ptr<PngRows> png_;
    std::unique_ptr<JpegRows> jpeg_;
    tbb::task_group jpeg_task_;  ///< its latest band
};

}  // namespace probewarp
