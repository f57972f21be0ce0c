#include "render/picture_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <type_traits>

namespace probewarp {

namespace {

template <class Sample>
std::vector<Sample> half_size(const std::vector<Sample>& from, int width, int height) {
    const int half_width = std::max(1, width / 2), half_height = std::max(1, height / 2);
    std::vector<Sample> to(std::size_t(half_width) * std::size_t(half_height) * 4);
    for (int y = 0; y < half_height; ++y)
        for (int x = 0; x < half_width; ++x) {
            const int right = std::min(2 * x + 1, width - 1), below = std::min(2 * y + 1, height - 1);
            std::uint64_t sum[4]{}, plain[3]{};
            for (const auto& [px, py] :
                 {std::array{2 * x, 2 * y}, {right, 2 * y}, {2 * x, below}, {right, below}}) {
                const Sample* p = &from[(std::size_t(py) * std::size_t(width) + std::size_t(px)) * 4];
                for (int k = 0; k < 3; ++k) sum[k] += std::uint64_t(p[k]) * p[3], plain[k] += p[k];
                sum[3] += p[3];
            }
            Sample* q = &to[(std::size_t(y) * std::size_t(half_width) + std::size_t(x)) * 4];
            for (int k = 0; k < 3; ++k)
                q[k] = Sample(sum[3] > 0 ? (sum[k] + sum[3] / 2) / sum[3] : (plain[k] + 2) / 4);
            q[3] = Sample((sum[3] + 2) / 4);
        }
    return to;
}

bool is_opaque(const Image& image, int first_row, int rows) {
    return std::visit(
        [&](const auto& samples) {
            using Sample = typename std::decay_t<decltype(samples)>::value_type;
            const std::size_t row = std::size_t(image.width) * 4, first = std::size_t(first_row) * row;
            Sample all = std::numeric_limits<Sample>::max();
            for (std::size_t i = first + 3; i < first + std::size_t(rows) * row; i += 4)
                all = Sample(all & samples[i]);
            return all == std::numeric_limits<Sample>::max();
        },
        image.rgba);
}

}  // namespace

std::vector<Image> smaller_levels(const Image& image, int most) {
    std::vector<Image> levels;
    levels.reserve(32);  // more than halvings there are: `from` stays where it is
    const Image* from = &image;
    while (int(levels.size()) < most && (from->width > 1 || from->height > 1)) {
        Image next;
        next.width = std::max(1, from->width / 2);
        next.height = std::max(1, from->height / 2);
        std::visit([&](const auto& samples) { next.rgba = half_size(samples, from->width, from->height); },
                   from->rgba);
        levels.push_back(std::move(next));
        from = &levels.back();
    }
    return levels;
}

void check_texture_size(const Image& image) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    if (image.width > largest || image.height > largest)
        throw Error(fmt::format("the picture is {} x {} pixels; this graphics driver holds at most {} x {}",
                                image.width, image.height, largest, largest));
}

PictureUpload::PictureUpload(const Image& image, std::span<const Image> levels)
    : image_(image), levels_(levels) {
    check_texture_size(image);
    texture_ = {make_texture(), image.width, image.height, int(levels.size()), true};
    glBindTexture(GL_TEXTURE_2D, texture_.texture.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, texture_.last_level);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    for (int level = 0; level <= texture_.last_level; ++level) {
        const Image& from = level == 0 ? image : levels[std::size_t(level) - 1];
        glTexImage2D(GL_TEXTURE_2D, level, image.bits() == 16 ? GL_RGBA16 : GL_RGBA8, from.width, from.height,
                     0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    }
    check_gl("making room for the picture");
}

void PictureUpload::step() {
    assert(!done());
    const Image& from = level_ == 0 ? image_ : levels_[std::size_t(level_) - 1];
    const int rows = std::clamp((1 << 20) / from.width, 1, from.height - row_);
    const bool deep = from.bits() == 16;
    const std::size_t row_bytes = std::size_t(from.width) * (deep ? 8 : 4);
    glBindTexture(GL_TEXTURE_2D, texture_.texture.name());
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glTexSubImage2D(GL_TEXTURE_2D, level_, 0, row_, from.width, rows, GL_RGBA,
                    deep ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE,
                    pixel_bytes(from).data() + std::size_t(row_) * row_bytes);
    check_gl("uploading the picture");
    if (level_ == 0) texture_.opaque = texture_.opaque && is_opaque(from, row_, rows);
    row_ += rows;
    if (row_ == from.height) row_ = 0, ++level_;
}

PictureTexture PictureUpload::take() {
    assert(done());
    return std::move(texture_);
}

PictureTexture upload_picture(const Image& image, int most_levels) {
    const std::vector<Image> levels = smaller_levels(image, most_levels);
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
