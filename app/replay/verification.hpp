// A recording is run again and compared tick by tick: the report of `replay --verify`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/replay/engine_replay.hpp"
#include "ipc/record/reader.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

struct Verification {
  std::optional<ReplayDifference> difference;
  ReplayCounts counts;
  std::vector<std::string> not_compared;  // haptic devices that were open before a recording of an older version began
  double took_s = 0;
  std::string other_build;          // why a difference may not mean anything; empty: the same program and processor
  std::uint64_t lost_messages = 0;  // by their numbers

  [[nodiscard]] bool equal() const { return !difference && counts.ticks > 0 && counts.not_sound == 0; }
};

// What differs between the program that recorded and this one; empty: nothing.
[[nodiscard]] std::string other_build(const mcap::Reader& reader);
// Between the times of `filter`, whose topics do not count. Fails where the recording has no inputs.
[[nodiscard]] Result<Verification> verify(mcap::Reader& reader, mcap::Filter filter, const Clock& clock);
[[nodiscard]] std::string verification_text(const Verification& verification);
[[nodiscard]] std::string verification_json(const Verification& verification);

}  // namespace cellmirror::app
