// Gives alarms to the recordings: each one as it is when it has changed, and those that are there at the beginning of
// each file.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/recorder/output_messages.hpp"
#include "app/recorder/recording_hub.hpp"
#include "app/recorder/topic.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// What the recorder asks for: the lines that the gateway writes into its own file too (docs/alarms.md).
struct AlarmLines {
  struct Line {
    std::uint64_t id = 0;
    std::string text;
  };
  std::function<std::uint64_t()> revision = {};    // another one where any alarm has changed; empty: no alarms
  std::function<std::vector<Line>()> newest = {};  // all that are open, and the newest of the history; oldest first
};

// The recorder's thread.
class AlarmRecorder {
 public:
  // `hub` outlives it.
  AlarmRecorder(AlarmLines alarms, RecordingHub& hub) : alarms_(std::move(alarms)), hub_(hub) {}
  // To be called several times a second while something is recorded.
  void look(Timestamp now);
  // Nothing is recorded: all is put again when it is.
  void forget() { known_.clear(), files_ = 0; }

 private:
  AlarmLines alarms_;
  RecordingHub& hub_;
  TopicPtr topic_ = OutputTopics::alarms();
  Timestamp last_look_;
  std::uint64_t revision_ = 0;
  std::uint64_t files_ = 0;
  std::map<std::uint64_t, std::string> known_;  // by id, as it was put last
};

}  // namespace cellmirror::app
