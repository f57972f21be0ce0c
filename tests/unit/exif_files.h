// EXIF made and taken apart for the tests, in either byte order. The library under test has no part in it.
#pragma once

#include <map>
#include <string_view>
#include <vector>

#include "image_files.h"

namespace probewarp::testing {

/// TIFF's kinds of values.
enum class TagType { byte = 1, ascii = 2, two_bytes = 3, four_bytes = 4, rational = 5, undefined = 7 };

struct Tag {
    int tag;
    TagType type;
    std::size_t count;
    File value;
};

/// Numbers in one of the two byte orders.
struct ByteOrder {
    bool big;
    File number(std::size_t count, std::uint64_t value) const {
        return big ? be(count, value) : le(count, value);
    }
    Tag two(int tag, std::uint64_t value) const { return {tag, TagType::two_bytes, 1, number(2, value)}; }
    Tag four(int tag, std::uint64_t value) const { return {tag, TagType::four_bytes, 1, number(4, value)}; }
    Tag rational(int tag, std::uint64_t numerator, std::uint64_t denominator) const {
        return {tag, TagType::rational, 1, join({number(4, numerator), number(4, denominator)})};
    }
};

inline Tag text(int tag, std::string_view characters) {
    return {tag, TagType::ascii, characters.size() + 1, join({bytes_of(characters), bytes({0})})};
}
inline Tag undefined(int tag, std::string_view characters) {
    return {tag, TagType::undefined, characters.size(), bytes_of(characters)};
}

/// The directories of a picture; `main` and `thumbnail` without the pointers to the others.
struct ExifTags {
    std::vector<Tag> main{}, exif{}, gps{}, thumbnail{};
    File thumbnail_file{};
};

/// One directory at `offset`, with its values behind it.
inline File directory(const ByteOrder& order, const std::vector<Tag>& tags, std::size_t offset,
                      std::size_t next) {
    const std::size_t values_at = offset + 2 + tags.size() * 12 + 4;
    File entries = order.number(2, tags.size()), values;
    for (const Tag& tag : tags) {
        entries += join({order.number(2, unsigned(tag.tag)), order.number(2, unsigned(tag.type)),
                         order.number(4, tag.count)});
        if (tag.value.size() <= 4) {
            entries += join({tag.value, File(4 - tag.value.size())});
        } else {
            entries += order.number(4, values_at + values.size());
            values += tag.value;
            if (values.size() % 2 == 1) values.push_back(std::byte{0});
        }
    }
    return join({entries, order.number(4, next), values});
}

/// A TIFF block.
inline File make_exif(const ByteOrder& order, const ExifTags& tags) {
    const auto length = [&](const std::vector<Tag>& of) { return directory(order, of, 0, 0).size(); };
    std::vector<Tag> main = tags.main, thumbnail = tags.thumbnail;
    if (!tags.exif.empty()) main.push_back(order.four(0x8769, 0));
    if (!tags.gps.empty()) main.push_back(order.four(0x8825, 0));
    const std::size_t exif_at = 8 + length(main);
    const std::size_t gps_at = exif_at + (tags.exif.empty() ? 0 : length(tags.exif));
    const std::size_t thumbnail_at = gps_at + (tags.gps.empty() ? 0 : length(tags.gps));
    for (Tag& tag : main) {
        if (tag.tag == 0x8769) tag = order.four(0x8769, exif_at);
        if (tag.tag == 0x8825) tag = order.four(0x8825, gps_at);
    }
    if (!tags.thumbnail_file.empty()) {
        thumbnail.push_back(order.four(0x0201, 0));
        thumbnail.push_back(order.four(0x0202, tags.thumbnail_file.size()));
        thumbnail[thumbnail.size() - 2] = order.four(0x0201, thumbnail_at + length(thumbnail));
    }
    File file = join({bytes_of(order.big ? "MM" : "II"), order.number(2, 42), order.number(4, 8),
                      directory(order, main, 8, thumbnail.empty() ? 0 : thumbnail_at)});
    if (!tags.exif.empty()) file += directory(order, tags.exif, exif_at, 0);
    if (!tags.gps.empty()) file += directory(order, tags.gps, gps_at, 0);
    if (!thumbnail.empty()) file += join({directory(order, thumbnail, thumbnail_at, 0), tags.thumbnail_file});
    return file;
}

inline File exif_app1(const File& tiff) {
    return join({bytes({0xFF, 0xE1}), be(2, tiff.size() + 8), bytes_of("Exif"), bytes({0, 0}), tiff});
}

/// Every tag's value as it is stored, by directory ("main", "exif", "gps", "next") and number; none of a file
/// that does not hold together.
inline std::map<std::string, std::map<int, File>> tags_of(const File& tiff) {
    std::map<std::string, std::map<int, File>> found;
    if (tiff.size() < 8) return found;
    const bool big = tiff[0] == std::byte{'M'};
    const auto number = [&](std::size_t at, std::size_t count) {
        std::size_t value = 0;
        for (std::size_t i = 0; i < count; ++i)
            value = value << 8 | std::to_integer<std::size_t>(tiff.at(big ? at + i : at + count - 1 - i));
        return value;
    };
    const std::map<std::size_t, std::size_t> sizes{{1, 1}, {2, 1}, {3, 2}, {4, 4}, {5, 8}, {7, 1}, {10, 8}};
    const std::function<void(std::string, std::size_t)> read = [&](const std::string& name, std::size_t at) {
        const std::size_t count = number(at, 2);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t entry = at + 2 + i * 12;
            const auto tag = int(number(entry, 2));
            const std::size_t size = sizes.at(number(entry + 2, 2)) * number(entry + 4, 4);
            const std::size_t from = size <= 4 ? entry + 8 : number(entry + 8, 4);
            if (from + size > tiff.size()) throw std::out_of_range("a tag's value");
            found[name][tag] =
                File(tiff.begin() + std::ptrdiff_t(from), tiff.begin() + std::ptrdiff_t(from + size));
            if (tag == 0x8769) read("exif", number(entry + 8, 4));
            if (tag == 0x8825) read("gps", number(entry + 8, 4));
        }
        if (const std::size_t next = number(at + 2 + count * 12, 4)) read("next", next);
    };
    read("main", number(4, 4));
    return found;
}

}  // namespace probewarp::testing
