// Any bytes as a mesh file, given to its reader in the process of its own; the first byte says which format, and
// whether looks are wanted. Whatever assimp does with them there: a mesh whose numbers fit together or a reason comes
// back, in time, and no process and no descriptor is left behind. What this process leaves to the reader is what
// check_mesh_bytes() lets through; the others go there too, since the reader has to stand on its own.
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "config/mesh_process.hpp"
#include "ipc/sandbox/child_process.hpp"
#include "rt_core/base/contract.hpp"

namespace {

using namespace cellmirror;

std::size_t open_descriptors() {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
    count += entry.path().empty() ? 0U : 1U;
  return count;
}

MeshReader reader() {
  MeshReader made = installed_mesh_reader();
  if (const char* folder = std::getenv("CELLMIRROR_BIN_DIR")) {
    made.program = std::filesystem::path(folder) / "cellmirror-mesh-reader";
  }
  made.longest = std::chrono::seconds(3);  // well below the time-out of an input, 5 s, on a busy machine too
  CELLMIRROR_EXPECTS(check_program(made.program).has_value());
  return made;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::array<std::string_view, 6> kExtensions{".stl", ".obj", ".dae", ".ply", ".gltf", ".glb"};
  static const MeshReader mesh_reader = reader();
  constexpr std::size_t kLargest = 16UL << 10U;
  if (size < 1 || size > kLargest) return 0;
  const std::size_t descriptors = open_descriptors();
  MeshRequest request;
  request.extension = kExtensions[data[0] % kExtensions.size()];
  request.with_looks = data[0] / kExtensions.size() % 2 == 1;
  request.bytes = {reinterpret_cast<const char*>(data) + 1, size - 1};
  const auto read = read_mesh_apart(request, mesh_reader);
  if (!read) CELLMIRROR_EXPECTS(!read.error().what.empty() && read.error().what.size() < 2000);
  CELLMIRROR_EXPECTS(open_descriptors() == descriptors);
  CELLMIRROR_EXPECTS(waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD);
  return 0;
}
