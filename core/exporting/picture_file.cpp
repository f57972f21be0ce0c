#include "exporting/picture_file.h"

#include "raster/rasterizer.h"

namespace probewarp {

std::unique_ptr<ImageEncoding> draw_picture_file(PictureDrawer& drawer, const Deformation& deformation,
                                                 const View& view, const PictureFile& file,
                                                 const ExportSteps& steps) {
    ExportJob job(drawer, deformation, view, file_style(file.settings));
    for (bool transparent = job.may_be_transparent();; transparent = !transparent) {
        auto encoding = std::make_unique<ImageEncoding>(*file.format, job.like(), file.encode, transparent);
        while (!job.done() && encoding->fits()) {
            encoding->add(job.next_band());
            steps.write(encoding->take());
            steps.show(job.progress());
        }
        if (encoding->fits()) return encoding;
        job.restart();
        steps.restart();
    }
}

std::unique_ptr<ImageEncoding> draw_picture_file(const Deformation& deformation, const PictureFile& file,
                                                 const ExportSteps& steps) {
    const View view = export_view(deformation, file.settings);
    Rasterizer rasterizer(deformation, view, file_style(file.settings));
    return draw_picture_file(rasterizer, deformation, view, file, steps);
}

}  // namespace probewarp
