// The mesh as a Wavefront OBJ: its exact text, and that every float comes back.
#include "io/obj.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "pictures.h"

namespace probewarp {
namespace {

using testing::add_probe;
using testing::blank_document;

TEST(Obj, OfTwoCells) {
    Document document = blank_document(8, 4, 2);
    add_probe(document, {-4, 2}, {-3, 2.5});  // everything by (1, 1/2)
    Deformation deformation;
    update(deformation, document);
    EXPECT_EQ(encode_obj(document, deformation),
              "# Probewarp: x right, y down, in image pixels\n"
              "v 1 0.5 0\n"
              "v 5 0.5 0\n"
              "v 9 0.5 0\n"
              "v 1 4.5 0\n"
              "v 5 4.5 0\n"
              "v 9 4.5 0\n"
              "vt 0 1\n"
              "vt 0.5 1\n"
              "vt 1 1\n"
              "vt 0 0\n"
              "vt 0.5 0\n"
              "vt 1 0\n"
              "f 1/1 5/5 2/2\n"
              "f 1/1 4/4 5/5\n"
              "f 2/2 6/6 3/3\n"
              "f 2/2 5/5 6/6\n");
}

TEST(Obj, HasNineDigitsSoThatEveryFloatComesBack) {
    Document document = blank_document(1000, 700, 7);
    add_probe(document, {100, 200}, {130, 210}, 0.7);
    add_probe(document, {800, 600}, {-1.0 / 3, 1e-7}, -30);
    Deformation deformation;
    update(deformation, document);
    std::istringstream text(encode_obj(document, deformation));
    std::vector<glm::vec2> vertices;
    for (std::string line; std::getline(text, line);) {
        if (!line.starts_with("v ")) continue;
        char* rest = nullptr;
        const float x = std::strtof(line.c_str() + 2, &rest);
        vertices.emplace_back(x, std::strtof(rest, nullptr));
    }
    EXPECT_EQ(vertices, deformation.now);
}

}  // namespace
}  // namespace probewarp
