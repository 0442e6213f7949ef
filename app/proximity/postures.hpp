// The postures for which `collide` and `range` compute: the rows of a file, or the start posture of the cell.
#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/posture_file.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/collision/mechanism.hpp"

namespace cellmirror::app {

// Called now and then: `done` of `total` bytes are read.
using ReadProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

class Postures {
 public:
  // Reads the whole of `file` once, so that all errors are reported before anything is computed; the rows are not
  // kept. An empty name: one posture, the start. Nothing where there is an error.
  static std::unique_ptr<Postures> open(const std::string& file, const Cell& cell, Diagnostics& diagnostics,
                                        const ReadProgress& progress = {});

  [[nodiscard]] std::uint64_t count() const { return count_; }
  // Goes to the next posture; false: there is none. Joints that have no column are at their start positions. An error:
  // the file is no longer what it was.
  Result<bool> next();
  [[nodiscard]] std::span<const JointValues> q() const { return q_; }  // by slot
  // Robots that are outside of their joint ranges in at least one posture of the file.
  [[nodiscard]] const collision::SlotSet& beyond() const { return ranges_.beyond(); }

 private:
  Postures(std::string file, const Cell& cell);
  bool check(Diagnostics& diagnostics, const ReadProgress& progress);
  bool rewind();

  std::string file_;
  const Cell& cell_;
  std::ifstream in_;
  Diagnostics again_;  // of the second reading
  std::optional<PostureReader> reader_;
  std::vector<JointValues> q_;
  collision::RangeWatch ranges_;
  std::uint64_t count_ = 1;
  std::uint64_t given_ = 0;
};

}  // namespace cellmirror::app
