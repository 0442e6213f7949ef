// Any bytes as a mesh file before it goes to its reader; the first says which format. Accepted, or a reason. The reader
// itself is no subject: a fault of assimp ends its process alone.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "config/mesh_check.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  static constexpr std::array<std::string_view, 6> kExtensions{".stl", ".obj", ".dae", ".ply", ".gltf", ".glb"};
  constexpr std::size_t kLargest = 16UL << 10U;
  if (size < 1 || size > kLargest) return 0;
  const std::string_view bytes{reinterpret_cast<const char*>(data) + 1, size - 1};
  const auto checked = check_mesh_bytes(bytes, kExtensions[data[0] % kExtensions.size()]);
  if (!checked) CELLMIRROR_EXPECTS(!checked.error().what.empty());
  constexpr std::size_t kMostBuffers = 16;
  const auto buffers = gltf_buffer_files(bytes, kMostBuffers);
  CELLMIRROR_EXPECTS(buffers.size() <= kMostBuffers);
  for (const auto& name : buffers) CELLMIRROR_EXPECTS(name.ends_with(".bin"));
  return 0;
}
