// Robots with one turning joint that goes at 1 rad/s from the first instant, in the place of the tick: durations are
// distances. Fly moves end 0.1 s early where the next one may begin. Braking, and a change of pace, take 0.05 s.
#pragma once

#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scripts/programs/controller/program_motion.hpp"

namespace cellmirror::program::test {

inline constexpr double kFlyTime = 0.1;
inline constexpr double kBrakeTime = 0.05;
inline constexpr double kCatchUp = 0.05;

class FakeMotion final : public ProgramMotion {
 public:
  explicit FakeMotion(const Clock& clock) : clock_(clock) {}

  struct Robot {
    struct Item {
      std::uint32_t ticket = 0;
      double duration = 0;
      double target = 0;
      bool fly = false;
      Timestamp begin;
    };
    double q = 0;
    double from = 0;  // of the item that runs
    double time = 0;  // into the item that runs
    bool begun = false;
    double pace = 1;
    double wanted_pace = 1;
    double braking = 0;  // s left
    std::uint32_t gate = 0;
    std::uint32_t newest = 0;
    std::deque<Item> queue;  // the front one runs
    MotionProgress progress;
    double delay = 0;
    bool known = true;
    std::optional<Pose> X_PT;
    int tool_changes = 0;
    std::size_t most_ahead = 0;
  };

  Robot& robot(std::string_view id) { return robots_[std::string(id)]; }
  // The next move of this robot ends as blocked when it has gone half-way.
  void block(std::string_view id) { blocked_ = id; }

  // One tick; the clock stands at its end.
  void advance(double dt) {
    for (auto& [id, robot] : robots_) step(id, robot, dt);
  }

  Result<void> check(std::string_view id) const override {
    if (find(id) == nullptr || !find(id)->known) return fail(std::string(id) + " is mirrored");
    return {};
  }
  bool room(std::string_view id) const override { return find(id)->queue.size() < 32; }
  Result<std::uint32_t> move(std::string_view id, const MoveCommand& command, Timestamp begin) override {
    Robot& to = robot(id);
    const double start = to.queue.empty() ? to.q : to.queue.back().target;
    const double target = command.target.joints[0];
    if (std::abs(target) > 10) return fail(std::string(id) + " cannot reach the target", "look at its limits");
    return put(to, std::abs(target - start), target, command.fly, begin);
  }
  Result<std::uint32_t> delay(std::string_view id, double seconds, Timestamp begin) override {
    Robot& to = robot(id);
    return put(to, seconds, to.queue.empty() ? to.q : to.queue.back().target, false, begin);
  }
  Result<void> set_tool(std::string_view id, const std::optional<Pose>& X_PT) override {
    robot(id).X_PT = X_PT;
    ++robot(id).tool_changes;
    return {};
  }
  MotionProgress progress(std::string_view id) const override {
    MotionProgress progress = find(id)->progress;
    const Robot& of = *find(id);
    const bool begins = !of.queue.empty() && of.wanted_pace > 0 && may_begin(of, of.queue.front().ticket);
    progress.moving = of.begun || begins || of.braking > 0;
    progress.pace = find(id)->pace;
    return progress;
  }
  Result<void> set_pace(std::string_view id, double pace) override {
    robot(id).wanted_pace = pace;
    return {};
  }
  Result<void> hold_behind(std::string_view id, std::uint32_t ticket) override {
    robot(id).gate = ticket;
    return {};
  }
  Result<void> stop(std::string_view id) override {
    if (!robot(id).queue.empty()) robot(id).braking = kBrakeTime;
    return {};
  }
  std::span<const JointKind> joint_kinds(std::string_view id) const override {
    static constexpr std::array kKinds = {JointKind::revolute};
    return find(id) == nullptr ? std::span<const JointKind>{} : kKinds;
  }
  JointValues joints(std::string_view id) const override { return {find(id)->q}; }
  Result<Pose> position(std::string_view /*id*/) const override { return Pose::Identity(); }
  double program_delay(std::string_view id) const override { return find(id)->delay; }

 private:
  const Robot* find(std::string_view id) const {
    const auto found = robots_.find(id);
    return found == robots_.end() ? nullptr : &found->second;
  }
  static Result<std::uint32_t> put(Robot& to, double duration, double target, bool fly, Timestamp begin) {
    to.queue.push_back({++to.newest, duration, target, fly, begin});
    to.most_ahead = std::max(to.most_ahead, to.queue.size());
    return to.newest;
  }

  void step(const std::string& id, Robot& robot, double dt) {
    if (robot.braking > 0) {
      robot.braking -= dt;
      if (robot.braking <= 1e-9) end_all(robot, MotionProgress::End::stopped);
      return;
    }
    const double change = dt / kBrakeTime;
    robot.pace += std::clamp(robot.wanted_pace - robot.pace, -change, change);
    double left = dt * robot.pace;
    while (!robot.queue.empty() && begin_front(robot, dt)) {
      const Robot::Item item = robot.queue.front();
      const bool flies = item.fly && robot.queue.size() > 1 && may_begin(robot, robot.queue[1].ticket);
      const double duration = flies ? std::max(0.0, item.duration - kFlyTime) : item.duration;
      if (id == blocked_ && robot.time >= item.duration / 2) {
        blocked_.clear();
        end_all(robot, MotionProgress::End::blocked);
        return;
      }
      if (robot.time + left < duration) {
        robot.time += left;
        robot.q = robot.from + (item.target - robot.from) * robot.time / item.duration;
        return;
      }
      left -= duration - robot.time;
      robot.q = item.target;
      robot.begun = false;
      robot.queue.pop_front();
      robot.progress.finished = item.ticket;
      robot.progress.end = MotionProgress::End::arrived;
      robot.progress.finished_time = clock_.now() - Nanoseconds(std::llround(left * 1e9));
      if (robot.queue.empty()) return;
      robot.queue.front().begin = robot.progress.finished_time;
    }
  }

  static bool may_begin(const Robot& robot, std::uint32_t ticket) { return robot.gate == 0 || ticket <= robot.gate; }

  bool begin_front(Robot& robot, double dt) {
    if (robot.begun) return true;
    if (!may_begin(robot, robot.queue.front().ticket) || robot.pace == 0) return false;
    const double late = robot.queue.front().begin.known() ? seconds(clock_.now() - robot.queue.front().begin) - dt : 0;
    robot.begun = true;
    robot.from = robot.q;
    // Behind another move: begins within the tick (late is negative then, and `left` counts already).
    robot.time = late > 0 ? std::min(late, kCatchUp) : 0;
    return true;
  }

  void end_all(Robot& robot, MotionProgress::End end) {
    if (!robot.queue.empty()) robot.progress.finished = robot.queue.back().ticket;
    robot.progress.end = end;
    robot.progress.finished_time = clock_.now();
    robot.queue.clear();
    robot.begun = false;
    robot.braking = 0;
    robot.wanted_pace = 1;  // a stop ends a hold
    robot.pace = 1;
  }

  const Clock& clock_;
  std::map<std::string, Robot, std::less<>> robots_;
  std::string blocked_;
};

}  // namespace cellmirror::program::test
