// Projects made member by member, and what is said to those that are not what they should be.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/image_file.h"
#include "io/project.h"
#include "pictures.h"
#include "raw_zip.h"

namespace probewarp::testing {

/// The file of a picture of one pixel.
inline Bytes one_pixel() {
    Image image;
    image.width = image.height = 1;
    image.rgba = std::vector<std::uint8_t>{1, 2, 3, 255};
    return find_image_format("png")->encode(image, {});
}

/// What opening says, "" where it opens. Whatever it says is one line that begins with the file's name.
inline std::string refusal(const Bytes& bytes) {
    const std::string error = error_of([&] { decode_project(bytes, "folder/bad.probewarp"); });
    if (error.empty()) return error;
    EXPECT_TRUE(error.starts_with("folder/bad.probewarp: ")) << error;
    for (const char c : error) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << error;
    return error;
}

inline std::string refusal(const std::vector<RawMember>& members) { return refusal(raw_zip(members)); }

/// The members with another text in the place of the first `from` in the second, project.json; it must be
/// there.
inline std::vector<RawMember> with_other_json(std::vector<RawMember> members, const std::string& from,
                                              const std::string& to) {
    Bytes& bytes = members.at(1).bytes;
    std::string json(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto at = json.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) bytes = to_bytes(json.replace(at, from.size(), to));
    return members;
}

}  // namespace probewarp::testing
