#include "app/pictures/film.hpp"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "rt_core/base/time.hpp"

namespace cellmirror::app {

Result<FilmTotals> take_film(const std::function<Result<SnapshotAnswer>()>& take, double seconds_long, double rate_hz,
                             FilmSink& sink, const std::function<bool()>& stop) {
  const SystemClock clock;
  const auto frames = static_cast<std::uint64_t>(std::max(1.0, std::round(seconds_long * rate_hz)));
  const double period_s = 1.0 / rate_hz;
  FilmTotals totals;
  const Timestamp start = clock.now();
  while (totals.frames < frames && !stop()) {
    const Timestamp due =
        start + Nanoseconds(static_cast<std::int64_t>(1e9 * period_s * static_cast<double>(totals.frames)));
    std::this_thread::sleep_for(due - clock.now());
    const Timestamp asked = clock.now();
    auto picture = take();
    if (!picture) return std::unexpected(picture.error());
    const double late_s = seconds(clock.now() - due);
    totals.longest_s = std::max(totals.longest_s, seconds(clock.now() - asked));
    // For all places that have passed meanwhile.
    const auto places = std::min(frames - totals.frames, 1 + static_cast<std::uint64_t>(late_s / period_s));
    for (std::uint64_t i = 0; i < places; ++i) {
      if (const auto added = sink.add(picture->bytes); !added) return std::unexpected(added.error());
    }
    totals.frames += places;
    totals.repeated += places - 1;
  }
  return totals;
}

}  // namespace cellmirror::app
