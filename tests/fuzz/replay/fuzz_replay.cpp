// Any bytes as a message of recorded inputs: commands, chains, start states and ticks, run through an engine.
#include <cstddef>
#include <cstdint>
#include <span>

#include "app/replay/engine_replay.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  app::EngineReplay replay;
  replay.take(std::as_bytes(std::span(data, size)));
  const app::ReplayCounts& counts = replay.counts();
  CELLMIRROR_EXPECTS(counts.ticks <= size && counts.skipped <= size && counts.starts <= size);
  return 0;
}
