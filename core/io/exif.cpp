#include "io/exif.h"

#include <libexif/exif-data.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <span>

#include "io/formats.h"

namespace probewarp {

namespace {

using ExifFile = std::unique_ptr<ExifData, decltype(&exif_data_unref)>;

constexpr char head[] = "Exif\0";  // and a zero more: what stands before the TIFF block in a JPEG
constexpr std::size_t head_bytes = 6;

/// Null where it cannot be read.
ExifFile open_exif(Bytes tiff) {
    ExifFile data(exif_data_new(), &exif_data_unref);
    if (!data) throw std::bad_alloc();
    // IGNORE_UNKNOWN_TAGS would leave out the tags that libexif does not know. FOLLOW_SPECIFICATION would add
    // what the specification asks for: a resolution of 72 dots per inch that nobody stated.
    exif_data_unset_option(data.get(), EXIF_DATA_OPTION_IGNORE_UNKNOWN_TAGS);
    exif_data_unset_option(data.get(), EXIF_DATA_OPTION_FOLLOW_SPECIFICATION);
    std::vector<std::byte> bytes(head_bytes + tiff.size());
    std::transform(head, head + head_bytes, bytes.begin(), [](char c) { return std::byte(c); });
    std::ranges::copy(tiff, bytes.begin() + head_bytes);
    exif_data_load_data(data.get(), reinterpret_cast<const unsigned char*>(bytes.data()),
                        unsigned(bytes.size()));
    return data;
}

/// The value of a tag of the main picture's directory, where it is one number of that format.
ExifEntry* number(ExifData* data, ExifTag tag, ExifFormat format) {
    ExifEntry* entry = exif_content_get_entry(data->ifd[EXIF_IFD_0], tag);
    const bool fits = entry && entry->format == format && entry->components >= 1 && entry->data &&
                      entry->size >= exif_format_get_size(format);
    return fits ? entry : nullptr;
}

int short_value(ExifData* data, ExifTag tag, int otherwise) {
    const ExifEntry* entry = number(data, tag, EXIF_FORMAT_SHORT);
    return entry ? exif_get_short(entry->data, exif_data_get_byte_order(data)) : otherwise;
}

/// 0 where there is none.
double rational_value(ExifData* data, ExifTag tag) {
    const ExifEntry* entry = number(data, tag, EXIF_FORMAT_RATIONAL);
    if (!entry) return 0;
    const ExifRational value = exif_get_rational(entry->data, exif_data_get_byte_order(data));
    return value.denominator == 0 ? 0 : double(value.numerator) / value.denominator;
}

std::optional<Resolution> resolution_of(ExifData* data) {
    const int unit = short_value(data, EXIF_TAG_RESOLUTION_UNIT, 2);  // 1: none; 2: inch; 3: centimetre
    if (unit != 2 && unit != 3) return {};
    const double per_metre = unit == 3 ? 100 : 1 / 0.0254;
    const double x = std::round(rational_value(data, EXIF_TAG_X_RESOLUTION) * per_metre);
    const double y = std::round(rational_value(data, EXIF_TAG_Y_RESOLUTION) * per_metre);
    if (!is_resolution(x, y)) return {};
    return Resolution{std::uint32_t(x), std::uint32_t(y)};
}

// ---- what is handed on ----

/// Of the main directory: how and where the pixels are stored, as in a TIFF file; the resolution; the
/// profile; padding. The file that is written has its own.
constexpr std::array<unsigned, 31> of_the_stored_picture{
    0x00FE, 0x00FF, 0x0100, 0x0101, 0x0102, 0x0103, 0x0106, 0x010A, 0x0111, 0x0115, 0x0116,
    0x0117, 0x011A, 0x011B, 0x011C, 0x0128, 0x013D, 0x0140, 0x0142, 0x0143, 0x0144, 0x0145,
    0x014A, 0x0152, 0x0153, 0x015B, 0x0201, 0x0202, 0x8773, 0xEA1C, 0xEA1D};
constexpr std::array<unsigned, 4> of_its_colour_samples{0x0211, 0x0212, 0x0213, 0x0214};
/// Of the EXIF directory: components and compression, width and height, the maker's notes, whose inner
/// offsets hold only where they stood, and places in the picture, which deforming it moves.
constexpr std::array<unsigned, 9> of_the_stored_exif{0x9101, 0x9102, 0xA002, 0xA003, 0x927C,
                                                     0x9214, 0xA214, 0xEA1C, 0xEA1D};

void remove_tags(ExifContent* directory, std::span<const unsigned> tags) {
    for (const unsigned tag : tags)
        while (ExifEntry* entry = exif_content_get_entry(directory, ExifTag(tag)))
            exif_content_remove_entry(directory, entry);
}

bool says_anything(const ExifData* data) {
    for (const ExifIfd directory : {EXIF_IFD_0, EXIF_IFD_EXIF, EXIF_IFD_GPS, EXIF_IFD_INTEROPERABILITY}) {
        const ExifContent* content = data->ifd[directory];
        for (unsigned i = 0; i < content->count; ++i)
            if (directory != EXIF_IFD_0 || content->entries[i]->tag != EXIF_TAG_ORIENTATION) return true;
    }
    return false;
}

void keep_only_what_stays_true(ExifData* data) {
    remove_tags(data->ifd[EXIF_IFD_0], of_the_stored_picture);
    remove_tags(data->ifd[EXIF_IFD_0], of_its_colour_samples);
    remove_tags(data->ifd[EXIF_IFD_EXIF], of_the_stored_exif);
    ExifContent* thumbnail = data->ifd[EXIF_IFD_1];
    while (thumbnail->count > 0) exif_content_remove_entry(thumbnail, thumbnail->entries[0]);
    data->size = 0;  // of the thumbnail's own file
    if (const ExifEntry* entry = number(data, EXIF_TAG_ORIENTATION, EXIF_FORMAT_SHORT))
        exif_set_short(entry->data, exif_data_get_byte_order(data), 1);
    else
        remove_tags(data->ifd[EXIF_IFD_0], std::array{unsigned(EXIF_TAG_ORIENTATION)});
}

std::vector<std::byte> saved(ExifData* data) {
    unsigned char* bytes = nullptr;
    unsigned size = 0;
    exif_data_save_data(data, &bytes, &size);
    const std::unique_ptr<unsigned char, decltype(&std::free)> owned(bytes, &std::free);
    if (!bytes || size <= head_bytes || size - head_bytes > max_exif_bytes) return {};
    const auto all = std::as_bytes(std::span(bytes, size));
    return {all.begin() + head_bytes, all.end()};
}

}  // namespace

Exif parse_exif(Bytes tiff) {
    Exif found;
    if (tiff.size() < 8 || tiff.size() > max_exif_source_bytes) return found;
    const ExifFile data = open_exif(tiff);
    const int orientation = short_value(data.get(), EXIF_TAG_ORIENTATION, 1);
    if (orientation >= 1 && orientation <= 8) found.orientation = orientation;
    found.resolution = resolution_of(data.get());
    keep_only_what_stays_true(data.get());
    if (says_anything(data.get())) found.block = saved(data.get());
    return found;
}

}  // namespace probewarp
