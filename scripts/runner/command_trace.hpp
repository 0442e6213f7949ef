// What became of one SCRIPT command, for the log of all commands.
#pragma once

#include <cstdint>
#include <string>

#include "rt_core/base/time.hpp"
#include "scripts/runner/script_command.hpp"

namespace cellmirror::script {

struct CommandTrace {
  CommandSource source = {};  // of a file or a robot program with the line: "scripts/a.spt:12"
  std::uint64_t run = 0;      // of a file; see RunStatus
  std::string text = {};      // as it was written
  Timestamp began = {};
  Timestamp ended = {};
  bool done = false;        // of a motion without acknowledgement: it has begun
  std::string answer = {};  // remark, or why it was refused, with the remedy
};

}  // namespace cellmirror::script
