// A pose in a record: 56 bytes. The caller has checked the bounds.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "rt_core/base/pose.hpp"

namespace cellmirror {

namespace pose_offset {
// From the start of the pose.
inline constexpr std::size_t kPosition = 0;     // f64[3]
inline constexpr std::size_t kQuaternion = 24;  // f64[4]
inline constexpr std::size_t kBytes = 56;
}  // namespace pose_offset

struct PoseRecord {
  std::array<double, 3> position{};              // m
  std::array<double, 4> quaternion{0, 0, 0, 1};  // x, y, z, w; w >= 0
};

[[nodiscard]] PoseRecord pose_record_of(const Pose& X);
void put_pose(std::span<std::byte> bytes, std::size_t offset, const PoseRecord& pose);
[[nodiscard]] PoseRecord get_pose(std::span<const std::byte> bytes, std::size_t offset);

}  // namespace cellmirror
