// Looks at every tick of the simulation: when moves begin and end, how near joints come to their limits, and where they
// are, for the chart.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/simulation/simulation_result.hpp"
#include "app/snapshot/cell_state.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/motion/move.hpp"

namespace cellmirror::app {

class MotionRecorder {
 public:
  static constexpr std::size_t kMostSamples = 20'000;  // then every second one is forgotten
  static constexpr Nanoseconds kSamplePeriod{10'000'000};

  MotionRecorder(Timestamp begin, Nanoseconds period) : begin_(begin), period_(period) {}

  // A move that was given to the tick.
  void given(std::string_view robot, const motion::Move& move);
  void observe(const std::shared_ptr<const CellState>& cell_state, const engine::TickState& tick);

  // Moves that have not ended are recorded as under way. No observation may follow.
  void finish(SimulationResult& result);

  // Where a move of a robot stands in the list, for a caller that adds to it; null: it is not kept.
  [[nodiscard]] SimulatedMove* find(std::string_view robot, std::uint32_t id);

 private:
  static constexpr std::size_t kGone = kMaxRobots;
  struct Track {
    RobotFindings findings;
    RobotParameters parameters;
    std::size_t slot = kGone;
    bool was_moving = false;
    std::uint32_t finished = 0;
    JointValues first{};                        // rad or m, when it came
    JointValues velocity{};                     // in the tick before
    std::map<std::uint32_t, std::size_t> open;  // moves that were given and have not ended: places in moves_
  };

  void adopt(const CellState& cell_state);
  void begin_track(Track& track, const CompiledRobot& robot);
  void follow_moves(Track& track, const motion::MotionState& motion);
  void begin_move(Track& track, std::uint32_t id, double time_s);
  void follow_joints(Track& track, const engine::RobotTickState& state);
  void sample(const engine::TickState& tick);
  void thin_out();

  Timestamp begin_;
  Nanoseconds period_;
  double now_s_ = 0;
  std::shared_ptr<const CellState> picture_;
  std::map<std::string, Track, std::less<>> tracks_;
  std::vector<SimulatedMove> moves_;
  std::map<std::pair<std::string, std::uint32_t>, std::size_t> places_;  // in moves_
  std::uint64_t more_moves_ = 0;
  std::vector<double> sample_times_s_;
  Nanoseconds sample_period_ = kSamplePeriod;
  Timestamp next_sample_;
};

}  // namespace cellmirror::app
