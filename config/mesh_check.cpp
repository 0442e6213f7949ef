#include "config/mesh_check.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>

#include "rt_core/geometry/mesh_repair.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kStlHeader = 84;
constexpr std::size_t kStlTriangle = 50;

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = (value << 8U) | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

// Binary STL is told from ASCII by its size alone: files of both kinds begin with "solid".
Result<void> check_stl(std::string_view bytes) {
  const bool looks_ascii = bytes.starts_with("solid");
  if (bytes.size() >= kStlHeader) {
    const std::uint32_t count = little_endian(bytes, kStlHeader - 4);
    const std::size_t wanted = kStlHeader + kStlTriangle * std::size_t{count};
    if (bytes.size() == wanted && count > geometry::kMostTriangles) {
      return fail(fmt::format("it has {} triangles, more than {}", count, geometry::kMostTriangles), "reduce the mesh");
    }
    if (bytes.size() == wanted) return {};
    if (!looks_ascii) {
      return fail(
          fmt::format("it is no STL: {} triangles make {} bytes, but there are {}", count, wanted, bytes.size()),
          "export it anew");
    }
  }
  if (!looks_ascii) return fail("it is no STL");
  if (bytes.find("facet") == std::string_view::npos) return fail("there are no facets in it");
  return {};
}

}  // namespace

Result<void> check_mesh_bytes(std::string_view bytes, std::string_view extension) {
  if (bytes.empty()) return fail("it is empty");
  if (extension == ".stl") return check_stl(bytes);
  return {};
}

}  // namespace cellmirror
