// Files that end too soon: refused, and opened where one asks for what is there.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "image_checks.h"

namespace probewarp::testing {

/// What salvaging opens of a file that is refused without.
inline Image salvaged(const File& file, const std::string& name = "a.tga") {
    EXPECT_THROW(decode_picture(file, name), IncompleteFile);
    const Picture picture = decode_picture(file, name, Pixels::whole, {.salvage = true});
    EXPECT_TRUE(picture.image.incomplete);
    EXPECT_EQ(picture.format, "png") << "its original is sound";
    return picture.image;
}

/// Nothing of it can be opened, and nothing offers to.
inline void expect_nothing_to_salvage(const File& file, const std::string& name = "a.tga") {
    const auto decode = [&](bool salvage) {
        decode_picture(file, name, Pixels::whole, {.salvage = salvage});
    };
    EXPECT_THROW(decode(true), Error);
    try {
        decode(false);
        ADD_FAILURE() << "opened";
    } catch (const IncompleteFile& error) {
        ADD_FAILURE() << "offers to salvage: " << error.what();
    } catch (const Error&) {
    }
}

}  // namespace probewarp::testing
