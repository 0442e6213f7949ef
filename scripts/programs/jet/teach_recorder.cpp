#include "scripts/programs/jet/teach_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cellmirror::program {

namespace {

constexpr double kLeastShare = 0.01;  // a leg that was crept along is repeated at one percent

}  // namespace

Result<TeachRecorder> TeachRecorder::begin(TeachDialect dialect, std::string_view name,
                                           std::span<const JointKind> joints, const JointValues& max_velocity) {
  Result<TeachWriter> writer = TeachWriter::begin(dialect, name, joints);
  if (!writer) return std::unexpected(writer.error());
  return TeachRecorder(std::move(*writer), joints.size(), max_velocity);
}

void TeachRecorder::sample(Timestamp time, const JointValues& joints) {
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(joints.begin(), joints.begin() + static_cast<std::ptrdiff_t>(joint_count_), finite)) return;
  if (newest_time_ && time <= *newest_time_) return;
  const bool first = !newest_time_;
  newest_time_ = time;
  newest_ = joints;
  if (first) {
    reference_time_ = time;
    reference_ = joints;
    static_cast<void>(add(free_name(), joints));  // refused where a value is beyond what files take: then later ones
  } else if (time - reference_time_ >= kSpan) {
    measure(time);
  }
}

void TeachRecorder::measure(Timestamp time) {
  const double share = share_between(reference_, newest_, time - reference_time_);
  leg_share_ = std::max(leg_share_, share);
  if (share > kRestShare) {
    rests_since_.reset();
  } else if (!rests_since_) {
    rests_since_ = reference_time_;
  }
  reference_time_ = time;
  reference_ = newest_;
  if (rests_since_ && time - *rests_since_ >= kRestTime && away_from_last_point())
    static_cast<void>(add(free_name(), newest_));  // full: points() stays
}

double TeachRecorder::share_between(const JointValues& from, const JointValues& to, Nanoseconds time) const {
  double share = 0;
  for (std::size_t i = 0; i < joint_count_; ++i)
    if (max_velocity_[i] > 0) share = std::max(share, std::abs(to[i] - from[i]) / seconds(time) / max_velocity_[i]);
  return share;
}

bool TeachRecorder::away_from_last_point() const {
  for (std::size_t i = 0; i < joint_count_; ++i)
    if (std::abs(newest_[i] - last_point_[i]) > kLeastWay) return true;
  return false;
}

std::string TeachRecorder::free_name() {
  std::string name;
  do name = fmt::format("P{}", next_number_++);
  while (writer_.knows(name));
  return name;
}

Result<void> TeachRecorder::point(std::string_view name) {
  if (!newest_time_) return fail("the position of the robot is unknown", "TF_RECORD needs a mirrored robot");
  return add(name.empty() ? free_name() : std::string(name), newest_);
}

Result<void> TeachRecorder::add(std::string name, const JointValues& joints) {
  CheckPoint point{std::move(name), joints, {}, {}};
  // The first one is gone to from anywhere: at the robot's own speed.
  if (writer_.points() > 0 && leg_share_ > 0) {
    // Tenths of a percent, upwards: the figure is a measured one.
    point.speed = std::clamp(std::ceil(1000 * leg_share_) / 1000, kLeastShare, 1.0);
    if (!rests_since_) point.tolerance = TeachTolerance{FlyType::distance, kPassedTolerance};
  }
  if (Result<void> added = writer_.add(point); !added) return added;
  last_point_ = joints;
  leg_share_ = 0;
  return {};
}

Result<std::string> TeachRecorder::finish() {
  if (!newest_time_) return fail("nothing was recorded", "TF_RECORD needs a mirrored robot");
  if (away_from_last_point()) {
    // Wherever it is stopped, it ends: nothing follows that the point could be passed to.
    rests_since_ = newest_time_;
    if (Result<void> added = point({}); !added) return std::unexpected(added.error());
  }
  return writer_.text();
}

}  // namespace cellmirror::program
