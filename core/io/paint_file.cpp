#include "io/paint_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "io/formats.h"
#include "io/png_chunks.h"

namespace probewarp {

std::vector<std::byte> encode_grey_png(int width, int height, std::span<const std::uint16_t> grey) {
    return encode_png_samples(width, height, 1, grey);
}

std::vector<std::byte> encode_paint(const PaintMap& map) {
    const std::size_t width = std::size_t(map.width), height = std::size_t(map.height);
    std::vector<std::uint16_t> samples(width * height * 2);
    for_each_tile(map, 0, 0, map.width, map.height, [&](const TileRect& rect) {
        const PaintTile* tile = map.tiles[rect.tile].get();
        if (!tile) return;
        for (int y = rect.top; y < rect.bottom; ++y)
            for (int x = rect.left; x < rect.right; ++x) {
                const std::size_t from = TileRect::at(x, y), to = std::size_t(y) * width + std::size_t(x);
                samples[to * 2] = tile->value[from];
                samples[to * 2 + 1] = tile->coverage[from];
            }
    });
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
    // Without its end a picture opens; our own files always have it.
    if (!survey_png(bytes).has_end) throw truncated("PNG");
    const Image image = decode_png(bytes, {});
    PaintMap map = empty_paint_map(image.width, image.height, extent);
    std::map<Texel, std::shared_ptr<const PaintTile>> uniform;  // tiles of one value, each made once
    const auto tile_of = [&](const auto& rgba, const TileRect& rect) -> std::shared_ptr<const PaintTile> {
        auto tile = blank_tile();
        const auto texel = [&](int x, int y) {
            return texel_of(rgba.data() + (std::size_t(y) * std::size_t(map.width) + std::size_t(x)) * 4);
        };
        const Texel first = texel(rect.left, rect.top);
        bool same = true;
        for (int y = rect.top; y < rect.bottom; ++y)
            for (int x = rect.left; x < rect.right; ++x) {
                const Texel here = texel(x, y);
                same = same && here == first;
                tile->value[TileRect::at(x, y)] = here.value;
                tile->coverage[TileRect::at(x, y)] = here.coverage;
            }
        if (!same) return tile;
        if (first.coverage == 0) return nullptr;
        const int area = (rect.right - rect.left) * (rect.bottom - rect.top);
        if (std::size_t(area) < texels_a_tile) return tile;  // at the edge a tile is not full
        auto& shared = uniform[first];
        if (!shared) shared = tile;
        return shared;
    };
    for_each_tile(map, 0, 0, map.width, map.height, [&](const TileRect& rect) {
        map.tiles[rect.tile] = std::visit([&](const auto& rgba) { return tile_of(rgba, rect); }, image.rgba);
    });
    return map;
}

std::size_t painted_texels(const PaintMap& map) {
    std::set<const PaintTile*> tiles;
    for (const auto& tile : map.tiles)
        if (tile) tiles.insert(tile.get());
    return tiles.size() * texels_a_tile;
}

void PaintBudget::check() const {
    constexpr std::size_t most_texels = std::size_t{1} << 28, most_painted = std::size_t{1} << 27;
    for (const auto& [taken, most] : {std::pair{texels, most_texels}, {painted, most_painted}})
        if (taken > most)
            throw Error(fmt::format("the paint takes {} million texels; expected at most {} million",
                                    taken / 1000000, most / 1000000));
}

PaintMap decode_paint(std::span<const std::byte> bytes, glm::dvec2 extent, PaintBudget& budget) {
    budget.texels += paint_texels(bytes);
    budget.check();  // before anything is allocated
    PaintMap map = decode_paint(bytes, extent);
    budget.painted += painted_texels(map);
    budget.check();
    return map;
}

}  // namespace probewarp
