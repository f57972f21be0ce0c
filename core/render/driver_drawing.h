// A deformed picture drawn for a file by the graphics driver: with what lies over it, or to compare with the
// processor's.
#pragma once

#include "raster/picture_drawer.h"
#include "render/renderer.h"

namespace probewarp {

class DriverDrawing final : public PictureDrawer {
  public:
    /// renderer: holds the picture and its deformed mesh, must outlive it and be left alone
    DriverDrawing(Renderer& renderer, const View& view, const FileStyle& style)
        : renderer_(renderer), view_(view), style_(style) {}

    bool is_opaque() const override { return renderer_.is_opaque(); }
    /// In tiles, so that the size is not limited by the driver's textures.
    void draw_rows(int first_row, Image& band) override;

  private:
    Renderer& renderer_;
    View view_;
    FileStyle style_;
};

}  // namespace probewarp
