#include "io/paint_file.h"

#include <algorithm>
#include <map>
#include <set>
#include <variant>

#include "io/formats.h"

namespace probewarp {

std::vector<std::byte> encode_grey_png(int width, int height, std::span<const std::uint16_t> grey) {
    return encode_png_samples(width, height, 1, grey);
}

std::vector<std::byte> encode_paint(const PaintMap& map) {
    const std::size_t width = std::size_t(map.width), height = std::size_t(map.height);
    const std::size_t side = paint_tile_side, across = (width + side - 1) / side;
    std::vector<std::uint16_t> samples(width * height * 2);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const PaintTile* tile = map.tiles[y / side * across + x / side].get();
            if (!tile) continue;
            const std::size_t at = y % side * side + x % side;
            samples[(y * width + x) * 2] = tile->value[at];
            samples[(y * width + x) * 2 + 1] = tile->coverage[at];
        }
    return encode_png_samples(map.width, map.height, 2, samples);
}

namespace {

struct Texel {
    std::uint16_t value, coverage;
    friend auto operator<=>(const Texel&, const Texel&) = default;
};

/// Not in the generic code below: clang 14 forgets its destructor there.
std::shared_ptr<PaintTile> blank_tile() { return std::make_shared<PaintTile>(); }

template <class Sample>
Texel texel_of(const Sample* rgba) {
    constexpr unsigned scale = sizeof(Sample) == 1 ? 257 : 1;
    const unsigned sum = (unsigned(rgba[0]) + rgba[1] + rgba[2]) * scale;
    const auto coverage = std::uint16_t(rgba[3] * scale);
    return {coverage == 0 ? std::uint16_t{0} : std::uint16_t((sum + 1) / 3), coverage};
}

}  // namespace

std::size_t paint_texels(std::span<const std::byte> bytes) {
    constexpr std::size_t header = 8 + 8 + 13;  // signature, the chunk's length and type, IHDR
    if (bytes.size() < header || !find_image_format("png")->recognise(bytes) || u8(bytes, 24) != 16)
        throw Error("is no 16-bit PNG; expected a map of paint");
    return std::size_t(be32(bytes, 16)) * be32(bytes, 20);
}

PaintMap decode_paint(std::span<const std::byte> bytes, glm::dvec2 extent) {
    if (!find_image_format("png")->recognise(bytes)) throw Error("is no PNG; expected a 16-bit grey one");
    const Image image = decode_png(bytes);
    PaintMap map;
    map.width = image.width;
    map.height = image.height;
    map.extent = extent;
    constexpr int side = paint_tile_side;
    const int across = (map.width + side - 1) / side, down = (map.height + side - 1) / side;
    std::map<Texel, std::shared_ptr<const PaintTile>> uniform;  // tiles of one value, each made once
    const auto tile_at = [&](const auto& rgba, int left, int top) -> std::shared_ptr<const PaintTile> {
        auto tile = blank_tile();
        const int right = std::min(left + side, map.width), bottom = std::min(top + side, map.height);
        const auto texel = [&](int x, int y) {
            return texel_of(rgba.data() + (std::size_t(y) * std::size_t(map.width) + std::size_t(x)) * 4);
        };
        const Texel first = texel(left, top);
        bool same = true;
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) {
                const Texel here = texel(x, y);
                same = same && here == first;
                tile->value[std::size_t((y - top) * side + x - left)] = here.value;
                tile->coverage[std::size_t((y - top) * side + x - left)] = here.coverage;
            }
        if (!same) return tile;
        if (first.coverage == 0) return nullptr;
        if (right - left < side || bottom - top < side) return tile;  // at the edge a tile is not full
        auto& shared = uniform[first];
        if (!shared) shared = tile;
        return shared;
    };
    for (int y = 0; y < down; ++y)
        for (int x = 0; x < across; ++x)
            map.tiles.push_back(
                std::visit([&](const auto& rgba) { return tile_at(rgba, x * side, y * side); }, image.rgba));
    return map;
}

std::size_t painted_texels(const PaintMap& map) {
    std::set<const PaintTile*> tiles;
    for (const auto& tile : map.tiles)
        if (tile) tiles.insert(tile.get());
    return tiles.size() * std::size_t{paint_tile_side} * paint_tile_side;
}

}  // namespace probewarp
