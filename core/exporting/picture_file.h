// A deformed document on its way into a picture's file: drawn band by band, encoded while it is drawn.
#pragma once

#include <functional>
#include <memory>

#include "exporting/export.h"
#include "io/image_encoding.h"

namespace probewarp {

/// What the file is to be.
struct PictureFile {
    const ImageFormat* format = nullptr;  ///< one that is written
    ExportSettings settings;
    EncodeOptions encode;
};

/// What is told while a file is made. Each may throw, which gives up.
struct ExportSteps {
    std::function<void(const FileParts&)> write;  ///< the file's next parts
    std::function<void()> restart;                ///< what was written is wrong: all comes once more
    std::function<void(double)> show;             ///< the part that is drawn, [0, 1]
};

/// Draws and encodes; finish() of what it returns is the file's rest. drawer: of the deformation, in this
/// view and in the file's style. Throws Error.
std::unique_ptr<ImageEncoding> draw_picture_file(PictureDrawer& drawer, const Deformation& deformation,
                                                 const View& view, const PictureFile& file,
                                                 const ExportSteps& steps);

/// Draws by the processor, which has no overlay, and encodes; finish() of what it returns is the file's rest.
/// Throws Error.
std::unique_ptr<ImageEncoding> draw_picture_file(const Deformation& deformation, const PictureFile& file,
                                                 const ExportSteps& steps);

}  // namespace probewarp
