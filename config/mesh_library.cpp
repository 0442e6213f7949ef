#include "config/mesh_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/mesh_file.hpp"
#include "rt_core/geometry/convex_hull.hpp"
#include "rt_core/geometry/convex_parts.hpp"

namespace cellmirror {

using geometry::MeshFindings;
using geometry::TriangleMesh;

namespace {

void tell_findings(const TriangleMesh& mesh, const MeshFindings& findings, const Place& place,
                   Diagnostics& diagnostics) {
  std::string all;
  for (const std::string& repair : findings.repairs()) all += (all.empty() ? "" : ", ") + repair;
  if (all.empty()) return;
  const bool lost = findings.lost_lines > 0;
  diagnostics.add({lost ? Severity::warning : Severity::note, place, fmt::format("the mesh {}: {}", mesh.name, all),
                   lost ? "repair it where it was made" : "it was repaired when it was read"});
}

}  // namespace

Result<MeshLibrary::Pieces> MeshLibrary::pieces(Entry& entry, const TriangleMesh& mesh, CollideAs collide_as) {
  Pieces out;
  auto& known = entry.pieces[collide_as];
  for (const auto& piece : known) out.push_back(piece.lock());
  if (!out.empty() && std::ranges::find(out, nullptr) == out.end()) return out;
  std::vector<TriangleMesh> made;
  if (collide_as == CollideAs::hull) {
    auto hull = geometry::convex_hull(mesh.name, mesh.vertices);
    if (!hull) return std::unexpected(hull.error());
    made.push_back(std::move(*hull));
  } else {
    auto parts = geometry::convex_parts(mesh);
    if (!parts) return std::unexpected(parts.error());
    made = std::move(*parts);
  }
  out.clear();
  for (TriangleMesh& piece : made) out.push_back(std::make_shared<const TriangleMesh>(std::move(piece)));
  known.assign(out.begin(), out.end());
  return out;
}

Result<CollisionMesh> MeshLibrary::mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale,
                                        CollideAs collide_as, const Place& place, Diagnostics& diagnostics) {
  const auto [at, is_new] = entries_.try_emplace(Key(file.string(), {scale.x(), scale.y(), scale.z()}));
  Entry& entry = at->second;
  CollisionMesh out;
  out.collide_as = collide_as;
  if (counting_) {
    counted_ += is_new ? 1 : 0;
    return out;
  }
  out.mesh = entry.mesh.lock();
  if (!out.mesh) {
    about_to_read(file);
    MeshFindings findings;
    auto read = read_mesh_file(file, scale, findings);
    if (!read) return std::unexpected(read.error());
    tell_findings(*read, findings, place, diagnostics);
    out.mesh = std::make_shared<const TriangleMesh>(std::move(*read));
    entry.mesh = out.mesh;
  }
  if (collide_as == CollideAs::exact) return out;
  auto made = pieces(entry, *out.mesh, collide_as);
  if (!made) return std::unexpected(made.error());
  out.pieces = std::move(*made);
  return out;
}

}  // namespace cellmirror
