// Small pictures and documents for the tests, and a way to see what an Error says.
#pragma once

#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "model/deformation.h"
#include "model/error.h"

namespace probewarp::testing {

/// A picture of that size without a file behind it: enough for everything but saving.
inline PicturePtr blank_picture(int width, int height) {
    Picture picture;
    picture.image.width = width;
    picture.image.height = height;
    picture.name = "blank.png";
    picture.format = "png";
    return std::make_shared<const Picture>(std::move(picture));
}

inline Document blank_document(int width, int height, int cells = default_cells) {
    Document document;
    document.picture = blank_picture(width, height);
    document.mesh.cells = cells;
    return document;
}

/// Puts a probe down, then moves and turns it.
inline Probe& add_probe(Document& document, glm::dvec2 rest, glm::dvec2 now, double angle = 0,
                        double radius = 100) {
    Probe probe = new_probe(document, rest);
    probe.now = now;
    probe.angle = angle;
    probe.radius = radius;
    document.probes.push_back(probe);
    return document.probes.back();
}

/// Whether both have the same texels, in tiles that are null at the same places.
inline bool same_paint(const PaintMap& a, const PaintMap& b) {
    if (a.width != b.width || a.height != b.height || a.extent != b.extent ||
        a.tiles.size() != b.tiles.size())
        return false;
    for (std::size_t i = 0; i < a.tiles.size(); ++i) {
        const PaintTile *one = a.tiles[i].get(), *other = b.tiles[i].get();
        if (!one != !other) return false;
        if (one && (one->value != other->value || one->coverage != other->coverage)) return false;
    }
    return true;
}

inline constexpr double degrees = std::numbers::pi / 180;

/// What a call has to say about its Error; "" where there was none. Any other exception goes on.
template <class Call>
std::string error_of(const Call& call) {
    try {
        call();
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

}  // namespace probewarp::testing
