// Any bytes as the answer of the reader of meshes, which a mesh file may have taken over; the first says of which
// format the file is and whether looks were wanted. A mesh that is fit for geometry, or a reason; its hull and convex
// parts, where it has them, are convex; its look fits it. Material files hold the same bytes.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "config/mesh_appearance.hpp"
#include "config/mesh_finish.hpp"
#include "config/mesh_message/mesh_message.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/geometry/convex/convex_hull.hpp"
#include "rt_core/geometry/convex/convex_parts.hpp"

namespace {

using namespace cellmirror;

void check_look(const MeshAppearance& look, const geometry::TriangleMesh& mesh) {
  CELLMIRROR_EXPECTS(look.materials.size() == mesh.triangles.size());
  CELLMIRROR_EXPECTS(look.places.size() == 3 * mesh.triangles.size());
  CELLMIRROR_EXPECTS(look.colours.empty() || look.colours.size() == look.places.size());
  for (const std::uint16_t material : look.materials) CELLMIRROR_EXPECTS(material < look.palette.size());
  for (const Eigen::Vector2f& place : look.places) CELLMIRROR_EXPECTS(place.allFinite());
}

void check_shape(const geometry::TriangleMesh& mesh, const geometry::MeshFindings& findings) {
  CELLMIRROR_EXPECTS(!mesh.triangles.empty());
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) CELLMIRROR_EXPECTS(corner < mesh.vertices.size());
  }
  for (const Eigen::Vector3d& p : mesh.vertices) CELLMIRROR_EXPECTS(p.allFinite());
  CELLMIRROR_EXPECTS(mesh.closed == findings.why_open().empty());
  if (mesh.closed) CELLMIRROR_EXPECTS(geometry::signed_volume(mesh) > 0.0);
  if (const auto hull = geometry::convex_hull("fuzz", mesh.vertices)) CELLMIRROR_EXPECTS(hull->closed && hull->convex);
  constexpr std::size_t kMostForParts = 100;
  if (mesh.triangles.size() > kMostForParts) return;
  if (const auto parts = geometry::convex_parts(mesh, {0.05, 6})) CELLMIRROR_EXPECTS(!parts->empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::array<std::string_view, 6> kExtensions{".stl", ".obj", ".dae", ".ply", ".gltf", ".glb"};
  constexpr std::size_t kLargest = 16UL << 10U;
  if (size < 1 || size > kLargest) return 0;
  const std::string_view bytes{reinterpret_cast<const char*>(data) + 1, size - 1};
  const bool with_looks = data[0] % 2 == 1;
  const std::string_view extension = kExtensions[data[0] / 2 % kExtensions.size()];
  auto answer = decode_mesh_answer(bytes, with_looks);
  if (!answer) return 0;
  if (!*answer) {
    CELLMIRROR_EXPECTS(!answer->error().what.empty());
    return 0;
  }
  geometry::MeshFindings findings;
  PictureLibrary pictures;
  AppearanceRequest looks;
  looks.text = [&](const std::string&) { return Result<std::string>(bytes); };
  looks.picture = [&](const std::string&) { return Result<Picture>(std::make_shared<const Image>()); };
  looks.embedded = [&](std::string_view picture) { return pictures.of_bytes(picture); };
  const auto mesh = finish_mesh(std::move(**answer), bytes, extension, "fuzz", findings, with_looks ? &looks : nullptr);
  CELLMIRROR_EXPECTS(pictures.bytes() <= kMostPictureBytes);
  if (!mesh) {
    CELLMIRROR_EXPECTS(!mesh.error().what.empty());
    return 0;
  }
  if (looks.look) check_look(*looks.look, *mesh);
  check_shape(*mesh, findings);
  return 0;
}
