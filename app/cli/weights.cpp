// `probewarp weights`: each probe's weights as a picture of its own, and such pictures back in as paint.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/output_kinds.h"
#include "cli/printing.h"
#include "io/file.h"
#include "io/paint_file.h"
#include "io/printable.h"
#include "io/project.h"
#include "io/same_file.h"
#include "model/share_lookup.h"

namespace probewarp {

namespace {

constexpr std::size_t raster_bytes = std::size_t{256} << 20;  // that the weights of one group may take

/// "NAME=FILE.png", understood.
struct Import {
    std::size_t probe = 0;  ///< its place in the document
    std::string path;
};

Import parse_import(const Document& document, const std::string& text) {
    std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        throw UsageError(fmt::format("--import {}: expected NAME=FILE.png", text));
    // A name may have an equals sign in it itself.
    for (std::size_t at = equals; at != std::string::npos; at = text.find('=', at + 1))
        if (find_probe_named(document, text.substr(0, at))) equals = at;
    return {probe_named(document, text.substr(0, equals), "--import"), text.substr(equals + 1)};
}

/// Paints a probe with a map from elsewhere.
void import_paint(Document& document, const Import& import) {
    const auto bytes = read_file(import.path);
    const PictureFrame frame = frame_of(document.picture->image);
    try {
        auto map = decode_paint(bytes, 2.0 * frame.centre / frame.longer);
        document.probes[import.probe].paint =
            is_blank(map) ? nullptr : std::make_shared<const PaintMap>(std::move(map));
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", import.path, error.what()));
    }
}

std::array<int, 2> size_of(const WeightsOptions& o, const Image& image) {
    if (o.size.empty()) return {image.width, image.height};
    const auto [width, height] = parse_size(o.size);
    constexpr std::size_t most = max_image_bytes / 4;
    if (width > max_image_side || height > max_image_side || std::size_t(width) * std::size_t(height) > most)
        throw UsageError(fmt::format("--size {}: at most {} pixels along a side and {} million in all fit",
                                     o.size, max_image_side, most / 1'000'000));
    return {width, height};
}

/// Whether the character is a letter, digit, '-' or '_' that every file system takes: of those beyond ASCII
/// the scripts without their punctuation, symbols and signs that cannot be seen.
bool fits_in_name(std::string_view character) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
    if (character.size() == 1)
        return (byte(0) < 0x80 && std::isalnum(byte(0))) || character == "-" || character == "_";
    if (character.size() > 3) return false;
    unsigned code = byte(0) & (character.size() == 2 ? 0x1Fu : 0x0Fu);
    for (std::size_t i = 1; i < character.size(); ++i) code = code << 6 | (byte(i) & 0x3Fu);
    const auto within = [code](unsigned first, unsigned last) { return code >= first && code <= last; };
    return (within(0xC0, 0x1FFF) && code != 0xD7 && code != 0xF7) || within(0x3041, 0xD7A3) ||
           within(0xF900, 0xFAFF);
}

/// "01-Head.png": the number from 1, of as many digits as the last one has, at least two.
std::string file_name(const Document& document, std::size_t probe) {
    constexpr std::size_t longest = 150;  // bytes; file systems take 255
    std::string name;
    const std::string text = printable(document.probes[probe].name);
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i + 1;
        while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) ++end;
        const std::string_view character = std::string_view(text).substr(i, end - i);
        if (name.size() + character.size() > longest) break;
        name += fits_in_name(character) ? character : "_";
        i = end;
    }
    const std::size_t digits = std::max<std::size_t>(2, std::to_string(document.probes.size()).size());
    return fmt::format("{:0{}}-{}.png", probe + 1, digits, name);
}

void write_weights(const Document& document, const WeightsOptions& o, std::array<int, 2> size) {
    Deformation deformation;
    update(deformation, document);
    const std::filesystem::path folder = o.output;
    make_folder(folder);
    const auto [width, height] = size;
    const std::size_t one = std::size_t(width) * std::size_t(height) * sizeof(std::uint16_t);
    const std::size_t group = std::max<std::size_t>(1, raster_bytes / one);
    for (std::size_t first = 0; first < document.probes.size(); first += group) {
        std::vector<std::size_t> probes;
        for (std::size_t i = first; i < std::min(first + group, document.probes.size()); ++i)
            probes.push_back(i);
        const auto images = weight_images(deformation, probes, width, height);
        for (std::size_t k = 0; k < probes.size(); ++k) {
            const std::filesystem::path path = folder / file_name(document, probes[k]);
            write_file(path, encode_grey_png(width, height, images[k]));
            if (!o.quiet) print("{}\n", printable(path.string()));
        }
    }
}

/// Refuses to write over what is read, before anything is written.
void check_weights_files(const Document& document, const WeightsOptions& o, std::span<const Import> imports) {
    std::vector<UsedFile> read{{"the input itself", o.input}}, written;
    for (const Import& import : imports)
        read.push_back({fmt::format("the map of --import, {}", import.path), import.path});
    if (!o.save.empty()) written.push_back({"--save " + o.save, o.save});
    for (std::size_t i = 0; i < document.probes.size() && !o.output.empty(); ++i) {
        const std::filesystem::path path = std::filesystem::path(o.output) / file_name(document, i);
        written.push_back({path.string(), path});
    }
    check_files(read, written);
}

}  // namespace

void weights(const WeightsOptions& o) {
    if (o.output.empty() && o.save.empty())
        throw UsageError("weights: nothing would be written; expected -o FOLDER or --save FILE.probewarp");
    check_options(o);
    if (!o.save.empty() && !is_project_path(o.save))
        throw UsageError(
            fmt::format("--save {}: expected a name that ends with {}", o.save, project_extension));
    Document document = read_document(o.input, Pixels::whole, {.salvage = o.salvage});
    apply(o, document);
    const auto size = size_of(o, document.picture->image);
    if (document.probes.empty())
        throw Error(
            fmt::format("{}: there are no probes, so there are no weights; expected a project with "
                        "probes, or --probe",
                        o.input));
    std::vector<Import> imports;
    for (const std::string& text : o.imports) imports.push_back(parse_import(document, text));
    check_weights_files(document, o, imports);
    for (const Import& import : imports) import_paint(document, import);
    if (!o.save.empty()) write_file(o.save, encode_project(document));
    if (!o.output.empty()) write_weights(document, o, size);
}

}  // namespace probewarp
