// A film of the running gateway: pictures at a steady rate.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "app/pictures/film_sink.hpp"
#include "app/pictures/snapshot_request.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

struct FilmTotals {
  std::uint64_t frames = 0;    // of the film
  std::uint64_t repeated = 0;  // of these: shown again because the next one was late
  double longest_s = 0;        // that a picture took
};

// Frame i shows the cell at i / rate_hz after the start. A picture that comes too late for its place is preceded by the
// one before, so that the film keeps the time. Ends early where `stop` says so.
[[nodiscard]] Result<FilmTotals> take_film(const std::function<Result<SnapshotAnswer>()>& take, double seconds_long,
                                           double rate_hz, FilmSink& sink, const std::function<bool()>& stop);

}  // namespace cellmirror::app
