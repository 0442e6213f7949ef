// Interface of SCRIPT to robot programs (manual 1.2.1; ours: docs/robot-programs.md). Rules as in host.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "scripts/commands/activity.hpp"

namespace cellmirror {

enum class ProgramBegin : std::uint8_t {
  now,        // refused while another program of the robot runs
  exec_wait,  // behind those that run and are queued
  backward,   // now, from the last check point to the first
};

enum class RecordStep : std::uint8_t { start, point, stop };

class ProgramHost {
 public:
  virtual ~ProgramHost() = default;
  virtual Result<void> set_language(std::string_view language) = 0;  // one of program::languages()
  // TF_LOAD. Null: it is loaded, else it is when the activity ends.
  virtual Result<ActivityHandle> load_program(std::string_view program, std::string_view robot) = 0;
  // TF_RUN. Null: it was accepted, else it waits until it is loaded.
  virtual Result<ActivityHandle> run_program(std::string_view program, std::string_view robot, ProgramBegin begin) = 0;
  virtual Result<void> delete_program(std::string_view program, std::string_view robot) = 0;  // TF_DELETE
  // Of the program that the robot runs.
  virtual Result<void> hold_program(std::string_view robot) = 0;                 // TF_HOLD
  virtual Result<void> resume_program(std::string_view robot) = 0;               // TF_RESUME
  virtual Result<void> step_program(std::string_view robot, bool backward) = 0;  // TF_STEP
  virtual Result<void> stop_programs(std::string_view robot) = 0;                // TF_STOP
  // TF_WAIT: ends when the robot's programs have ended, or is refused with what failed. Null: none runs.
  virtual Result<ActivityHandle> await_programs(std::string_view robot) = 0;
  // TF_RECORD. `point`: the check point's name; empty: it gets a number.
  virtual Result<void> record_program(std::string_view program, std::string_view robot, RecordStep step,
                                      std::string_view point) = 0;
  // Inputs of the robot's virtual controller, from 1.
  virtual Result<void> set_digital_input(std::string_view robot, std::size_t number, bool on) = 0;
  virtual Result<void> set_analogue_input(std::string_view robot, std::size_t number, double value) = 0;

  // True while a robot moves, or a robot program or a view sequence runs that can still end: what WAIT waits for.
  [[nodiscard]] virtual bool busy() const = 0;
  // Programs that have failed so far.
  [[nodiscard]] virtual std::uint64_t failures() const = 0;
  // What failed since failures() was `since`, or why programs that run cannot end (a deadlock).
  [[nodiscard]] virtual Result<void> verdict(std::uint64_t since) const = 0;
};

}  // namespace cellmirror
