#include "app/playback/played_recording.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/base/wall_clock.hpp"

namespace cellmirror::app {

Result<std::unique_ptr<PlayedRecording>> PlayedRecording::open(const PlayOptions& options, const Clock& wall) {
  auto run = RecordedRun::open(options.file, options.limits);
  if (!run) return std::unexpected(run.error());
  std::unique_ptr<PlayedRecording> out(new PlayedRecording(*std::move(run), wall));
  PlaybackControl::Range range = out->run_->range();
  const auto at = [&](double s) {
    return Timestamp{out->run_->start_ns()} - range.utc + Nanoseconds(std::llround(std::min(1e9 * s, 1e18)));
  };
  const PlaybackControl::Range all = range;
  if (options.from_s > 0) range.from = std::max(all.from, at(options.from_s));
  if (options.to_s) range.to = std::min(all.to, at(*options.to_s));
  if (range.from > all.to || range.to < range.from)
    return fail("nothing is recorded between these times", "recording info says how long it is");
  set_wall_clock_offset(range.utc);
  out->control_ = std::make_unique<PlaybackControl>(range, options.file.string(), options.speed, options.playing);
  return out;
}

TickPublication& PlayedRecording::make_publication(std::size_t robots, const Board<CellState>& board) {
  ticks_ = std::make_unique<TickPublication>(robots, board);
  player_ = std::make_unique<Player>(*run_, *control_, *ticks_, wall_);
  return *ticks_;
}

}  // namespace cellmirror::app
