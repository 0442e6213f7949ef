// Targets of inverse kinematics from a CSV: the header px,py,pz,qx,qy,qz,qw, then a row a target, the pose of the tip
// in the base. Metres; a unit quaternion.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/pose.hpp"

namespace cellmirror {

inline constexpr std::string_view kTargetHeader = "px,py,pz,qx,qy,qz,qw";
inline constexpr std::size_t kMaxTargets = 1'000'000;
inline constexpr std::size_t kLargestTargetFile = 256UL << 20U;  // bytes
inline constexpr double kFarthestTarget = 1e6;                   // m, of each coordinate
// How far the norm of a quaternion may be from 1; within that it is normalised (files often carry few digits).
inline constexpr double kQuaternionSlack = 1e-3;

// The targets X_BG in the order of the rows, or nothing and all diagnostics with file:line:column. Accepted: LF and
// CRLF, a UTF-8 byte order mark, blanks around the numbers, blank lines at the end. Any bytes are allowed as text.
[[nodiscard]] std::optional<std::vector<Pose>> parse_targets(std::string_view text, const std::string& file,
                                                             Diagnostics& diagnostics);

}  // namespace cellmirror
