// Plays a recording: takes the place of the loop. A thread, not real time, publishes what each tick had published, when
// the recorded time has come.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

#include "app/playback/playback_control.hpp"
#include "app/playback/recorded_run.hpp"
#include "app/playback/tick_publication.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

class Player {
 public:
  // All outlive it. `wall`: the machine's time.
  Player(RecordedRun& run, PlaybackControl& control, TickPublication& ticks, const Clock& wall)
      : run_(run), control_(control), ticks_(ticks), wall_(wall) {}
  ~Player() { stop(); }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  // Publishes the first state before it returns: nobody sees a cell without robots. Fails where there is none.
  Result<void> start();
  void stop();

 private:
  void loop(const std::stop_token& stop);
  // From `from` on until the end of the range or a seek.
  void play(Timestamp from, const std::stop_token& stop);
  // Waits until the time of a tick is due. False: something else is wanted.
  bool wait_for(Timestamp tick, const std::stop_token& stop);
  void publish();

  RecordedRun& run_;
  PlaybackControl& control_;
  TickPublication& ticks_;
  const Clock& wall_;
  std::size_t told_missing_ = 0;
  std::jthread thread_;
};

}  // namespace cellmirror::app
