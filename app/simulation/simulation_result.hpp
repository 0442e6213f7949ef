// What the off-line simulation found: plain data for the report, the JSON document and the picture. SI; times in
// seconds since the simulation began.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::app {

// Long simulations keep so many of each and count the others.
inline constexpr std::size_t kMostKeptMoves = 100'000;
inline constexpr std::size_t kMostKeptCollisions = 10'000;
inline constexpr std::size_t kMostKeptRefusals = 1'000;
inline constexpr std::size_t kMostKeptRuns = 10'000;
inline constexpr std::size_t kMostKeptMessages = 1'000;
inline constexpr std::size_t kMostKeptEvents = 200'000;
inline constexpr std::size_t kMostKeptTissueEvents = 10'000;

// From here on a value counts as having approached its limit.
inline constexpr double kNearRange = 0.02;     // of the joint's range, from its end
inline constexpr double kNearVelocity = 0.95;  // of the joint's greatest velocity

// A value at the instant at which it was nearest to its limit, or farthest beyond.
struct Extreme {
  double value = 0;
  double limit = 0;
  double time_s = 0;
};

struct JointFindings {
  std::string name;
  JointKind kind = JointKind::revolute;
  bool moved = false;
  double lowest = 0;  // rad or m
  double highest = 0;
  double range_margin = 0;              // share of the range between `position` and its limit; negative: beyond
  std::optional<Extreme> position;      // rad or m; none: a joint without limits
  double velocity_share = 0;            // of the limit
  Extreme velocity;                     // rad/s or m/s
  double acceleration_share = 0;        // of the limit
  Extreme acceleration;                 // rad/s2 or m/s2
  std::vector<double> shares_of_range;  // one a sample of SimulationResult::sample_times_s, NaN: not there then
  [[nodiscard]] bool range_violated() const { return position && range_margin < -1e-9; }
  [[nodiscard]] bool range_approached() const { return moved && position && range_margin < kNearRange; }
  [[nodiscard]] bool velocity_violated() const { return velocity_share > 1.0 + 1e-6; }
  [[nodiscard]] bool velocity_approached() const { return velocity_share >= kNearVelocity; }
};

struct RobotFindings {
  std::string id;
  bool moved = false;
  double moving_s = 0;  // also in delays
  std::uint64_t moves = 0;
  double held_s = 0;  // of moving_s
  std::vector<JointFindings> joints;
};

struct SimulatedMove {
  std::string robot;
  std::uint32_t id = 0;  // of this robot, ascending
  std::string kind;      // "joints", "linear", "circular", "delay"
  double begin_s = 0;
  double end_s = 0;
  std::string outcome;  // "arrived", "stopped", "superseded", "blocked"; "under way" at the end of the simulation
  std::string program;  // that gave it; empty: a SCRIPT command
  std::string step;     // of the program
  std::uint32_t line = 0;
};

struct SimulatedProgram {
  std::string robot;
  std::string name;
  double begin_s = 0;
  double end_s = 0;
  std::string end;  // "ended", "stopped", "failed", "running", "waiting", "held"
  std::size_t moves = 0;
  std::string waits_for;  // where it has not ended
  std::string error;
};

// What programs did, in order: the trace of their commands with times.
struct SimulatedEvent {
  double time_s = 0;
  std::string robot;
  std::string program;
  std::string event;  // "started", "command", "move_ended", ...
  std::uint32_t line = 0;
  std::string text;
};

struct SimulatedCollision {
  std::string a;
  std::string b;
  double begin_s = 0;           // of the first test that saw it
  std::optional<double> end_s;  // of the first one that saw it gone; none: they touched to the end
  double depth_m = 0;           // greatest
  double depth_s = 0;
  bool doubtful = false;
};

struct Refusal {
  double time_s = 0;
  Diagnostic diagnostic;
};

// HOT_MESSAGE.
struct SimulatedMessage {
  double time_s = 0;
  std::string text;
};

struct CollisionSummary {
  bool tested = false;
  std::string why_not;
  double period_s = 0;  // of simulated time, from one test to the next
  double warning_distance_m = 0;
  std::uint64_t tests = 0;
  std::size_t pairs = 0;
  std::uint64_t disagreements = 0;
  double wall_s = 0;  // that the tests took
  std::vector<SimulatedCollision> collisions;
  std::uint64_t more_collisions = 0;
  std::optional<double> smallest_distance_m;
  double smallest_distance_s = 0;
  std::string nearest_a;
  std::string nearest_b;
  std::vector<double> distance_times_s;
  std::vector<double> distances_m;
};

struct SimulatedTissueEvent {
  double time_s = 0;
  TissueEvent event;
};

// Deformable objects; no step: the cell has none.
struct TissueSummary {
  std::string simd;  // instruction set of the element kernel: the same one gives the same bits
  std::uint64_t steps = 0;
  TissueState state;         // at the end
  std::uint64_t digest = 0;  // of all positions and burns at the end
  std::vector<SimulatedTissueEvent> events;
  std::uint64_t more_events = 0;
};

enum class SimulationEnd : std::uint8_t {
  finished,      // the script and everything that it began has ended
  time_limit,    // --for
  stands_still,  // something waits and nothing moves
};

struct SimulationResult {
  std::string cell;
  std::string script;
  SimulationEnd end = SimulationEnd::finished;
  std::string end_note;  // who waits for what
  double simulated_s = 0;
  double wall_s = 0;
  double processor_s = 0;  // of the same, without what else the machine did
  double tick_s = 0;
  std::uint64_t ticks = 0;
  std::uint64_t commands = 0;  // of SCRIPT files
  std::vector<RobotFindings> robots;
  std::vector<double> sample_times_s;
  std::vector<SimulatedProgram> programs;
  std::uint64_t more_programs = 0;
  std::vector<SimulatedMove> moves;
  std::uint64_t more_moves = 0;
  std::vector<SimulatedEvent> events;
  std::uint64_t more_events = 0;
  std::vector<Refusal> refusals;
  std::uint64_t more_refusals = 0;
  std::vector<std::string> deadlocks;
  bool deadlock_was_stopped = false;  // one of them ended because a program that waited in it was stopped
  std::vector<SimulatedMessage> messages;
  std::uint64_t more_messages = 0;
  CollisionSummary collision;
  TissueSummary tissue;

  [[nodiscard]] double times_real_time() const { return wall_s > 0.0 ? simulated_s / wall_s : 0.0; }
  // A command was refused, a program failed, programs waited for each other until one was stopped, or it did not come
  // to its end.
  [[nodiscard]] bool failed() const;
};

}  // namespace cellmirror::app
