// The deformed mesh as a Wavefront OBJ, with the material and the texture that it comes with.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "model/deformation.h"
#include "model/error.h"

namespace probewarp {

/// The mesh as others expect it: x right, y up, in image pixels from the picture's lower left corner, z = 0;
/// texture coordinates with v up; triangles whose front is towards +z unless they are folded. Vertices are in
/// the mesh's order, with nine significant digits. material_file: what holds the material; empty: there is
/// none, as on standard output
std::string encode_obj(const Deformation& deformation, std::string_view material_file = {});

/// The material of the mesh, which shows the texture as it is, its alpha included.
std::string encode_mtl(const Deformation& deformation, const std::filesystem::path& obj,
                       std::string_view texture_file);

/// By the path's ending, in any case.
bool is_obj(const std::filesystem::path& path);

/// What is written beside an OBJ, of the same name: NAME.mtl and NAME-texture.png, the undeformed picture. A
/// picture called NAME.png is thus never in the way. Spaces and what else readers of OBJ take apart become
/// '_' in these names.
struct ObjCompanions {
    std::filesystem::path material, texture;
};
ObjCompanions obj_companions(const std::filesystem::path& obj);

/// The OBJ's file and what comes with it, in the order in which they are written: the OBJ last, so that it
/// never names what is not there.
std::vector<std::filesystem::path> obj_files(const std::filesystem::path& obj);

/// The bytes of obj_files, in their order.
struct ObjContents {
    std::filesystem::path obj;
    std::vector<std::vector<std::byte>> files;
};

/// Requires a whole picture. Throws Error.
ObjContents obj_contents(const std::filesystem::path& obj, const Deformation& deformation);

/// Writes them, each as write_file does, and none where there is no room for all. Throws Error, before
/// anything is written, where a companion would replace a file that was not written with an OBJ of this name.
void write_obj(const ObjContents& contents);

}  // namespace probewarp
