#include "rt_core/contact_model/pieces.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::contact_model {

namespace {

using geometry::CoreKind;

constexpr int kMostPieces = 64;  // of one primitive

int pieces_of(const geometry::Solid& solid) {
  if (solid.shape == Shape::mesh) return 1;
  if (solid.core.kind != CoreKind::segment && solid.core.kind != CoreKind::cylinder) return 1;
  const double length = 2 * solid.core.half.z();
  const double pitch = std::max(kPieceLength, 4 * (solid.core.half.x() + solid.core.skin));
  return std::clamp(static_cast<int>(std::ceil(length / pitch)), 1, kMostPieces);
}

Piece whole(std::int32_t node, const collision::BodyPart& part, SurfaceLibrary& surfaces) {
  Piece piece;
  piece.node = node;
  piece.solid = part.solid.get();
  piece.X_NS = piece.X_NG = part.X_NG;
  piece.box = collision::box_around(part);
  piece.radius = part.solid->radius;
  if (part.solid->shape == Shape::mesh) {
    piece.surface = surfaces.of(part.solid->tree);
  } else {
    piece.core = part.solid->core;
    piece.skin = piece.core.skin;
    piece.core.skin = 0;
  }
  return piece;
}

}  // namespace

const MeshSurface* SurfaceLibrary::of(const std::shared_ptr<const geometry::MeshTree>& tree) {
  Entry& entry = entries_[tree.get()];
  if (entry.surface == nullptr) entry = {tree, std::make_unique<MeshSurface>(*tree)};
  return entry.surface.get();
}

void SurfaceLibrary::forget_unused() {
  std::erase_if(entries_, [](const auto& entry) { return entry.second.tree.use_count() == 1; });
}

void append_pieces(const collision::Body& body, bool cut, SurfaceLibrary& surfaces, std::vector<Piece>& out) {
  for (const collision::BodyPart& part : body.parts) {
    Piece all = whole(body.node, part, surfaces);
    all.part = out.empty() ? 0 : out.back().part + 1;
    const int count = cut ? pieces_of(*part.solid) : 1;
    const double half = all.core.half.z() / count;
    for (int i = 0; i < count; ++i) {
      Piece piece = all;
      if (count > 1) {
        piece.core.half.z() = half;
        piece.X_NG.translate(Eigen::Vector3d(0, 0, (2 * i + 1 - count) * half));
        piece.cut_low = i > 0;
        piece.cut_high = i + 1 < count;
        piece.box.X_NB = piece.X_NG;
        const double across = piece.core.half.x() + piece.skin;
        piece.box.half = {across, across, half + (piece.core.kind == CoreKind::segment ? piece.skin : 0.0)};
        piece.radius = piece.box.half.norm();
      }
      piece.placed.half = piece.box.half;
      piece.placed.radius = piece.radius;
      out.push_back(piece);
    }
  }
}

}  // namespace cellmirror::contact_model
