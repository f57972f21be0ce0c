#include "io/obj.h"

#include <fmt/format.h>

#include <iterator>

namespace probewarp {

std::string encode_obj(const Document& document, const Deformation& deformation) {
    const Image& image = document.picture->image;
    std::string text = "# Probewarp: x right, y down, in image pixels\n";
    auto out = std::back_inserter(text);
    for (const glm::vec2 v : deformation.now) fmt::format_to(out, "v {:.9g} {:.9g} 0\n", v.x, v.y);
    for (const glm::vec2 v : mesh_of(deformation).rest)
        fmt::format_to(out, "vt {:.9g} {:.9g}\n", v.x / float(image.width), 1.0f - v.y / float(image.height));
    const auto& t = mesh_of(deformation).triangles;
    for (std::size_t i = 0; i < t.size(); i += 3)
        fmt::format_to(out, "f {0}/{0} {1}/{1} {2}/{2}\n", t[i] + 1, t[i + 1] + 1, t[i + 2] + 1);
    return text;
}

}  // namespace probewarp
