// Fuzzes the reading of the iPad program's CSV.
#include <cmath>
#include <cstdlib>
#include <memory>

#include "io/probes_csv.h"

namespace {

/// A document with a picture of 4 x 3 pixels.
probewarp::Document small_document() {
    probewarp::Picture picture;
    picture.image.width = 4;
    picture.image.height = 3;
    picture.image.rgba = std::vector<std::uint8_t>(4 * 3 * 4);
    probewarp::Document document;
    document.picture = std::make_shared<const probewarp::Picture>(std::move(picture));
    return document;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const probewarp::Document document = small_document();
    try {
        for (const probewarp::Probe& p :
             probewarp::decode_probes_csv({reinterpret_cast<const char*>(data), size}, document))
            if (p.id < 1 || !(p.radius > 0) || !std::isfinite(p.radius) || !std::isfinite(p.angle) ||
                !std::isfinite(p.rest.x + p.rest.y + p.now.x + p.now.y))
                std::abort();
    } catch (const probewarp::Error&) {
    }
    return 0;
}
