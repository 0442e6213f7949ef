// What a recording that goes on, or has ended, says of itself. Plain data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cellmirror::app {

struct TopicReport {
  std::string topic;
  std::uint64_t messages = 0;  // taken
  std::uint64_t dropped = 0;
};

struct RecordingReport {
  bool ring = false;  // the black box of the cell file
  bool ended = false;
  std::string why;      // it ended; empty: it was asked to
  std::string problem;  // what is wrong now; empty: nothing
  std::string file;     // that is written now, or was last
  double seconds = 0;   // since it began
  std::uint64_t messages = 0;
  std::uint64_t dropped = 0;
  std::uint64_t bytes = 0;  // written, of all files
  std::uint64_t files = 0;  // begun
  std::uint64_t kept = 0;   // files of a ring
  std::vector<TopicReport> topics;
};

}  // namespace cellmirror::app
