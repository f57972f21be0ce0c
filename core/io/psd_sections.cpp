// The sections of a Photoshop file before its merged picture: which mode and size, which channel is alpha,
// and what the file says about its colours and resolution.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "io/formats.h"
#include "io/psd_parts.h"

namespace probewarp {

namespace {

using std::string_view;

// ---- the header ----

struct ModeFacts {
    PsdMode mode;
    string_view name;
    std::size_t colours;      ///< channels; of multichannel at most
    std::array<int, 3> bits;  ///< that occur; 0: none
};

constexpr std::array<ModeFacts, 8> modes{{{PsdMode::bitmap, "bitmap", 1, {1, 0, 0}},
                                          {PsdMode::grey, "grey", 1, {8, 16, 32}},
                                          {PsdMode::indexed, "indexed", 1, {8, 0, 0}},
                                          {PsdMode::rgb, "RGB", 3, {8, 16, 32}},
                                          {PsdMode::cmyk, "CMYK", 4, {8, 16, 0}},
                                          {PsdMode::multichannel, "multichannel", 4, {8, 16, 0}},
                                          {PsdMode::duotone, "duotone", 1, {8, 16, 0}},
                                          {PsdMode::lab, "Lab", 3, {8, 16, 0}}}};

/// "a, b or c"
std::string alternatives(const std::vector<std::string>& words) {
    std::string all;
    for (std::size_t i = 0; i < words.size(); ++i)
        all += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
    return all;
}

const ModeFacts& facts_of(std::uint32_t mode, const std::string& label) {
    std::vector<std::string> names;
    for (const ModeFacts& facts : modes) {
        if (std::uint32_t(facts.mode) == mode) return facts;
        names.emplace_back(facts.name);
    }
    const std::string name = mode == 5   ? "in HSL mode"
                             : mode == 6 ? "in HSB mode"
                                         : "in mode " + std::to_string(mode) + ", which is unknown";
    throw Error("is a " + label + " " + name + "; expected " + alternatives(names));
}

void check_bits(int bits, const ModeFacts& facts, const std::string& label) {
    if (bits != 0 && std::find(facts.bits.begin(), facts.bits.end(), bits) != facts.bits.end()) return;
    std::vector<std::string> known;
    for (const int b : facts.bits)
        if (b != 0) known.push_back(std::to_string(b));
    throw Error("has " + std::to_string(bits) + " bits a channel in " + std::string(facts.name) +
                " mode; expected a " + label + " with " + alternatives(known));
}

Psd read_header(Bytes file) {
    if (file.size() < 26) throw truncated("PSD");
    const std::uint32_t version = be16(file, 4);
    if (version != 1 && version != 2)
        throw Error("is a PSD of version " + std::to_string(version) +
                    "; expected version 1 (PSD) or 2 (PSB)");
    Psd psd;
    psd.large = version == 2;
    psd.channels = be16(file, 12);
    psd.height = be32(file, 14);
    psd.width = be32(file, 18);
    psd.bits = int(be16(file, 22));
    const ModeFacts& facts = facts_of(be16(file, 24), psd.label());
    check_bits(psd.bits, facts, psd.label());
    check_image_size((long long)(psd.width), (long long)(psd.height), psd.bits > 8 ? 16 : 8);
    psd.mode = facts.mode;
    psd.colours = psd.mode == PsdMode::multichannel ? std::min(psd.channels, facts.colours) : facts.colours;
    if (psd.channels < std::max<std::size_t>(psd.colours, 1) || psd.channels > 56)
        throw damaged(psd.label(), "it has too few or too many channels");
    return psd;
}

// ---- lengths ----

std::uint64_t length_at(Bytes bytes, bool wide) {
    return wide ? std::uint64_t(be32(bytes, 0)) << 32 | be32(bytes, 4) : be32(bytes, 0);
}

/// The section that `rest` begins with, behind its length, which has 8 bytes if `wide` and else 4. `rest`
/// begins behind the section afterwards.
Bytes take_section(Bytes& rest, bool wide, const std::string& label) {
    const std::size_t number = wide ? 8 : 4;
    if (rest.size() < number) throw truncated(label);
    const std::uint64_t length = length_at(rest, wide);
    if (length > rest.size() - number) throw truncated(label);
    const Bytes section = rest.subspan(number, std::size_t(length));
    rest = rest.subspan(number + section.size());
    return section;
}

// ---- image resources ----

/// A fixed-point number of 16 bits before and 16 after the point. The unit beside it says only how
/// Photoshop shows it: the number is always per inch.
std::optional<Resolution> resolution_of(Bytes info) {
    if (info.size() < 16) return {};
    const auto per_metre = [&](std::size_t at) { return std::round(be32(info, at) / 65536.0 / 0.0254); };
    const double x = per_metre(0), y = per_metre(8);
    if (!is_resolution(x, y)) return {};
    return Resolution{std::uint32_t(x), std::uint32_t(y)};
}

/// The width of a pixel over its height, behind a version; 1 where that makes no sense.
double pixel_aspect(Bytes data) {
    if (data.size() < 12) return 1;
    const double aspect = std::bit_cast<double>(length_at(data.subspan(4), true));
    return aspect >= 0.01 && aspect <= 100 ? aspect : 1;
}

/// A pixel that is wider than high: more of them in a metre down than across. Where the file tells
/// different resolutions across and down already, they stand.
void apply_aspect(double aspect, Psd& psd) {
    if (psd.resolution) {
        const double down = std::round(psd.resolution->y * aspect);
        if (psd.resolution->x == psd.resolution->y && is_resolution(1, down))
            psd.resolution->y = std::uint32_t(down);
        return;
    }
    constexpr std::uint32_t across = 10000;
    const auto down = std::uint32_t(std::lround(across * aspect)), common = std::gcd(across, down);
    if (down != across) psd.aspect = Resolution{across / common, down / common};
}

/// ids: of the channels behind the colours, 4 bytes each. 0 is the merged picture's transparency.
void find_alpha(Bytes ids, Psd& psd) {
    for (std::size_t i = 0; i < ids.size() / 4; ++i)
        if (be32(ids, i * 4) == 0 && psd.colours + i < psd.channels) psd.alpha = psd.colours + i;
}

void read_resource(std::uint32_t id, Bytes data, double& aspect, Psd& psd) {
    switch (id) {
        case 1005:
            psd.resolution = resolution_of(data);
            break;
        case 1039:
            psd.icc = data;
            break;
        case 1047:
            if (psd.mode == PsdMode::indexed && data.size() >= 2 && be16(data, 0) < 256)
                psd.clear_index = std::uint8_t(be16(data, 0));
            break;
        case 1053:
            find_alpha(data, psd);
            break;
        case 1057:  // a version, and then whether the merged picture is real
            if (data.size() >= 5) psd.merged = u8(data, 4) != 0;
            break;
        case 1058:
            psd.exif = data;
            break;
        case 1064:
            aspect = pixel_aspect(data);
            break;
        default:
            break;
    }
}

/// Each has a signature, a number, a name with its length before it, and data with theirs; name and data
/// take an even number of bytes. A list that breaks off ends there: the picture does not hang on it.
void read_resources(Bytes list, Psd& psd) {
    double aspect = 1;
    while (list.size() >= 12) {
        const std::size_t name = (1 + u8(list, 6) + 1) / 2 * 2;
        if (list.size() < 6 + name + 4) break;
        const std::uint32_t id = be16(list, 4);
        list = list.subspan(6 + name);
        const std::size_t length = be32(list, 0);
        if (length > list.size() - 4) break;
        read_resource(id, list.subspan(4, length), aspect, psd);
        list = list.subspan(std::min(list.size(), 4 + (length + 1) / 2 * 2));
    }
    apply_aspect(aspect, psd);
}

// ---- layers ----

bool is_block(Bytes bytes) { return begins_with(bytes, "8BIM") || begins_with(bytes, "8B64"); }

/// In a PSB the lengths of these blocks, and of those marked by 8B64, have 8 bytes.
bool has_wide_length(Bytes block) {
    if (begins_with(block, "8B64")) return true;
    constexpr std::array<string_view, 15> keys{"LMsk", "Lr16", "Lr32", "Layr", "Mt16", "Mt32", "Mtrn", "Alph",
                                               "FMsk", "lnk2", "lnkE", "FEid", "FXid", "PxSD", "pths"};
    const string_view key(reinterpret_cast<const char*>(block.data()) + 4, 4);
    return std::find(keys.begin(), keys.end(), key) != keys.end();
}

int signed_16(Bytes bytes) { return std::int16_t(be16(bytes, 0)); }

/// Of files with 16 or 32 bits, which keep their layers in one of these blocks.
int layer_count_in_blocks(Bytes rest, bool large) {
    while (rest.size() >= 12 && is_block(rest)) {
        const bool wide = large && has_wide_length(rest);
        const bool layers = begins_with(rest.subspan(4), "Lr16") || begins_with(rest.subspan(4), "Lr32") ||
                            begins_with(rest.subspan(4), "Layr");
        const std::size_t head = wide ? 16 : 12;
        if (rest.size() < head) break;
        const std::uint64_t length = length_at(rest.subspan(8), wide);
        if (length > rest.size() - head) break;
        rest = rest.subspan(head);
        if (layers && length >= 2) return signed_16(rest);
        rest = rest.subspan(std::size_t(length));
        // Filled up to two bytes by some programs and to four by others.
        for (int i = 0; i < 3 && !rest.empty() && !is_block(rest); ++i) rest = rest.subspan(1);
    }
    return 0;
}

/// How many layers there are, negative where the first channel behind the colours is the merged picture's
/// transparency; 0 where nothing is said of layers.
int layer_count(Bytes section, bool large) {
    const std::size_t number = large ? 8 : 4;
    if (section.size() < number) return 0;
    const std::uint64_t length = length_at(section, large);
    section = section.subspan(number);
    if (length > section.size()) return 0;
    if (length >= 2 && signed_16(section) != 0) return signed_16(section);
    section = section.subspan(std::size_t(length));
    // The mask over all layers.
    if (section.size() < 4 || be32(section, 0) > section.size() - 4) return 0;
    return layer_count_in_blocks(section.subspan(4 + be32(section, 0)), large);
}

}  // namespace

Psd read_psd_sections(Bytes file) {
    Psd psd = read_header(file);
    Bytes rest = file.subspan(26);
    psd.palette = take_section(rest, false, psd.label());
    read_resources(take_section(rest, false, psd.label()), psd);
    const int layers = layer_count(take_section(rest, psd.large, psd.label()), psd.large);
    psd.layered = layers != 0;
    if (layers < 0 && psd.channels > psd.colours) psd.alpha = psd.colours;
    if (psd.mode == PsdMode::bitmap) psd.alpha.reset();
    if (rest.size() < 2) throw truncated(psd.label());
    psd.compression = be16(rest, 0);
    psd.rows = rest.subspan(2);
    return psd;
}

}  // namespace probewarp
