// Fuzzes the reading of projects. The first byte says how: bit 0 takes the rest for a project.json and puts
// it into a sound ZIP archive, so that the JSON is reached; otherwise the rest is the archive, whose
// checksums are put right with bit 1.
#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "io/paint_file.h"
#include "io/project.h"
#include "io/zip_archive.h"
#include "model/paint_ops.h"

namespace {

using Bytes = std::vector<std::byte>;

Bytes to_bytes(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

/// With the paint that the text speaks of, as a member that nobody names is refused.
Bytes enveloped(std::span<const std::byte> json) {
    std::vector<probewarp::ZipMember> members{{"mimetype", to_bytes(probewarp::project_mimetype), true},
                                              {"project.json", {json.begin(), json.end()}, true},
                                              {"image.ppm", to_bytes("P6 2 2 255\nabcdefghijkl"), true}};
    static const Bytes paint =
        probewarp::encode_paint(probewarp::filled(probewarp::new_paint_map(2, 2), 0.5f));
    const std::string_view text(reinterpret_cast<const char*>(json.data()), json.size());
    for (const char* name : {"paint/1.png", "stiffness.png"})
        if (text.find(name) != std::string_view::npos) members.push_back({name, paint, true});
    return probewarp::write_zip(members);
}

std::size_t little_endian(const Bytes& bytes, std::size_t at, std::size_t count) {
    std::size_t value = 0;
    for (std::size_t i = count; i-- > 0;) value = value << 8 | std::to_integer<std::size_t>(bytes[at + i]);
    return value;
}

/// The CRCs of stored members, in their own headers and in the directory.
void repair_zip(Bytes& bytes) {
    const auto put = [&](std::size_t at, uLong crc) {
        for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = std::byte(crc >> (8 * i) & 255);
    };
    for (std::size_t at = 0; at + 46 <= bytes.size(); ++at) {
        if (std::memcmp(bytes.data() + at, "PK\1\2", 4) != 0) continue;
        const std::size_t packed = little_endian(bytes, at + 20, 4),
                          header = little_endian(bytes, at + 42, 4);
        if (header > bytes.size() || bytes.size() - header < 30) continue;
        const std::size_t start =
            header + 30 + little_endian(bytes, header + 26, 2) + little_endian(bytes, header + 28, 2);
        if (start > bytes.size() || packed > bytes.size() - start || little_endian(bytes, at + 10, 2) != 0)
            continue;
        const uLong crc = crc32(0, reinterpret_cast<const Bytef*>(bytes.data() + start), uInt(packed));
        put(at + 16, crc);
        put(header + 14, crc);
    }
}

/// What decode_project promises; and that the document can be saved and comes back the same.
void check(const probewarp::Document& document) {
    if (!document.picture || document.mesh.cells < 1) std::abort();
    std::set<int> ids;
    for (const probewarp::Probe& p : document.probes)
        if (!ids.insert(p.id).second || p.id < 1 || !(p.radius > 0) || !std::isfinite(p.radius) ||
            !std::isfinite(p.angle) || !std::isfinite(p.rest.x + p.rest.y + p.now.x + p.now.y))
            std::abort();
    const auto fits = [](const probewarp::PaintPtr& paint) {
        return !paint ||
               (paint->width > 0 && paint->height > 0 && paint->extent.x > 0 && paint->extent.y > 0 &&
                paint->tiles.size() ==
                    std::size_t((paint->width + 63) / 64) * std::size_t((paint->height + 63) / 64));
    };
    if (!fits(document.stiffness)) std::abort();
    for (const probewarp::Probe& p : document.probes)
        if (!fits(p.paint)) std::abort();
    const Bytes once = probewarp::encode_project(document);
    if (probewarp::encode_project(probewarp::decode_project(once, "again")) != once) std::abort();
}

void check(const probewarp::Error& error) {
    if (std::strncmp(error.what(), "fuzz: ", 6) != 0 && std::strchr(error.what(), '\n')) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const auto* first = reinterpret_cast<const std::byte*>(data);
    Bytes bytes(first + 1, first + size);
    if (data[0] & 1)
        bytes = enveloped(bytes);
    else if (data[0] & 2)
        repair_zip(bytes);
    try {
        check(probewarp::decode_project(bytes, "fuzz"));
    } catch (const probewarp::Error& error) {
        check(error);
    }
    return 0;
}
