// What the tests of picture files ask of a file: its pixels, its error, and that no part of it passes for the
// whole.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "image_files.h"
#include "io/image_file.h"

namespace probewarp::testing {

using Rgba = std::array<int, 4>;

/// Of a file whose rows came one after the other.
inline Image decode_arriving(const File& file, const std::string& name) {
    const Picture picture = decode_picture(file, name, Pixels::arriving);
    wait_for_rows(picture, picture.image.height);
    return picture.image;
}

/// The same whichever way it is decoded.
inline std::string error_of(const File& file, const std::string& name) {
    const auto error_by = [&](const auto& decode) -> std::string {
        try {
            decode();
            return "";
        } catch (const Error& error) {
            return error.what();
        }
    };
    const std::string error = error_by([&] { decode_picture(file, name); });
    EXPECT_EQ(error_by([&] { decode_arriving(file, name); }), error);
    return error;
}

/// The same whichever way.
inline Image decode(const File& file, const std::string& name = "picture") {
    Image image = decode_picture(file, name).image;
    const Image arriving = decode_arriving(file, name);
    EXPECT_EQ(arriving.width, image.width);
    EXPECT_EQ(arriving.height, image.height);
    EXPECT_EQ(arriving.rgba, image.rgba);
    EXPECT_EQ(arriving.description, image.description);
    return image;
}

inline File encode(const Image& image, std::string_view format, const EncodeOptions& options = {}) {
    return find_image_format(format)->encode(image, options);
}

/// Row after row; every pixel as RGBA.
inline std::vector<Rgba> pixels(const Image& image) {
    std::vector<Rgba> all;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) all.push_back(pixel(image, x, y));
    return all;
}

/// Every prefix of the file is refused as truncated, or, while it is too short to be recognised, as no
/// picture. needless: bytes at the end without which it opens, with all of its pixels
inline void expect_each_cut_refused(const File& file, const std::string& name, std::size_t needless = 0) {
    ASSERT_EQ(error_of(file, name), "");
    for (std::size_t size = file.size() - needless; size < file.size(); ++size)
        EXPECT_EQ(pixels(decode(File(file.begin(), file.begin() + std::ptrdiff_t(size)), name)),
                  pixels(decode(file, name)));
    for (std::size_t size = 0; size < file.size() - needless; ++size) {
        const File cut(file.begin(), file.begin() + std::ptrdiff_t(size));
        ASSERT_THAT(error_of(cut, name),
                    ::testing::AnyOf(::testing::HasSubstr(name + ": is truncated; expected a whole "),
                                     ::testing::HasSubstr("not a picture that can be read")))
            << "cut to " << size << " of " << file.size() << " bytes";
        // 18: the header of TGA, the last to be recognised.
        if (size >= 18) {
            ASSERT_THAT(error_of(cut, name), ::testing::HasSubstr("truncated")) << size;
        }
    }
}

/// Refused with these words.
inline void expect_refused(const File& file, const std::string& name, const std::string& words) {
    EXPECT_THAT(error_of(file, name), ::testing::HasSubstr(words));
}

/// The most memory that this process has had at once, bytes.
inline long long peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss * 1024LL;
}

}  // namespace probewarp::testing
