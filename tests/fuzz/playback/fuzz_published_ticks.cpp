// Any bytes as a message of recorded inputs, from which the published states are put together.
#include <cstddef>
#include <cstdint>
#include <span>

#include "app/playback/published_ticks.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  app::PublishedTicks ticks;
  std::size_t count = 0;
  const auto more = ticks.take(std::as_bytes(std::span(data, size)), [&](Timestamp time, bool /*behind_gap*/) {
    const engine::TickState& state = ticks.state();
    CELLMIRROR_EXPECTS(state.time == time && time.ns > 0 && state.robots.size() <= kMaxRobots);
    return ++count < 1000;
  });
  CELLMIRROR_EXPECTS(count <= size && (more.has_value() || !more.error().what.empty()));
  return 0;
}
