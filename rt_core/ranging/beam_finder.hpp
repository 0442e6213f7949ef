// Tells what interrupts light barriers. Private to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/geometry/proximity.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/ports/light_barrier.hpp"
#include "rt_core/ranging/seen_parts.hpp"

namespace cellmirror::ranging {

class BeamFinder {
 public:
  void set_barriers(std::vector<LightBarrier> barriers) { barriers_ = std::move(barriers); }
  // The cell has changed; `parts` are its parts.
  void adopt(const CompiledCell& cell, const SeenParts& parts);
  // In the order of the barriers; `parts` are where `poses` have them, `short_names` are theirs. Valid until the next
  // call.
  std::span<const BarrierReading> read(const CompiledCell& cell, const CellPoses& poses, const SeenParts& parts,
                                       std::span<const std::string> short_names, Timestamp posture_time);

 private:
  struct Beam {
    std::int32_t from = -1;  // nodes; -1: not there
    std::int32_t to = -1;
    geometry::Solid solid;                       // along z, centred
    double length = 0;                           // of `solid`, m
    std::vector<std::uint8_t> housing;           // by part: of the emitter or the receiver
    std::vector<geometry::ProximityHint> hints;  // by part
    std::size_t last = 0;                        // the part that interrupted it last
  };

  void read(Beam& beam, const LightBarrier& barrier, const CompiledCell& cell, const CellPoses& poses,
            const SeenParts& parts, std::span<const std::string> short_names, BarrierReading& out);
  [[nodiscard]] static bool meets(Beam& beam, const Pose& X_WB, const SeenParts& parts, std::size_t part);

  std::vector<LightBarrier> barriers_;
  std::vector<Beam> beams_;
  std::vector<BarrierReading> readings_;
};

}  // namespace cellmirror::ranging
