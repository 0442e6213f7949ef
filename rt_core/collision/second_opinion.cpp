#include "rt_core/collision/second_opinion.hpp"

#include <fcl/fcl.h>

#include <algorithm>
#include <exception>
#include <map>
#include <set>
#include <utility>

#include "rt_core/collision/bounds.hpp"
#include "rt_core/geometry/proximity.hpp"

namespace cellmirror::collision {

namespace {

// Nearer than this to touching, or less deep, FCL and we may differ without either being wrong: its solver for
// primitives stops at 1e-6 m.
constexpr double kTolerance = 1e-6;
// Limit of pairs of parts in one query; the answer covers only those.
constexpr std::size_t kMostPartPairs = 4096;

using FclShape = std::shared_ptr<fcl::CollisionGeometry<double>>;

FclShape make_primitive(const geometry::Solid& solid) {
  const Eigen::Vector3d& size = solid.size;
  switch (solid.shape) {
    case Shape::box:
      return std::make_shared<fcl::Box<double>>(size);
    case Shape::sphere:
      return std::make_shared<fcl::Sphere<double>>(size.x());
    case Shape::cylinder:
      return std::make_shared<fcl::Cylinder<double>>(size.x(), size.y());
    case Shape::capsule:
      return std::make_shared<fcl::Capsule<double>>(size.x(), size.y());
    case Shape::mesh:
      break;
  }
  return nullptr;
}

FclShape make_mesh(const geometry::TriangleMesh& mesh) {
  // OBB, not OBBRSS: half the memory, and the spheres of the latter only serve distances.
  auto model = std::make_shared<fcl::BVHModel<fcl::OBB<double>>>();
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  if (model->beginModel(static_cast<int>(mesh.triangles.size()), static_cast<int>(mesh.vertices.size())) != fcl::BVH_OK)
    return nullptr;
  if (model->addSubModel(mesh.vertices, triangles) != fcl::BVH_OK || model->endModel() != fcl::BVH_OK) return nullptr;
  model->computeLocalAABB();
  return model;
}

PlacedBox placed(const BodyPart& part, const Pose& X_WN) {
  const OrientedBox box = box_around(part);
  PlacedBox placed_box;
  placed_box.half = box.half;
  placed_box.radius = part.solid->radius;
  placed_box.place(X_WN, box);
  return placed_box;
}

bool solid_everywhere(const Body& body) {
  return std::ranges::all_of(body.parts, [](const BodyPart& part) {
    return part.solid->shape != Shape::mesh || part.solid->tree->mesh().closed;
  });
}

}  // namespace

struct SecondOpinion::Models {
  struct Entry {
    FclShape shape;
    std::shared_ptr<const geometry::Solid> surface;  // the same without an inside, where it was needed
  };
  std::map<std::shared_ptr<const geometry::Solid>, Entry> entries;

  FclShape shape_of(const std::shared_ptr<const geometry::Solid>& solid) {
    Entry& entry = entries[solid];
    if (!entry.shape)
      entry.shape = solid->shape == Shape::mesh ? make_mesh(solid->tree->mesh()) : make_primitive(*solid);
    return entry.shape;
  }

  // Meshes are surfaces to FCL: a body inside one without crossing it does not touch it there.
  std::shared_ptr<const geometry::Solid> surface_of(const std::shared_ptr<const geometry::Solid>& solid) {
    if (solid->shape != Shape::mesh || !solid->tree->mesh().closed) return solid;
    Entry& entry = entries[solid];
    if (!entry.surface) {
      auto mesh = std::make_shared<geometry::TriangleMesh>(solid->tree->mesh());
      mesh->closed = false;
      mesh->convex = false;
      entry.surface = std::make_shared<const geometry::Solid>(geometry::make_mesh_solid(std::move(mesh)));
    }
    return entry.surface;
  }

  struct Seen {
    bool touching = false;
    bool failed = false;
    bool enclosed = false;  // some parts touch only by one lying within the other
  };
  Seen look(const Body& a, const Pose& X_WA, const Body& b, const Pose& X_WB);
  bool enclosed(const BodyPart& a, const Pose& X_WA, const BodyPart& b, const Pose& X_WB);
};

SecondOpinion::Models::Seen SecondOpinion::Models::look(const Body& a, const Pose& X_WA, const Body& b,
                                                        const Pose& X_WB) {
  Seen seen;
  std::size_t asked = 0;
  for (const BodyPart& part_a : a.parts) {
    const PlacedBox box_a = placed(part_a, X_WA);
    for (const BodyPart& part_b : b.parts) {
      if (lower_bound(box_a, placed(part_b, X_WB), 0.0) > kTolerance || ++asked > kMostPartPairs) continue;
      const FclShape shape_a = shape_of(part_a.solid);
      const FclShape shape_b = shape_of(part_b.solid);
      if (!shape_a || !shape_b) {
        seen.failed = true;
        continue;
      }
      const Pose X_WGa = X_WA * part_a.X_NG;
      const Pose X_WGb = X_WB * part_b.X_NG;
      fcl::CollisionRequest<double> request;
      fcl::CollisionResult<double> result;
      fcl::collide(shape_a.get(), X_WGa, shape_b.get(), X_WGb, request, result);
      seen.touching = seen.touching || result.isCollision();
    }
  }
  return seen;
}

bool SecondOpinion::Models::enclosed(const BodyPart& a, const Pose& X_WA, const BodyPart& b, const Pose& X_WB) {
  geometry::ProximityHint hint;
  if (!geometry::touch(*a.solid, X_WA * a.X_NG, *b.solid, X_WB * b.X_NG, hint)) return false;
  const auto surface_a = surface_of(a.solid);
  const auto surface_b = surface_of(b.solid);
  geometry::ProximityHint fresh;
  const auto apart = geometry::separation(*surface_a, X_WA * a.X_NG, *surface_b, X_WB * b.X_NG, 10 * kTolerance, fresh);
  return apart.beyond || apart.points.distance > kTolerance;
}

SecondOpinion::SecondOpinion() : models_(std::make_unique<Models>()) {}
SecondOpinion::~SecondOpinion() = default;

Opinion SecondOpinion::ask(const Body& a, const Pose& X_WA, const Body& b, const Pose& X_WB, const OwnVerdict& own) {
  // The depth of an open surface is not known, so that it cannot excuse anything.
  const bool grazing = own.touching && own.depth < kTolerance && solid_everywhere(a) && solid_everywhere(b);
  if (grazing || (!own.touching && own.distance < kTolerance)) return Opinion::agrees;
  try {
    const auto seen = models_->look(a, X_WA, b, X_WB);
    if (seen.touching == own.touching) return Opinion::agrees;
    if (seen.failed) return Opinion::failed;
    if (!own.touching) return Opinion::disagrees;
    for (const BodyPart& part_a : a.parts) {
      for (const BodyPart& part_b : b.parts) {
        if (models_->enclosed(part_a, X_WA, part_b, X_WB)) return Opinion::agrees;
      }
    }
    return Opinion::disagrees;
  } catch (const std::exception&) {
    return Opinion::failed;
  }
}

void SecondOpinion::keep_only(const PairTable& table) {
  std::set<std::shared_ptr<const geometry::Solid>> used;
  for (const Body& body : table.bodies) {
    for (const BodyPart& part : body.parts) used.insert(part.solid);
  }
  std::erase_if(models_->entries, [&](const auto& entry) { return !used.contains(entry.first); });
}

}  // namespace cellmirror::collision
