#include "exporting/picture_file.h"

#include "raster/rasterizer.h"

namespace probewarp {

std::unique_ptr<ImageEncoding> draw_picture_file(PictureDrawer& drawer, const Document& document,
                                                 const Deformation& deformation, const PictureFile& file,
                                                 const ExportSteps& steps) {
    ExportJob job(drawer, document, deformation, file.settings);
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

std::unique_ptr<ImageEncoding> draw_picture_file(const Document& document, const Deformation& deformation,
                                                 const PictureFile& file, const ExportSteps& steps) {
    const View view = export_view(document, deformation, file.settings);
    Rasterizer rasterizer(document.picture->image, wanted_levels(deformation, view));
    rasterizer.set_mesh(mesh_of(deformation), deformation.now, deformation.moved);
    return draw_picture_file(rasterizer, document, deformation, file, steps);
}

}  // namespace probewarp
