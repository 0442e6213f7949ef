// What the runs of all programs share. Private to the folder.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

#include "rt_core/base/time.hpp"
#include "scripts/programs/controller/program_motion.hpp"
#include "scripts/programs/controller/program_status.hpp"
#include "scripts/programs/controller/signals.hpp"

namespace cellmirror::program {

// Of a time that a program or a parameter says; at most 30 years.
[[nodiscard]] inline Nanoseconds nanoseconds_of(double seconds) {
  return Nanoseconds(std::llround(std::clamp(seconds, 0.0, 1e9) * 1e9));
}

struct RunContext {
  ProgramMotion& motion;
  ProgramScripts& scripts;
  const Clock& clock;
  Semaphores semaphores;
  std::function<void(const ProgramEvent&)> event;
  std::uint64_t failures = 0;
  std::string last_failure;
  Timestamp script_instant;  // that of the SCRIPT comment that is being executed; never: none is

  // The instant at which what is done now takes effect. A SCRIPT comment is noticed later than the move before it has
  // ended; what it starts begins at the end of the move nevertheless.
  [[nodiscard]] Timestamp instant() const { return script_instant.known() ? script_instant : clock.now(); }
};

}  // namespace cellmirror::program
