// Colours and textures of an OBJ's material files (.mtl). Read by our own code, not by assimp. Private to this folder.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"

namespace cellmirror {

struct ObjMaterial {
  std::array<float, 3> rgb{1, 1, 1};  // Kd
  std::string picture;                // map_Kd; empty: none
  std::string place;                  // "FILE:LINE" of map_Kd
};
using ObjMaterials = std::map<std::string, ObjMaterial, std::less<>>;

// The names that the lines "mtllib" of an OBJ give, each once.
[[nodiscard]] std::vector<std::string> material_files(std::string_view obj);

// Adds the materials of a file; of those with one name the first counts. Options of map_Kd are passed over.
void read_obj_materials(std::string_view text, const std::string& file, ObjMaterials& materials);

}  // namespace cellmirror
