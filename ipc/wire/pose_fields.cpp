#include "ipc/wire/pose_fields.hpp"

#include <Eigen/Geometry>

#include "ipc/wire/little_endian.hpp"

namespace cellmirror {

using namespace pose_offset;

PoseRecord pose_record_of(const Pose& X) {
  Eigen::Quaterniond q(X.linear());
  q.normalize();
  // q and -q are the same rotation: one of them is sent, so that equal poses have equal bytes.
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const auto& p = X.translation();
  return {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

void put_pose(std::span<std::byte> bytes, std::size_t offset, const PoseRecord& pose) {
  for (std::size_t i = 0; i < 3; ++i) little_endian::put(bytes, offset + kPosition + 8 * i, pose.position[i]);
  for (std::size_t i = 0; i < 4; ++i) little_endian::put(bytes, offset + kQuaternion + 8 * i, pose.quaternion[i]);
}

PoseRecord get_pose(std::span<const std::byte> bytes, std::size_t offset) {
  PoseRecord pose;
  for (std::size_t i = 0; i < 3; ++i) {
    pose.position[i] = little_endian::get<double>(bytes, offset + kPosition + 8 * i);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    pose.quaternion[i] = little_endian::get<double>(bytes, offset + kQuaternion + 8 * i);
  }
  return pose;
}

}  // namespace cellmirror
