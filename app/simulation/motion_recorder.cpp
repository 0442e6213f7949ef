#include "app/simulation/motion_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rt_core/motion/move_words.hpp"

namespace cellmirror::app {

namespace {

constexpr double kStill = 1e-9;  // rad or m
constexpr double kNotThere = std::numeric_limits<double>::quiet_NaN();

// A move that ended without an outcome of its own went to its end.
std::string_view end_word(motion::Outcome outcome) {
  return motion::word(outcome == motion::Outcome::none ? motion::Outcome::arrived : outcome);
}

bool has_range(JointKind kind, double lower, double upper) {
  return kind != JointKind::continuous && std::isfinite(lower) && std::isfinite(upper) && lower < upper;
}

// How near a position is to the nearer end of the range.
void note_position(JointFindings& joint, double position, double lower, double upper, double time_s) {
  joint.lowest = std::min(joint.lowest, position);
  joint.highest = std::max(joint.highest, position);
  if (!has_range(joint.kind, lower, upper)) return;
  const bool nearer_lower = position - lower < upper - position;
  const double margin = (nearer_lower ? position - lower : upper - position) / (upper - lower);
  if (joint.position && joint.range_margin <= margin) return;
  joint.range_margin = margin;
  joint.position = Extreme{position, nearer_lower ? lower : upper, time_s};
}

void note_share(double& share, Extreme& extreme, double value, double limit, double time_s) {
  if (limit <= 0.0 || std::abs(value) <= share * limit) return;
  share = std::abs(value) / limit;
  extreme = {value, limit, time_s};
}

}  // namespace

void MotionRecorder::given(std::string_view robot, const motion::Move& move) {
  if (moves_.size() == kMostKeptMoves) {
    ++more_moves_;
    return;
  }
  const auto track = tracks_.find(robot);
  if (track == tracks_.end()) return;  // no tick has passed since it came: it is not known yet
  places_[{std::string(robot), move.id}] = moves_.size();
  track->second.open[move.id] = moves_.size();
  SimulatedMove& kept = moves_.emplace_back();
  kept.robot = robot;
  kept.id = move.id;
  kept.kind = motion::word(move.kind);
  kept.begin_s = kept.end_s = -1.0;
}

SimulatedMove* MotionRecorder::find(std::string_view robot, std::uint32_t id) {
  const auto place = places_.find({std::string(robot), id});
  return place == places_.end() ? nullptr : &moves_[place->second];
}

void MotionRecorder::observe(const std::shared_ptr<const CellState>& cell_state, const engine::TickState& tick) {
  now_s_ = seconds(tick.time - begin_);
  if (cell_state != picture_) {
    picture_ = cell_state;
    adopt(*cell_state);
  }
  for (auto& [id, track] : tracks_) {
    if (track.slot == kGone) continue;
    const engine::RobotTickState& state = tick.robots[track.slot];
    const bool moving = state.motion.moving || state.follow.follows();
    if (moving || track.was_moving || state.motion.finished != track.finished) {
      follow_moves(track, state.motion);
      follow_joints(track, state);
      if (moving) track.findings.moving_s += seconds(period_);
      if (state.motion.moving && state.motion.pace <= 0.0) track.findings.held_s += seconds(period_);
    }
    track.was_moving = moving;
  }
  if (tick.time < next_sample_) return;
  sample(tick);
  next_sample_ = tick.time + sample_period_;
}

// Parameters may have changed, robots come and gone.
void MotionRecorder::adopt(const CellState& cell_state) {
  for (auto& [id, track] : tracks_) track.slot = kGone;
  for (const RobotSnapshot& robot : cell_state.robots) {
    const CompiledRobot* compiled = cell_state.cell->robot(robot.slot);
    if (compiled == nullptr) continue;
    Track& track = tracks_[robot.id];
    track.slot = robot.slot;
    track.parameters = robot.parameters;
    if (track.findings.id.empty()) begin_track(track, *compiled);
  }
}

void MotionRecorder::begin_track(Track& track, const CompiledRobot& robot) {
  track.findings.id = robot.id;
  track.first = robot.start_position;
  for (std::size_t i = 0; i < robot.joint_names.size(); ++i) {
    JointFindings& joint = track.findings.joints.emplace_back();
    joint.name = robot.joint_names[i];
    joint.kind = robot.joint_kinds[i];
    joint.lowest = joint.highest = robot.start_position[i];
    joint.shares_of_range.assign(sample_times_s_.size(), kNotThere);
  }
}

void MotionRecorder::begin_move(Track& track, std::uint32_t id, double time_s) {
  const auto open = track.open.find(id);
  if (open == track.open.end() || moves_[open->second].begin_s >= 0.0) return;
  moves_[open->second].begin_s = std::max(time_s, 0.0);
  ++track.findings.moves;
}

void MotionRecorder::follow_moves(Track& track, const motion::MotionState& motion) {
  const double tick_before = now_s_ - seconds(period_);
  double free_since = tick_before;  // when the robot could begin with what it does now
  if (motion.finished != track.finished) {
    track.finished = motion.finished;
    const double end = motion.finished_time.known() ? seconds(motion.finished_time - begin_) : now_s_;
    if (end > tick_before) free_since = end;
    while (!track.open.empty() && track.open.begin()->first <= motion.finished) {
      const auto [id, place] = *track.open.begin();
      begin_move(track, id, std::min(tick_before, end));  // one that was over before any tick showed it
      moves_[place].end_s = id == motion.finished ? end : std::max(moves_[place].begin_s, tick_before);
      moves_[place].outcome = end_word(id >= motion.finished_from ? motion.outcome : motion::Outcome::arrived);
      track.open.erase(track.open.begin());
    }
  }
  if (motion.running != 0) begin_move(track, motion.running, free_since);
}

void MotionRecorder::follow_joints(Track& track, const engine::RobotTickState& state) {
  const std::size_t joints = std::min<std::size_t>(state.joint_count, track.findings.joints.size());
  for (std::size_t i = 0; i < joints; ++i) {
    JointFindings& joint = track.findings.joints[i];
    const engine::JointTickState& now = state.joints[i];
    note_position(joint, now.position, track.parameters.min_range[i], track.parameters.max_range[i], now_s_);
    note_share(joint.velocity_share, joint.velocity, now.velocity, track.parameters.max_velocity[i], now_s_);
    note_share(joint.acceleration_share, joint.acceleration, (now.velocity - track.velocity[i]) / seconds(period_),
               track.parameters.max_acceleration[i], now_s_);
    joint.moved = joint.moved || std::abs(now.position - track.first[i]) > kStill;
    track.velocity[i] = now.velocity;
  }
}

void MotionRecorder::sample(const engine::TickState& tick) {
  if (sample_times_s_.size() >= kMostSamples) thin_out();
  sample_times_s_.push_back(now_s_);
  for (auto& [id, track] : tracks_) {
    const bool there = track.slot != kGone && tick.robots[track.slot].joint_count == track.findings.joints.size();
    if (there) follow_joints(track, tick.robots[track.slot]);
    for (std::size_t i = 0; i < track.findings.joints.size(); ++i) {
      JointFindings& joint = track.findings.joints[i];
      const double lower = track.parameters.min_range[i];
      const double upper = track.parameters.max_range[i];
      const bool drawn = there && has_range(joint.kind, lower, upper);
      joint.shares_of_range.push_back(drawn ? (tick.robots[track.slot].joints[i].position - lower) / (upper - lower)
                                            : kNotThere);
    }
  }
}

void MotionRecorder::thin_out() {
  const auto every_second = [](std::vector<double>& values) {
    for (std::size_t i = 0; 2 * i < values.size(); ++i) values[i] = values[2 * i];
    values.resize((values.size() + 1) / 2);
  };
  every_second(sample_times_s_);
  for (auto& [id, track] : tracks_) {
    for (JointFindings& joint : track.findings.joints) every_second(joint.shares_of_range);
  }
  sample_period_ *= 2;
}

void MotionRecorder::finish(SimulationResult& result) {
  for (auto& [id, track] : tracks_) {
    track.findings.moved = std::ranges::any_of(track.findings.joints, &JointFindings::moved);
    result.robots.push_back(std::move(track.findings));
  }
  for (SimulatedMove& move : moves_) {
    if (!move.outcome.empty()) continue;
    move.outcome = move.begin_s < 0.0 ? "not begun" : "under way";
    move.end_s = now_s_;
    if (move.begin_s < 0.0) move.begin_s = now_s_;
  }
  result.moves = std::move(moves_);
  result.more_moves = more_moves_;
  result.sample_times_s = std::move(sample_times_s_);
}

}  // namespace cellmirror::app
