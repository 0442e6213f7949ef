// Hears what programs do in the simulation: when each began and ended, and which moves are theirs.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "app/simulation/motion_recorder.hpp"
#include "app/simulation/simulation_result.hpp"
#include "scripts/programs/controller/controllers.hpp"

namespace cellmirror::app {

class ProgramRecorder {
 public:
  // `moves` outlives the recorder.
  ProgramRecorder(Timestamp begin, MotionRecorder& moves) : begin_(begin), moves_(moves) {}

  void hear(const program::ProgramEvent& event);
  // `status`: of all programs at the end of the simulation, for those that have not ended.
  void finish(const std::vector<program::ProgramStatus>& status, double now_s, SimulationResult& result);

 private:
  void begin(const program::ProgramEvent& event, double now_s);
  void end(const program::ProgramEvent& event, double now_s);
  void name_move(const program::ProgramEvent& event);
  void keep(const program::ProgramEvent& event, double now_s);

  Timestamp begin_;
  MotionRecorder& moves_;
  std::vector<SimulatedProgram> runs_;
  std::uint64_t more_runs_ = 0;
  std::map<std::string, std::size_t, std::less<>> running_;  // by robot; places in runs_
  std::vector<std::string> deadlocks_;
  std::vector<SimulatedEvent> events_;
  std::uint64_t more_events_ = 0;
};

}  // namespace cellmirror::app
