// Binary STL, as far as tests need it.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror {

// Null where the file is no binary STL.
inline std::shared_ptr<const geometry::TriangleMesh> read_stl(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  constexpr std::size_t kHeader = 84;
  constexpr std::size_t kRecord = 50;
  if (bytes.size() < kHeader) return nullptr;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  if (count == 0 || bytes.size() != kHeader + kRecord * count) return nullptr;
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (std::uint32_t i = 0; i < count; ++i) {
    float corners[9];
    std::memcpy(corners, bytes.data() + kHeader + kRecord * i + 12, sizeof corners);
    for (int k = 0; k < 3; ++k) mesh->vertices.emplace_back(corners[3 * k], corners[3 * k + 1], corners[3 * k + 2]);
    mesh->triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

}  // namespace cellmirror
