// Records a teach file from a robot's motion, for example of a mirrored robot moved by hand or by its own controller
// (TF_RECORD). No clock, no file, no thread.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "scripts/programs/jet/teach_writer.hpp"

namespace cellmirror::program {

// Check points are created where the robot has come to rest, and on request. The speed of a leg is the highest of any
// joint on it, as a fraction of that joint's maximum velocity. A point that the robot passed gets a tolerance, so that
// the repetition does not stop there either.
class TeachRecorder {
 public:
  static constexpr Nanoseconds kSpan{50'000'000};       // over which speeds are measured
  static constexpr Nanoseconds kRestTime{300'000'000};  // standing this long makes a check point
  static constexpr double kRestShare = 0.005;           // of the highest velocity; slower is standing
  static constexpr double kLeastWay = 1e-3;             // rad or m, of any joint; nearer is the same check point
  static constexpr double kPassedTolerance = 0.01;      // m

  // `max_velocity`: rad/s or m/s; a joint without one (0) does not count for speeds. Refused as by TeachWriter.
  [[nodiscard]] static Result<TeachRecorder> begin(TeachDialect dialect, std::string_view name,
                                                   std::span<const JointKind> joints, const JointValues& max_velocity);
  // Where the robot is. Times ascend; others, and values that are not finite, are passed over. The first one makes the
  // first check point.
  void sample(Timestamp time, const JointValues& joints);
  // A check point where the robot is now. Without a name: P1, P2, ... Refused: no samples yet; an invalid or existing
  // name.
  Result<void> point(std::string_view name);
  [[nodiscard]] std::size_t points() const { return writer_.points(); }
  // The file, with a last check point where the robot is. Refused: nothing was sampled.
  Result<std::string> finish();

 private:
  TeachRecorder(TeachWriter writer, std::size_t joint_count, const JointValues& max_velocity)
      : writer_(std::move(writer)), joint_count_(joint_count), max_velocity_(max_velocity) {}

  Result<void> add(std::string name, const JointValues& joints);
  [[nodiscard]] std::string free_name();
  [[nodiscard]] double share_between(const JointValues& from, const JointValues& to, Nanoseconds time) const;
  [[nodiscard]] bool away_from_last_point() const;
  void measure(Timestamp time);

  TeachWriter writer_;
  std::size_t joint_count_;
  JointValues max_velocity_;
  std::optional<Timestamp> newest_time_;
  JointValues newest_{};
  Timestamp reference_time_;  // where the measuring of the present speed begins
  JointValues reference_{};
  std::optional<Timestamp> rests_since_;
  JointValues last_point_{};
  double leg_share_ = 0;  // the highest since the last check point
  std::size_t next_number_ = 1;
};

}  // namespace cellmirror::program
