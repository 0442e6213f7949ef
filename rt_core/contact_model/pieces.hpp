// The bodies around an instrument, and the instrument's own in pieces: a long shaft touches in more than one place.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "rt_core/collision/bounds.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/contact_model/mesh_surface.hpp"
#include "rt_core/geometry/convex.hpp"
#include "rt_core/geometry/solid.hpp"

namespace cellmirror::contact_model {

// Longer shafts are divided into pieces of about this length.
inline constexpr double kPieceLength = 0.02;  // m

// A convex primitive or a piece of one, or a mesh.
struct Piece {
  std::int32_t node = 0;
  std::uint32_t part = 0;                  // number of the whole among those of its list
  const geometry::Solid* solid = nullptr;  // the whole
  const MeshSurface* surface = nullptr;    // meshes
  Pose X_NS = Pose::Identity();            // of the whole, in the node
  Pose X_NG = Pose::Identity();            // of the piece, in the node
  geometry::ConvexCore core;               // primitives: of the piece, without its skin
  double skin = 0;                         // m
  bool cut_low = false;                    // its end at -z is no end of the whole
  bool cut_high = false;
  collision::OrientedBox box;
  double radius = 0;  // m, of a ball about the middle of the box
  // In this posture.
  bool usable = false;  // its pose is one that can be computed with
  Pose X_WS = Pose::Identity();
  Pose X_WG = Pose::Identity();
  collision::PlacedBox placed;

  [[nodiscard]] bool mesh() const { return surface != nullptr; }
  void place(const Pose& X_WN) {
    X_WS = X_WN * X_NS;
    X_WG = X_WN * X_NG;
    placed.place(X_WN, box);
  }
};

// Surfaces by mesh, made once.
class SurfaceLibrary {
 public:
  [[nodiscard]] const MeshSurface* of(const std::shared_ptr<const geometry::MeshTree>& tree);
  // Drops those of meshes without other owners.
  void forget_unused();

 private:
  struct Entry {
    std::shared_ptr<const geometry::MeshTree> tree;
    std::unique_ptr<MeshSurface> surface;
  };
  std::map<const geometry::MeshTree*, Entry> entries_;
};

// Appends the pieces of a body; `cut`: long ones in several. The body outlives them.
void append_pieces(const collision::Body& body, bool cut, SurfaceLibrary& surfaces, std::vector<Piece>& out);

}  // namespace cellmirror::contact_model
