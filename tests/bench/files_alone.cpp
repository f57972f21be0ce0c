// What a render is measured against: a picture's file decoded and encoded as a PNG by a process of its own,
// which does nothing else.
#include <cstdio>
#include <exception>

#include "io/file.h"
#include "io/image_file.h"

int main(int count, char** arguments) {
    if (count != 2) return 2;
    try {
        const auto image = probewarp::read_picture(arguments[1]).image;
        return probewarp::find_image_format("png")->encode(image, {}).empty() ? 1 : 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
