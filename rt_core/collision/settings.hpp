// What a cell file ([collision]) and SET_COLLPAR say about collision tests. Plain data, SI.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cellmirror::collision {

// A rule about all pairs with one body in the branch of `a` and the other in the branch of `b` (dotted paths of nodes;
// a path means the node and everything below it by name; empty: everything; the cell's name: its own geometry). The
// last matching rule counts.
struct PairRule {
  enum class Kind : std::uint8_t { ignore, test };  // `test` overrides what was derived
  std::string a;
  std::string b;
  Kind kind = Kind::ignore;
  std::string reason;  // for people; may be empty
};

struct Settings {
  bool active = true;
  double warning_distance_m = 0.05;
  std::vector<PairRule> rules;
};

}  // namespace cellmirror::collision
