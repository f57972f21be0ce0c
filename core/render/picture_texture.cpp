#include "render/picture_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "raster/mipmaps.h"

namespace probewarp {

namespace {

bool is_opaque(const Image& image, int first_row, int rows) {
    return std::visit(
        [&](const auto& samples) {
            const std::size_t row = std::size_t(image.width) * 4;
            return probewarp::is_opaque(
                std::span(samples).subspan(std::size_t(first_row) * row, std::size_t(rows) * row));
        },
        image.rgba);
}

}  // namespace

void check_texture_size(const Image& image) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    if (image.width > largest || image.height > largest)
        throw Error(fmt::format("the picture is {} x {} pixels; this graphics driver holds at most {} x {}",
                                image.width, image.height, largest, largest));
}

namespace {

/// Room for an image of that size and its first mipmaps.
PictureTexture picture_room(const Image& image, int last_level) {
    check_texture_size(image);
    PictureTexture room{make_texture(), image.width, image.height, last_level, true};
    const GLenum format = image.bits() == 16 ? GL_RGBA16 : GL_RGBA8;
    glBindTexture(GL_TEXTURE_2D, room.texture.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, last_level);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    // Asked for one level after the other, Mesa makes room for all that there might be.
    if (GLAD_GL_ARB_texture_storage) {
        glTexStorage2D(GL_TEXTURE_2D, last_level + 1, format, image.width, image.height);
    } else {
        Extent size{image.width, image.height};
        for (int level = 0; level <= last_level; ++level, size = half(size))
            glTexImage2D(GL_TEXTURE_2D, level, GLint(format), size.width, size.height, 0, GL_RGBA,
                         GL_UNSIGNED_BYTE, nullptr);
    }
    check_gl("making room for the picture");
    return room;
}

/// About a million pixels.
int rows_at_once(const Image& level, int first_row) {
    return std::clamp((1 << 20) / level.width, 1, level.height - first_row);
}

void upload_rows(PictureTexture& texture, int level, const Image& from, int first_row, int rows) {
    const bool deep = from.bits() == 16;
    const std::size_t row_bytes = std::size_t(from.width) * (deep ? 8 : 4);
    glBindTexture(GL_TEXTURE_2D, texture.texture.name());
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glTexSubImage2D(GL_TEXTURE_2D, level, 0, first_row, from.width, rows, GL_RGBA,
                    deep ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE,
                    pixel_bytes(from).data() + std::size_t(first_row) * row_bytes);
    check_gl("uploading the picture");
    if (level == 0) texture.opaque = texture.opaque && is_opaque(from, first_row, rows);
}

}  // namespace

PictureUpload::PictureUpload(const Image& image, std::span<const Image> levels)
    : image_(image), levels_(levels), texture_(picture_room(image, int(levels.size()))) {}

void PictureUpload::step() {
    assert(!done());
    const Image& from = level_ == 0 ? image_ : levels_[std::size_t(level_) - 1];
    const int rows = rows_at_once(from, row_);
    upload_rows(texture_, level_, from, row_, rows);
    row_ += rows;
    if (row_ == from.height) row_ = 0, ++level_;
}

PictureTexture PictureUpload::take() {
    assert(done());
    return std::move(texture_);
}

PictureTexture upload_picture(const Image& image) {
    const std::vector<Image> levels = smaller_levels(image);
    PictureUpload upload(image, levels);
    while (!upload.done()) upload.step();
    return upload.take();
}

GlTexture preview_texture(std::span<const Image> levels) {
    GlTexture texture = make_texture();
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, GLint(levels.size()) - 1);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    GLint level = 0;
    for (const Image& image : levels)
        glTexImage2D(GL_TEXTURE_2D, level++, GL_RGBA8, image.width, image.height, 0, GL_RGBA,
                     image.bits() == 16 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, pixel_bytes(image).data());
    return texture;
}

}  // namespace probewarp
