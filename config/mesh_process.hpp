// Reads a mesh file in a process of its own, cellmirror-mesh-reader: what a damaged file does there ends that process
// and nothing else. Blocks; any thread but the loop's, several at a time.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>

#include "config/mesh_message/mesh_message.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// Which program reads, and how long it may take from its start to the end of its answer.
struct MeshReader {
  std::filesystem::path program;
  // Its processor time is bounded to half of it (config/mesh_reader): a busy machine alone ends no reader.
  std::chrono::milliseconds longest{std::chrono::minutes(2)};
  std::size_t most_bytes = kLargestMeshAnswer;  // of its answer
};

// Beside the running program, where it is installed and where it is built.
[[nodiscard]] MeshReader installed_mesh_reader();

// The result is untrusted: see decode_mesh_answer(). Leaves neither a process nor a descriptor behind. Errors are parts
// of sentences: "its reader ended with signal 11 (SIGSEGV): the file is damaged".
[[nodiscard]] Result<ScenePolygons> read_mesh_apart(const MeshRequest& request,
                                                    const MeshReader& reader = installed_mesh_reader());

}  // namespace cellmirror
