#include "io/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <span>

#include "io/file.h"
#include "io/formats.h"
#include "io/lower_case.h"
#include "io/printable.h"

namespace probewarp {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view material = "picture";

/// The first line of a material's file, by which it is known again.
std::string mtl_signature(const fs::path& obj) {
    return fmt::format("# Probewarp: the material of {}\n", printable(obj.filename().string()));
}

/// A name that needs no quotes, which OBJ has not: '#' begins a comment there, '\' joins lines, and '-'
/// before a texture's name begins an option.
std::string plain_name(std::string name) {
    const auto is_taken_apart = [](char c) {
        return static_cast<unsigned char>(c) <= ' ' || c == 0x7f || c == '#' || c == '\\' || c == '"';
    };
    std::ranges::replace_if(name, is_taken_apart, '_');
    if (name.starts_with('-')) name[0] = '_';
    return name;
}

}  // namespace

bool is_obj(const fs::path& path) { return lower_ending(path) == ".obj"; }

std::string encode_obj(const Deformation& deformation, std::string_view material_file) {
    const Mesh& mesh = mesh_of(deformation);
    std::string text = "# Probewarp: x right, y up, in image pixels from the picture's lower left corner\n";
    auto out = std::back_inserter(text);
    if (!material_file.empty()) fmt::format_to(out, "mtllib {}\n", material_file);
    for (const glm::vec2 v : deformation.now)
        fmt::format_to(out, "v {:.9g} {:.9g} 0\n", v.x, mesh.size.y - double(v.y));
    for (const glm::vec2 v : mesh.rest)
        fmt::format_to(out, "vt {:.9g} {:.9g}\n", double(v.x) / mesh.size.x, 1 - double(v.y) / mesh.size.y);
    if (!material_file.empty()) fmt::format_to(out, "usemtl {}\n", material);
    // The mesh's triangles turn from y towards x, y down: which is from x towards y once y is up.
    const auto& t = mesh.triangles;
    for (std::size_t i = 0; i < t.size(); i += 3)
        fmt::format_to(out, "f {0}/{0} {1}/{1} {2}/{2}\n", t[i] + 1, t[i + 1] + 1, t[i + 2] + 1);
    return text;
}

std::string encode_mtl(const Deformation& deformation, const fs::path& obj, std::string_view texture_file) {
    // Illumination model 0: the colour as it is, without a light.
    std::string text = fmt::format("{}newmtl {}\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nd 1\nillum 0\nmap_Kd {}\n",
                                   mtl_signature(obj), material, texture_file);
    if (has_alpha(deformation.source.picture->image)) text += fmt::format("map_d {}\n", texture_file);
    return text;
}

ObjCompanions obj_companions(const fs::path& obj) {
    const std::string name = plain_name(obj.stem().string());
    return {obj.parent_path() / (name + ".mtl"), obj.parent_path() / (name + "-texture.png")};
}

std::vector<fs::path> obj_files(const fs::path& obj) {
    const ObjCompanions companions = obj_companions(obj);
    return {companions.texture, companions.material, obj};
}

namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

bool is_there(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(fs::symlink_status(path, ignored));
}

/// Whether the file begins so; not where it cannot be read.
bool begins_so(const fs::path& path, std::span<const std::byte> beginning) {
    try {
        const auto bytes = read_file(path);
        return bytes.size() >= beginning.size() &&
               std::equal(beginning.begin(), beginning.end(), bytes.begin());
    } catch (const Error&) {
        return false;
    }
}

/// A texture is ours where the material beside it is, or where it is what would be written.
void check_companions(const ObjContents& contents) {
    const ObjCompanions companions = obj_companions(contents.obj);
    const bool material_is_ours = begins_so(companions.material, bytes_of(mtl_signature(contents.obj)));
    const auto refuse = [&](const fs::path& path) {
        throw Error(fmt::format(
            "{}: would be written with {}, but is there already and did not come with it; expected another "
            "name for the OBJ file",
            path.string(), contents.obj.filename().string()));
    };
    if (companions.material == contents.obj)
        throw Error(fmt::format("{}: its material would have this name; expected one that ends with .obj",
                                contents.obj.string()));
    if (is_there(companions.material) && !material_is_ours) refuse(companions.material);
    if (is_there(companions.texture) && !material_is_ours &&
        !begins_so(companions.texture, contents.files[0]))
        refuse(companions.texture);
}

}  // namespace

ObjContents obj_contents(const fs::path& obj, const Deformation& deformation) {
    const ObjCompanions companions = obj_companions(obj);
    const auto name = [](const fs::path& path) { return path.filename().string(); };
    return {obj,
            {encode_png(deformation.source.picture->image, {}),
             bytes_of(encode_mtl(deformation, obj, name(companions.texture))),
             bytes_of(encode_obj(deformation, name(companions.material)))}};
}

void write_obj(const ObjContents& contents) {
    check_companions(contents);
    const std::vector<fs::path> paths = obj_files(contents.obj);
    // Nothing is seen of any before there was room for all. The OBJ comes first, so that an error names it.
    std::vector<std::unique_ptr<FileWriter>> writers(paths.size());
    for (std::size_t i = paths.size(); i-- > 0;) {
        writers[i] = std::make_unique<FileWriter>(paths[i]);
        writers[i]->write(contents.files[i]);
    }
    for (const auto& writer : writers) writer->finish();
}

}  // namespace probewarp
