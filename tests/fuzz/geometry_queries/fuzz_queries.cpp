// Any shapes in any poses: queries end, answer with numbers, do not depend on who is named first, and agree with each
// other. Each input is read as a sequence of small numbers; the text of a seed is as good as any.
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"
#include "rt_core/geometry/proximity.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::geometry;
using Eigen::Vector3d;

#define REQUIRE(condition)            \
  ((condition) ? static_cast<void>(0) \
               : (std::fprintf(stderr, "not so: %s (line %d)\n", #condition, __LINE__), std::abort()))

constexpr double kFar = std::numeric_limits<double>::infinity();

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data, size) {}

  bool empty() const { return data_.empty(); }
  unsigned below(unsigned end) { return next() % end; }
  // Round numbers, so that faces are flush and edges meet; some are tiny, far out or no numbers.
  double number() {
    const unsigned kind = next();
    const double value = (static_cast<double>(next()) - 128.0) / 64.0;
    if (kind == 255) wild_ = true;
    if (kind == 255) return std::numeric_limits<double>::quiet_NaN();
    if (kind == 254) return value * 1e3;
    if (kind == 253) return value * 1e-6;
    if (kind == 252) return value + static_cast<double>(next()) * 1e-9;
    return kind % 2 == 0 ? std::round(value) : value;
  }
  Vector3d vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }
  Pose pose() {
    Pose X = Pose::Identity();
    X.translation() = vector();
    const Vector3d axis = vector();
    const double angle = number();
    if (axis.squaredNorm() > 0.0 && below(3) != 0)
      X.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    return X;
  }
  // A NaN was among what was read.
  bool wild() const { return wild_; }

 private:
  unsigned next() {
    if (data_.empty()) return 0;
    const unsigned byte = data_.front();
    data_ = data_.subspan(1);
    return byte;
  }

  std::span<const std::uint8_t> data_;
  bool wild_ = false;
};

ConvexCore any_core(Bytes& bytes) {
  ConvexCore core;
  core.kind = static_cast<CoreKind>(bytes.below(5));
  core.half = bytes.vector().cwiseAbs();
  if (core.kind == CoreKind::cylinder) core.half.y() = core.half.x();
  if (core.kind == CoreKind::triangle) {
    for (Vector3d& corner : core.corners) corner = bytes.vector();
  }
  if (bytes.below(2) != 0) core.skin = std::abs(bytes.number());
  return core;
}

double extent(const ConvexCore& core) {
  double out = core.skin;
  if (core.kind == CoreKind::triangle) {
    for (const Vector3d& corner : core.corners) out = std::max(out, corner.norm());
    return out;
  }
  return out + core.half.norm();
}

bool finite(const ClosestPoints& points) {
  return std::isfinite(points.distance) && points.p_a.allFinite() && points.p_b.allFinite();
}

void convex_queries(Bytes& bytes) {
  const ConvexCore a = any_core(bytes);
  const ConvexCore b = any_core(bytes);
  const Pose X_WA = bytes.pose();
  const Pose X_WB = bytes.pose();
  const ConvexDistance found = convex_distance(a, X_WA, b, X_WB);
  const Penetration depth = convex_penetration(a, X_WA, b, X_WB);
  REQUIRE(finite(found.points));
  REQUIRE(found.points.distance >= 0.0);
  REQUIRE(std::isfinite(depth.depth) && depth.depth >= 0.0 && depth.normal.allFinite() && depth.point.allFinite());
  if (bytes.wild()) return;
  const double size = extent(a) + extent(b) + X_WA.translation().norm() + X_WB.translation().norm();
  const double tolerance = 2e-9 + 1e-9 * size;
  const ConvexDistance back = convex_distance(b, X_WB, a, X_WA);
  const double doubt = found.certain && back.certain ? 0.0 : 1e-6 + 1e-6 * size;
  REQUIRE(std::abs(back.points.distance - found.points.distance) <= tolerance + doubt);
  const double gap = (found.points.p_b - found.points.p_a).norm();
  REQUIRE(!found.certain || std::abs(gap - found.points.distance) <= tolerance);
  // What was shifted is shifted.
  Pose X_moved = X_WB;
  const Vector3d way = bytes.vector();
  if (!way.allFinite()) return;
  X_moved.translation() += way;
  const double moved = convex_distance(a, X_WA, b, X_moved).points.distance;
  REQUIRE(std::abs(moved - found.points.distance) <= way.norm() * (1.0 + 1e-12) + 2.0 * tolerance + doubt);
  if (found.points.distance > 0.0) return;
  // The way parts them.
  X_moved.translation() = X_WB.translation() + (depth.depth + 4.0 * tolerance + 1e-7) * depth.normal;
  REQUIRE(std::abs(depth.normal.norm() - 1.0) < 1e-9);
  // Bodies of kilometres a hundredth of a millimetre apart may be in doubt.
  const ConvexDistance parted = convex_distance(a, X_WA, b, X_moved);
  REQUIRE(!parted.certain || parted.points.distance > 0.0);
}

Solid any_solid(Bytes& bytes) {
  const Shape shape = static_cast<Shape>(bytes.below(5));
  if (shape != Shape::mesh) {
    const Vector3d size = bytes.vector().cwiseAbs();
    if (size.allFinite()) return make_primitive(shape, size.array().max(1e-6).matrix());
  }
  std::vector<Vector3d> vertices;
  const unsigned corners = 3 + bytes.below(12);
  for (unsigned i = 0; i < corners; ++i) vertices.push_back(bytes.vector());
  std::vector<TriangleIndices> triangles;
  const unsigned faces = 1 + bytes.below(24);
  for (unsigned i = 0; i < faces; ++i)
    triangles.push_back({bytes.below(corners), bytes.below(corners), bytes.below(corners)});
  MeshFindings findings;
  auto mesh = make_mesh("fuzz", std::move(vertices), std::move(triangles), findings);
  if (!mesh) return make_primitive(Shape::sphere, {0.5, 0, 0});
  return make_mesh_solid(std::make_shared<const TriangleMesh>(std::move(*mesh)));
}

void solid_queries(Bytes& bytes) {
  const Solid a = any_solid(bytes);
  const Solid b = any_solid(bytes);
  const Pose X_WA = bytes.pose();
  const Pose X_WB = bytes.pose();
  const bool wild = !X_WA.matrix().allFinite() || !X_WB.matrix().allFinite();
  ProximityHint hint;
  hint.feature_a = bytes.below(256);
  hint.known = bytes.below(2) != 0;
  const Separation found = separation(a, X_WA, b, X_WB, kFar, hint);
  const bool touching = touch(a, X_WA, b, X_WB, hint);
  Contact contacts;
  const bool in_contact = contact(a, X_WA, b, X_WB, 4, contacts);
  REQUIRE(finite(found.points) && found.points.distance >= 0.0);
  if (wild) {
    REQUIRE(!found.certain || touching);
    return;
  }
  const double size = a.half.norm() + b.half.norm() + a.centre.norm() + b.centre.norm() + X_WA.translation().norm() +
                      X_WB.translation().norm();
  const double tolerance = 2e-9 + 1e-9 * size;
  if (!found.certain) return;
  REQUIRE(!found.beyond);
  ProximityHint fresh;
  const Separation back = separation(b, X_WB, a, X_WA, kFar, fresh);
  REQUIRE(std::abs(back.points.distance - found.points.distance) <= tolerance);
  REQUIRE(std::abs((found.points.p_a - found.points.p_b).norm() - found.points.distance) <= tolerance);
  if (found.points.distance > kTouchDistance + tolerance) REQUIRE(!touching && !in_contact);
  if (found.points.distance == 0.0) REQUIRE(touching && in_contact);
  if (!in_contact) return;
  REQUIRE(contacts.points.size() <= 4);
  REQUIRE(contacts.deepest.depth >= 0.0 && std::isfinite(contacts.deepest.depth));
  REQUIRE(std::abs(contacts.deepest.normal.norm() - 1.0) < 1e-6);
  for (const ContactPoint& point : contacts.points) {
    REQUIRE(point.p_W.allFinite() && point.normal.allFinite() && std::isfinite(point.depth));
    REQUIRE(point.depth <= contacts.deepest.depth + tolerance);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  for (int i = 0; i < 8 && !bytes.empty(); ++i) {
    if (bytes.below(2) != 0) {
      convex_queries(bytes);
    } else {
      solid_queries(bytes);
    }
  }
  return 0;
}
