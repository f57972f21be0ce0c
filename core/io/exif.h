// The two things that we want of a JPEG's EXIF: which way is up, and the resolution. Private to io; inline,
// for jpeg.cpp alone needs it.
#pragma once

#include <libexif/exif-data.h>

#include <cmath>
#include <memory>
#include <optional>

#include "io/formats.h"

namespace probewarp {

struct Exif {
    int orientation = 1;  ///< 1 to 8
    std::optional<Resolution> resolution;
};

/// The value of a tag of the main picture's directory, where it is one number of that format.
inline ExifEntry* exif_entry(ExifData* data, ExifTag tag, ExifFormat format) {
    ExifEntry* entry = exif_content_get_entry(data->ifd[EXIF_IFD_0], tag);
    const bool fits = entry && entry->format == format && entry->components >= 1 && entry->data &&
                      entry->size >= exif_format_get_size(format);
    return fits ? entry : nullptr;
}

inline int exif_short(ExifData* data, ExifTag tag, int otherwise) {
    const ExifEntry* entry = exif_entry(data, tag, EXIF_FORMAT_SHORT);
    return entry ? exif_get_short(entry->data, exif_data_get_byte_order(data)) : otherwise;
}

/// 0 where there is none.
inline double exif_rational(ExifData* data, ExifTag tag) {
    const ExifEntry* entry = exif_entry(data, tag, EXIF_FORMAT_RATIONAL);
    if (!entry) return 0;
    const ExifRational value = exif_get_rational(entry->data, exif_data_get_byte_order(data));
    return value.denominator == 0 ? 0 : double(value.numerator) / value.denominator;
}

/// `marker`: the APP1 marker's data from "Exif" on. What cannot be read is as if it were not there.
inline Exif parse_exif(Bytes marker) {
    Exif found;
    const auto* bytes = reinterpret_cast<const unsigned char*>(marker.data());
    const std::unique_ptr<ExifData, decltype(&exif_data_unref)> data(
        exif_data_new_from_data(bytes, unsigned(marker.size())), &exif_data_unref);
    if (!data) return found;

    const int orientation = exif_short(data.get(), EXIF_TAG_ORIENTATION, 1);
    if (orientation >= 1 && orientation <= 8) found.orientation = orientation;

    const bool centimetres = exif_short(data.get(), EXIF_TAG_RESOLUTION_UNIT, 2) == 3;
    const double unit = centimetres ? 100 : 1 / 0.0254;
    const double x = std::round(exif_rational(data.get(), EXIF_TAG_X_RESOLUTION) * unit);
    const double y = std::round(exif_rational(data.get(), EXIF_TAG_Y_RESOLUTION) * unit);
    if (is_resolution(x, y)) found.resolution = Resolution{std::uint32_t(x), std::uint32_t(y)};
    return found;
}

}  // namespace probewarp
