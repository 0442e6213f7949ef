// A recording that takes the place of the loop and of all devices of a gateway: what the gateway's wiring needs of it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/playback/playback_control.hpp"
#include "app/playback/player.hpp"
#include "app/playback/recorded_run.hpp"
#include "app/playback/tick_publication.hpp"

namespace cellmirror::app {

struct PlayOptions {
  std::filesystem::path file;
  double from_s = 0;                // after the start of the recording
  std::optional<double> to_s = {};  // likewise; none: to its end
  double speed = 1;
  bool playing = true;  // from the start
  mcap::Limits limits = {};
};

class PlayedRecording {
 public:
  // Reads where it begins and ends. From now on UTC is that of the recording, in the whole process. `wall` outlives it.
  [[nodiscard]] static Result<std::unique_ptr<PlayedRecording>> open(const PlayOptions& options, const Clock& wall);
  PlayedRecording(const PlayedRecording&) = delete;
  PlayedRecording& operator=(const PlayedRecording&) = delete;
  ~PlayedRecording() = default;

  [[nodiscard]] const RecordedRun& run() const { return *run_; }
  // Before start(): then its thread reads.
  [[nodiscard]] RecordedRun& run() { return *run_; }
  [[nodiscard]] PlaybackControl& control() { return *control_; }
  [[nodiscard]] const PlaybackControl& control() const { return *control_; }
  // The recorded time.
  [[nodiscard]] const Clock& clock() const { return control_->clock(); }
  [[nodiscard]] double rate_hz() const { return run_->rate_hz(); }

  // In this order. For a cell of at most so many robots; `board` outlives it.
  TickPublication& make_publication(std::size_t robots, const Board<CellState>& board);
  [[nodiscard]] Result<void> start() { return player_->start(); }
  void stop() {
    if (player_) player_->stop();
  }

 private:
  PlayedRecording(std::unique_ptr<RecordedRun> run, const Clock& wall) : run_(std::move(run)), wall_(wall) {}

  std::unique_ptr<RecordedRun> run_;
  const Clock& wall_;
  std::unique_ptr<PlaybackControl> control_;
  std::unique_ptr<TickPublication> ticks_;
  std::unique_ptr<Player> player_;
};

}  // namespace cellmirror::app
