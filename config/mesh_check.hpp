// What can be said about the bytes of a mesh file before they go to its reader, which can only say less: assimp
// believes some numbers in files. Private to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"

namespace cellmirror {

// `extension` with its dot, in lower case. Any bytes.
[[nodiscard]] Result<void> check_mesh_bytes(std::string_view bytes, std::string_view extension);

// Parts of it.
[[nodiscard]] Result<void> check_dae(std::string_view bytes);
[[nodiscard]] Result<void> check_gltf(std::string_view text);
[[nodiscard]] Result<void> check_glb(std::string_view bytes);

// The buffer files named by a glTF, each once, verbatim; only .bin, and at most `most`.
[[nodiscard]] std::vector<std::string> gltf_buffer_files(std::string_view text, std::size_t most);

}  // namespace cellmirror
