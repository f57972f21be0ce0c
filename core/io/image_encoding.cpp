#include "io/image_encoding.h"

#include <cassert>
#include <type_traits>
#include <utility>

#include "io/formats.h"
#include "io/jpeg_encoder.h"
#include "io/png_encoder.h"

namespace probewarp {

namespace {

/// Rows that the file may be the last to need.
PngBand band_of(Image image) {
    const int rows = image.height;
    const auto kept = std::make_shared<const Image>(std::move(image));
    return {std::shared_ptr<const std::byte>(kept, pixel_bytes(*kept).data()), rows};
}

}  // namespace

ImageEncoding::ImageEncoding(const ImageFormat& format, const Image& like, const EncodeOptions& options,
                             bool transparent)
    : format_(format), options_(options), transparent_(transparent) {
    whole_.width = like.width;
    whole_.height = like.height;
    whole_.description = like.description;
    if (like.bits() == 16) whole_.rgba = std::vector<std::uint16_t>();
    if (format.encode == &encode_png)
        png_ = std::make_unique<PngRows>(png_shape(whole_, transparent), options.compression);
    else if (format.encode == &encode_jpeg)
        jpeg_ = std::make_unique<JpegRows>(whole_, options);
    else
        std::visit([&](auto& rgba) { rgba.reserve(std::size_t(like.width) * std::size_t(like.height) * 4); },
                   whole_.rgba);
}

ImageEncoding::~ImageEncoding() {
    try {
        jpeg_task_.wait();
    } catch (...) {  // of no use to anybody any more
    }
}

void ImageEncoding::add(Image band) {
    assert(band.width == whole_.width && band.bits() == whole_.bits());
    rows_ += band.height;
    if (jpeg_) {
        jpeg_task_.wait();
        return jpeg_task_.run(
            [this, rows = std::make_shared<const Image>(std::move(band))] { jpeg_->add(*rows); });
    }
    if (png_) {
        opaque_ = opaque_ && !has_alpha(band);
        return png_->add(band_of(std::move(band)));
    }
    std::visit(
        [&](auto& rgba) {
            const auto& rows = std::get<std::decay_t<decltype(rgba)>>(band.rgba);
            rgba.insert(rgba.end(), rows.begin(), rows.end());
        },
        whole_.rgba);
}

bool ImageEncoding::fits() const {
    if (!png_) return true;
    return transparent_ ? !opaque_ || rows_ < whole_.height : opaque_;
}

FileParts ImageEncoding::take() {
    if (!png_) return {};
    FileParts parts = png_->take();
    if (!parts.empty()) add_beginning(parts);
    return parts;
}

FileParts ImageEncoding::finish() {
    assert(rows_ == whole_.height && fits());
    jpeg_task_.wait();
    FileParts parts;
    if (png_) {
        parts = png_rest(*png_);
        add_beginning(parts);
    } else {
        parts.push_back(jpeg_ ? jpeg_->finish() : format_.encode(whole_, options_));
    }
    return parts;
}

void ImageEncoding::add_beginning(FileParts& parts) {
    if (begun_) return;
    begun_ = true;
    parts.insert(parts.begin(), png_beginning(png_shape(whole_, transparent_), whole_.description));
}

}  // namespace probewarp
