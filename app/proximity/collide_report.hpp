// What `cellmirror collide` prints: a JSON document frame by frame, or lines for people; and a picture.
#pragma once

#include <cstdint>
#include <cstdio>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "app/plot/figure.hpp"
#include "app/proximity/collide_run.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/collision/pairs.hpp"

namespace cellmirror::app {

struct CollideHeading {
  std::string cell;
  double warning_distance_m = 0;
  std::uint64_t frames = 0;
};

// The document of docs/collisions.md.
class CollideJson {
 public:
  CollideJson(const CollideHeading& heading, const collision::PairTable& pairs, std::FILE* out);
  void frame(const ProximityState& state);
  void end(const CollideTotals& totals);

 private:
  // What is written so far, then `behind`.
  void hand_out(std::string_view behind = {});

  const collision::PairTable& pairs_;
  std::FILE* out_;
  JsonWriter json_{JsonWriter::kExact};
};

// Frame by frame where there are few; else the frames in which bodies touch and part, and a summary.
class CollideText {
 public:
  CollideText(const CollideHeading& heading, const collision::PairTable& pairs, std::FILE* out);
  void frame(std::uint64_t number, const ProximityState& state);
  void end(const CollideTotals& totals);

 private:
  void whole_frame(std::uint64_t number, const ProximityState& state);
  void changes(std::uint64_t number, const ProximityState& state);
  void change(const std::string& line);
  void touching_summary(const CollideTotals& totals);
  void left_out(const collision::PairTable& pairs);
  [[nodiscard]] std::string pair_text(std::uint32_t a, std::uint32_t b) const;

  const CollideHeading heading_;
  const std::vector<std::string> names_;
  std::FILE* out_;
  std::set<BodyPair> touching_;
  std::uint64_t changes_ = 0;
};

[[nodiscard]] plot::Figure figure(const CollideHeading& heading, const CollideTotals& totals);

}  // namespace cellmirror::app
