// A table of joint values over time: the file format of waypoints and recorded motions.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"

namespace cellmirror::sim {

struct MotionTable {
  std::size_t joints = 0;
  std::vector<double> time_s;    // strictly rising, the first is 0 after reading
  std::vector<double> position;  // row after row, `joints` values each; rad or m

  [[nodiscard]] std::size_t rows() const { return time_s.size(); }
  [[nodiscard]] const double* row(std::size_t i) const { return position.data() + i * joints; }
};

// CSV: "time_s, q1, q2, ..." a row. One heading line, empty lines and lines that begin with # are skipped. At most
// kMostRows rows, kMostJoints values a row. All errors go to `diagnostics`; the table is usable where ok().
inline constexpr std::size_t kMostRows = 1'000'000;
inline constexpr std::size_t kMostJoints = 128;
[[nodiscard]] MotionTable read_motion_table(std::string_view text, std::string_view file, Diagnostics& diagnostics);

}  // namespace cellmirror::sim
