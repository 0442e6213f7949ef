// Writes teach files, as the reader takes them. Nothing here opens a file.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "scripts/programs/jet/teach_file.hpp"

namespace cellmirror::program {

struct CheckPoint {
  std::string name;
  JointValues joints{};         // rad or m
  std::optional<double> speed;  // share of each joint's highest velocity, (0, 1]
  std::optional<TeachTolerance> tolerance;
};

// One thread. Real-time class: worker threads.
class TeachWriter {
 public:
  static constexpr std::size_t kMostPoints = 100'000;

  // Refused: an invalid name (is_teach_name()), no joint or more than kMaxJointsPerRobot.
  [[nodiscard]] static Result<TeachWriter> begin(TeachDialect dialect, std::string_view name,
                                                 std::span<const JointKind> joints);
  // A line that people read; line ends and control characters in it become blanks.
  void comment(std::string_view text);
  // Values are written to a millionth of a degree or mm. Refused: an invalid or existing name, values that are not
  // finite or too great, speeds and tolerances that the reader would refuse, too many points.
  Result<void> add(const CheckPoint& point);
  [[nodiscard]] bool knows(std::string_view name) const { return names_.contains(std::string(name)); }
  [[nodiscard]] std::size_t points() const { return names_.size(); }
  // The file as it would be if this were its end.
  [[nodiscard]] std::string text() const { return text_ + "END\n"; }

 private:
  TeachWriter(TeachDialect dialect, std::span<const JointKind> joints)
      : dialect_(dialect), joints_(joints.begin(), joints.end()) {}

  TeachDialect dialect_;
  std::vector<JointKind> joints_;
  std::vector<std::string> last_values_;  // as written; jet_tarm shows differences only
  std::unordered_set<std::string> names_;
  std::string text_;
};

}  // namespace cellmirror::program
