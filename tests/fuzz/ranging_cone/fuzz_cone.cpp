// Any numbers as a cone, a pose and a shape. What is read has to be nearer than asked for, in the cone and where it is
// said to be; and no corner of a mesh that is in the cone may be nearer.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <numbers>
#include <optional>

#include "rt_core/base/contract.hpp"
#include "rt_core/ranging/cone.hpp"

namespace {

using namespace cellmirror;
using Eigen::Vector3d;

class Numbers {
 public:
  Numbers(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  [[nodiscard]] std::size_t left() const { return size_ - at_; }
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : std::uint8_t{0}; }
  double number() {
    double out = 0.0;
    if (left() < sizeof out) {
      at_ = size_;
      return 0.0;
    }
    std::memcpy(&out, data_ + at_, sizeof out);
    at_ += sizeof out;
    return out;
  }
  Vector3d vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

// What a mesh may hold (mesh_repair.hpp), and a bit more than a primitive may be.
constexpr double kLargest = 1e6;

bool fit(const Vector3d& v) { return v.allFinite() && v.cwiseAbs().maxCoeff() <= kLargest; }

std::optional<geometry::Solid> solid_of(Numbers& in) {
  const auto shape = static_cast<Shape>(in.byte() % 5);
  if (shape != Shape::mesh) {
    const Vector3d size = in.vector().cwiseAbs();
    if (!fit(size)) return std::nullopt;
    return geometry::make_primitive(shape, size);
  }
  constexpr std::size_t kMost = 200;
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  while (in.left() >= 72 && mesh->triangles.size() < kMost) {
    const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
    for (int i = 0; i < 3; ++i) {
      const Vector3d corner = in.vector();
      mesh->vertices.push_back(fit(corner) ? corner : Vector3d::Zero());
    }
    mesh->triangles.push_back({first, first + 1, first + 2});
  }
  if (mesh->triangles.empty()) return std::nullopt;
  return geometry::make_mesh_solid(std::move(mesh));
}

// Digits are lost in proportion to the numbers that are subtracted.
double agreed(const geometry::Solid& solid, const Pose& X_SG) {
  constexpr double kAgreed = 1e-9;
  return kAgreed * (1.0 + X_SG.translation().norm() + solid.centre.norm() + solid.radius);
}

void check(const geometry::Solid& solid, const Pose& X_SG, const ranging::Cone& cone, double up_to) {
  const auto hit = nearest_in_cone(solid, X_SG, cone, up_to);
  if (hit) {
    CELLMIRROR_EXPECTS(hit->distance >= 0.0 && hit->distance < up_to && hit->p_S.allFinite());
    const double tolerance = agreed(solid, X_SG);
    CELLMIRROR_EXPECTS(std::abs(hit->p_S.norm() - hit->distance) <= tolerance);
    const double beyond = std::cos(cone.half_angle_rad) * std::hypot(hit->p_S.x(), hit->p_S.y()) -
                          std::sin(cone.half_angle_rad) * hit->p_S.z();
    CELLMIRROR_EXPECTS(beyond <= tolerance + 2e-6 * hit->distance);  // half-angles below 1e-6 count as 1e-6
  }
  constexpr double kLeast = 1e-100;  // the square of it is a number
  if (up_to < kLeast || !solid.tree || !X_SG.matrix().allFinite() || cone.max_incidence_rad < 0.5 * std::numbers::pi)
    return;
  for (const Vector3d& corner : solid.tree->mesh().vertices) {
    const Vector3d p = X_SG * corner;
    constexpr double kWellWithin = 1e-4;
    const double angle = std::atan2(std::hypot(p.x(), p.y()), p.z());
    if (!(angle < cone.half_angle_rad - kWellWithin) || !(p.norm() < up_to)) continue;
    CELLMIRROR_EXPECTS(hit && hit->distance <= p.norm() + agreed(solid, X_SG));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Numbers in(data, size);
  ranging::Cone cone;
  cone.half_angle_rad = in.number();
  if ((in.byte() & 1U) != 0) cone.max_incidence_rad = in.number();
  const double up_to = in.number();
  const Vector3d at = in.vector();
  const Vector3d rpy = in.vector();
  const Pose X_SG = pose_from_xyz_rpy(at, rpy);
  if (X_SG.matrix().allFinite() && !fit(at)) return 0;
  const auto solid = solid_of(in);
  if (!solid) return 0;
  const bool sound = cone.half_angle_rad > 0.0 && cone.half_angle_rad < 0.5 * std::numbers::pi &&
                     !std::isnan(cone.max_incidence_rad) && up_to > 0.0;
  if (sound) {
    check(*solid, X_SG, cone, up_to);
  } else {
    CELLMIRROR_EXPECTS(!nearest_in_cone(*solid, X_SG, cone, up_to));
  }
  return 0;
}
