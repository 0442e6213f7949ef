// What can be said about the bytes of a mesh file before they go to assimp: it believes some numbers in files. Private
// to this folder.
#pragma once

#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror {

[[nodiscard]] Result<void> check_mesh_bytes(std::string_view bytes, std::string_view extension);

// Parts of it.
[[nodiscard]] Result<void> check_dae(std::string_view bytes);
[[nodiscard]] Result<void> check_gltf(std::string_view text);
[[nodiscard]] Result<void> check_glb(std::string_view bytes);

}  // namespace cellmirror
