// Gives what the tick takes to the recordings, so that they can be run again: a message of some tens of milliseconds on
// /inputs/ticks, a start state at the beginning of each file and every ten seconds.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/recorder/recording_hub.hpp"
#include "app/recorder/topic.hpp"
#include "app/snapshot/cell_state.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/input_tap.hpp"

namespace cellmirror::app {

// The recorder's thread.
class InputRecorder {
 public:
  // Both outlive it.
  InputRecorder(engine::InputTap& tap, RecordingHub& hub);
  ~InputRecorder();
  InputRecorder(const InputRecorder&) = delete;
  InputRecorder& operator=(const InputRecorder&) = delete;

  // To be called every few milliseconds while something is recorded, and now and then else. `cell_state` may be null.
  void look(Timestamp now, const CellState* cell_state);

 private:
  void ask_for_start(Timestamp now);
  void take_names(const CellState& cell_state);
  void put(Timestamp now);
  [[nodiscard]] std::uint64_t drops() const;

  engine::InputTap& tap_;
  RecordingHub& hub_;
  TopicPtr topic_;
  std::vector<std::byte> message_;
  std::vector<std::byte> names_;
  std::shared_ptr<const CompiledCell> named_cell_;
  bool names_due_ = false;
  std::uint64_t known_files_ = 0;
  std::uint64_t known_drops_ = 0;
  std::uint64_t known_lost_ = 0;
  Timestamp last_put_;
  Timestamp last_look_;
  Timestamp last_start_;
};

}  // namespace cellmirror::app
