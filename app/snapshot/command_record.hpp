// One entry of the log of commands (docs/messages.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cellmirror::app {

struct CommandRecord {
  std::int64_t wall_ns = 0;  // since 1970 (UTC): when it began
  double took_s = 0;
  std::uint64_t tick = 0;                  // the newest one when its outcome was known; 0: none yet
  std::uint64_t loop_command = 0;          // the newest command to the loop by then; 0: none, or unknown
  std::string source = {};                 // message, page, mqtt, file, program
  std::int32_t process = 0;                // of a message; 0: unknown
  std::optional<std::uint32_t> user = {};  // of that process
  std::uint64_t session = 0;               // of the page: number of its connection since the start
  std::string peer = {};                   // of the page: "uid 1000", or the address of another machine; the broker
  std::string place = {};                  // of a file or a program: "scripts/a.spt:12"
  std::uint64_t run = 0;                   // of a file
  std::string command = {};
  bool done = false;
  std::string answer = {};  // remark, or why it was refused
};

struct CommandLogReport {
  std::string file;  // empty: nothing is kept
  std::uint64_t written = 0;
  std::uint64_t dropped = 0;      // came faster than they could be written
  std::string problem;            // why nothing can be written now; empty: nothing is wrong
  std::vector<std::string> last;  // the newest ones, newest last: a JSON object each, as in the file
};

}  // namespace cellmirror::app
