// Pictures as the graphics driver holds them: mipmaps, and the way there in small steps.
#pragma once

#include <span>
#include <vector>

#include "model/image.h"
#include "render/gl_objects.h"

namespace probewarp {

/// A picture as the graphics driver holds it.
struct PictureTexture {
    GlTexture texture;
    int width = 0, height = 0;
    int last_level = 0;  ///< the smallest mipmap
    bool opaque = true;  ///< everywhere
};

/// Throws Error where the driver has no texture as large as the image.
void check_texture_size(const Image& image);

/// Hands a picture to the driver some rows at a time, so that a large one does not stop the window.
class PictureUpload {
  public:
    /// image, levels (as smaller_levels gives them): must outlive it. Throws Error as check_texture_size.
    PictureUpload(const Image& image, std::span<const Image> levels);

    bool done() const { return level_ > texture_.last_level; }
    /// Uploads about a million pixels.
    void step();
    /// Requires done().
    PictureTexture take();

  private:
    const Image& image_;
    std::span<const Image> levels_;
    PictureTexture texture_;
    int level_ = 0, row_ = 0;
};

/// All of it at once.
PictureTexture upload_picture(const Image& image);

/// A texture for the window's toolkit to draw, smoothly scaled. levels: a picture and its mipmaps, down to
/// one pixel. The driver could make these, but a software rasteriser would compile a shader to do so.
GlTexture preview_texture(std::span<const Image> levels);

}  // namespace probewarp
