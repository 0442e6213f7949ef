#include "config/msh/tetra_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

namespace cellmirror::msh {

namespace {

using Corners = std::array<std::uint32_t, 3>;

struct Face {
  Corners sorted{};
  Corners outward{};  // counter-clockwise from outside of its tetrahedron
  // Whether `outward` is `sorted`, turned in a circle at most: so it is on one side of the face.
  [[nodiscard]] bool forwards() const {
    const auto least = static_cast<std::size_t>(std::ranges::min_element(outward) - outward.begin());
    return outward[(least + 1) % 3] < outward[(least + 2) % 3];
  }
};

// Opposite to corner i of a tetrahedron with positive volume.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

std::vector<Face> faces_of(const tissue::TetraMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tetrahedra.size());
  for (const auto& corners : mesh.tetrahedra) {
    for (const auto& [a, b, c] : kFaces) {
      Face face;
      face.outward = {corners[a], corners[b], corners[c]};
      face.sorted = face.outward;
      std::ranges::sort(face.sorted);
      faces.push_back(face);
    }
  }
  std::ranges::sort(faces, {}, &Face::sorted);
  return faces;
}

std::string place_of(const Eigen::Vector3d& p) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}] m", p.x(), p.y(), p.z());
}

}  // namespace

Result<tissue::SurfaceMesh> surface_of(const tissue::TetraMesh& mesh) {
  constexpr auto kNotUsed = std::numeric_limits<std::uint32_t>::max();
  tissue::SurfaceMesh surface;
  std::vector<std::uint32_t> used(mesh.nodes.size(), kNotUsed);
  const std::vector<Face> faces = faces_of(mesh);
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].sorted == faces[i].sorted) ++end;
    const bool overlap = end - i == 2 && faces[i].forwards() == faces[i + 1].forwards();
    if (end - i > 2 || overlap) {
      const std::string place = place_of(mesh.nodes[faces[i].sorted[0]]);
      return fail(overlap ? fmt::format("two tetrahedra with a common face near {} overlap", place)
                          : fmt::format("a face near {} belongs to {} tetrahedra", place, end - i),
                  "remesh the volume and export the mesh again");
    }
    if (end - i == 1) {
      Corners corners = faces[i].outward;
      for (std::uint32_t& corner : corners) {
        std::uint32_t& to = used[corner];
        if (to == kNotUsed) {
          to = static_cast<std::uint32_t>(surface.vertices.size());
          surface.vertices.push_back(mesh.nodes[corner]);
        }
        corner = to;
      }
      surface.triangles.push_back(corners);
    }
    i = end;
  }
  return surface;
}

}  // namespace cellmirror::msh
