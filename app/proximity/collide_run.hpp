// Computes collisions and distances for posture after posture and adds up what was found.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "app/proximity/envelope.hpp"
#include "app/proximity/postures.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/collision/checker.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

using BodyPair = std::pair<std::uint32_t, std::uint32_t>;

struct TouchTotals {
  std::uint64_t frames = 0;
  double deepest_m = 0;
  std::uint64_t deepest_frame = 0;
};

struct CollideTotals {
  std::uint64_t frames = 0;
  std::uint64_t frames_touching = 0;
  std::uint64_t frames_in_doubt = 0;
  std::map<BodyPair, TouchTotals> touching;
  // The nearest of all; in the first frame in which it was that near.
  std::optional<NearPair> nearest;
  std::uint64_t nearest_frame = 0;
  HistogramSnapshot times;  // of poses and check, without reading and printing
  Envelope distances;       // m, a value a frame
  Envelope depths;          // -m, a value a frame that touches
  collision::CheckCounters counters;
};

struct CollideInput {
  std::shared_ptr<const CompiledCell> cell;
  std::shared_ptr<const collision::PairTable> pairs;
  collision::Settings settings;
};

// Called with each frame, numbered from 1; the state is valid until it returns.
using FrameSink = std::function<void(std::uint64_t frame, const ProximityState& state)>;

[[nodiscard]] Result<CollideTotals> run_collide(const CollideInput& input, Postures& postures, const FrameSink& sink);

}  // namespace cellmirror::app
