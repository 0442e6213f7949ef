// Detects deadlocks. Private to the folder.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "scripts/programs/controller/loaded_program.hpp"
#include "scripts/programs/controller/program_status.hpp"

namespace cellmirror::program {

// A program that runs, or is queued.
struct WaitingProgram {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  std::string robot;
  const LoadedProgram* program = nullptr;
  std::string step;
  std::string semaphore;       // it waits for this one; empty: it does not wait for any
  std::size_t behind = kNone;  // queued after this program
};

// The programs that wait for semaphores that only programs among them, or queued behind one of them, release.
// None: no deadlock.
[[nodiscard]] std::optional<Deadlock> find_deadlock(std::span<const WaitingProgram> programs);

}  // namespace cellmirror::program
