#include "config/mesh_library.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "config/mesh_appearance.hpp"
#include "config/mesh_file.hpp"
#include "config/picture_library.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/geometry/convex/convex_hull.hpp"
#include "rt_core/geometry/convex/convex_parts.hpp"

namespace cellmirror {

using geometry::MeshFindings;
using geometry::TriangleMesh;

namespace {

Eigen::Vector3d extent_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box.isEmpty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Eigen::Vector3d(box.sizes());
}

// Robots and tools often have mirrored parts, which are inside out by accident; a room is larger in each direction.
bool may_be_a_room(const TriangleMesh& mesh) {
  constexpr double kSmallest = 1.0;  // m
  return extent_of(mesh).minCoeff() >= kSmallest;
}

void report_findings(const TriangleMesh& mesh, const MeshFindings& findings, const Place& place,
                     Diagnostics& diagnostics) {
  std::string all;
  for (const std::string& repair : findings.repairs()) all += (all.empty() ? "" : ", ") + repair;
  if (all.empty()) return;
  const bool lost = findings.lost_lines > 0;
  const bool filled = findings.inside_out_shells > 0 && may_be_a_room(mesh);
  const char* remedy = lost     ? "repair it in the program that made it"
                       : filled ? "its inside is solid now: where it is a room, export its walls with a thickness"
                                : "it was repaired while reading";
  diagnostics.add({lost || filled ? Severity::warning : Severity::note, place,
                   fmt::format("the mesh {}: {}", mesh.name, all), remedy});
}

void report_suspected_unit(const TriangleMesh& mesh, const Place& place, Diagnostics& diagnostics) {
  constexpr double kLargest = 100.0;  // m; a part of 0.1 m that was drawn in millimetres
  const double size = extent_of(mesh).maxCoeff();
  if (size < kLargest) return;
  diagnostics.add({Severity::warning, place, fmt::format("the mesh {} is {:.0f} m long", mesh.name, size),
                   "where it was drawn in millimetres, scale it by 0.001"});
}

void report_left_out(const TriangleMesh& mesh, const AppearanceRequest& looks, const Place& place,
                     Diagnostics& diagnostics) {
  for (const Error& error : looks.left_out)
    diagnostics.add({Severity::warning, place, fmt::format("the mesh {}: {}", mesh.name, error.what), error.remedy});
}

}  // namespace

MeshLibrary::MeshLibrary() : pictures_(std::make_unique<PictureLibrary>()) {}
MeshLibrary::~MeshLibrary() = default;

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

Result<void> MeshLibrary::read(Entry& entry, const std::filesystem::path& file, const Eigen::Vector3d& scale,
                               const Beside& beside, const Place& place, Diagnostics& diagnostics, CollisionMesh& out) {
  about_to_read(file);
  constexpr std::size_t kLargestFile = 4UL << 20U;
  pictures_->begin_mesh();
  AppearanceRequest looks;
  looks.text = [&](const std::string& name) -> Result<std::string> {
    const auto at = beside(name);
    if (!at) return std::unexpected(at.error());
    return read_text_file(*at, kLargestFile);
  };
  looks.picture = [&](const std::string& name) -> Result<Picture> {
    const auto at = beside(name);
    if (!at) return std::unexpected(at.error());
    return pictures_->of_file(*at);
  };
  looks.embedded = [&](std::string_view bytes) { return pictures_->of_bytes(bytes); };
  MeshFindings findings;
  auto mesh = read_mesh_file(file, scale, findings, &looks);
  if (!mesh) return std::unexpected(mesh.error());
  report_findings(*mesh, findings, place, diagnostics);
  report_suspected_unit(*mesh, place, diagnostics);
  report_left_out(*mesh, looks, place, diagnostics);
  out.mesh = std::make_shared<const TriangleMesh>(std::move(*mesh));
  out.look = std::move(looks.look);
  entry.mesh = out.mesh;
  entry.look = out.look;
  entry.had_look = out.look != nullptr;
  return {};
}

Result<CollisionMesh> MeshLibrary::mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale,
                                        CollideAs collide_as, const Beside& beside, const Place& place,
                                        Diagnostics& diagnostics) {
  const auto [at, is_new] = entries_.try_emplace(Key(file.string(), {scale.x(), scale.y(), scale.z()}));
  Entry& entry = at->second;
  CollisionMesh out;
  out.collide_as = collide_as;
  if (counting_) {
    counted_ += is_new ? 1 : 0;
    return out;
  }
  out.mesh = entry.mesh.lock();
  out.look = entry.look.lock();
  if (!out.mesh || (entry.had_look && !out.look)) {
    if (auto done = read(entry, file, scale, beside, place, diagnostics, out); !done)
      return std::unexpected(done.error());
  }
  if (collide_as == CollideAs::exact) return out;
  auto made = pieces(entry, *out.mesh, collide_as);
  if (!made) return std::unexpected(made.error());
  out.pieces = std::move(*made);
  return out;
}

}  // namespace cellmirror
