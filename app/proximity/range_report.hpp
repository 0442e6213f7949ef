// What `cellmirror range` prints: a JSON document frame by frame, or lines for people; and a picture.
#pragma once

#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>

#include "app/plot/figure.hpp"
#include "app/proximity/range_run.hpp"
#include "rt_core/base/json_writer.hpp"

namespace cellmirror::app {

struct RangeHeading {
  std::string cell;
  std::uint64_t frames = 0;
};

// The document of docs/ranging.md.
class RangeJson {
 public:
  RangeJson(const RangeHeading& heading, const CompiledCell& cell, std::FILE* out);
  void frame(std::span<const RangeReading> readings);
  void end(const RangeTotals& totals);

 private:
  // What is written so far, then `behind`.
  void hand_out(std::string_view behind = {});

  const CompiledCell& cell_;
  std::FILE* out_;
  JsonWriter json_{JsonWriter::kExact};
};

// Frame by frame where there are few; else a line a sensor.
class RangeText {
 public:
  RangeText(const RangeHeading& heading, const CompiledCell& cell, std::FILE* out);
  void frame(std::uint64_t number, std::span<const RangeReading> readings);
  void end(const RangeTotals& totals);

 private:
  const RangeHeading heading_;
  const CompiledCell& cell_;
  std::FILE* out_;
};

[[nodiscard]] plot::Figure figure(const RangeHeading& heading, const CompiledCell& cell, const RangeTotals& totals);

}  // namespace cellmirror::app
