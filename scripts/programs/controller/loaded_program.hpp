// A program in the virtual controller of a robot, with what is known of its runs. Private to the folder.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "scripts/programs/controller/program_status.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {

struct LoadedProgram {
  LoadedProgram(std::string name_as_loaded, std::shared_ptr<const Program> what);

  [[nodiscard]] bool releases(std::string_view semaphore) const { return released.contains(semaphore); }
  [[nodiscard]] bool uses(std::string_view semaphore) const { return used.contains(semaphore); }

  std::string name;
  std::shared_ptr<const Program> program;
  std::set<std::string, std::less<>> released;  // semaphores
  std::set<std::string, std::less<>> used;      // declared, acquired or released

  ProgramState state = ProgramState::loaded;  // what the last run came to; queued
  Direction direction = Direction::forward;
  std::string step;
  std::uint32_t line = 0;
  double elapsed_s = 0;
  std::optional<double> expected_forward_s;
  std::optional<double> expected_backward_s;
  std::uint64_t runs = 0;
  std::string error;
};

}  // namespace cellmirror::program
