// Which bodies there are in a cell, which pairs of them are tested, and why the others are not.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/settings.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror::collision {

struct BodyPart {
  std::shared_ptr<const geometry::Solid> solid;
  Pose X_NG = Pose::Identity();  // in the node
};

// All geometry of one node that collides.
struct Body {
  std::int32_t node = 0;  // in the compiled cell
  std::vector<BodyPart> parts;
};

enum class PairState : std::uint8_t {
  tested,
  rigid,        // no joint between them: they cannot move against each other
  neighbours,   // links of one robot with one joint between them
  always,       // proved: they touch in every posture within the joint ranges
  never,        // links of one robot; proved: they stay apart in every posture within the joint ranges
  rule_ignore,  // a rule of the cell file or of SET_COLLPAR
  rule_test,    // tested because of a rule
};

[[nodiscard]] constexpr bool is_tested(PairState state) {
  return state == PairState::tested || state == PairState::rule_test;
}

struct Pair {
  std::uint32_t a = 0;  // index of a body; a < b
  std::uint32_t b = 0;
  PairState state = PairState::tested;
  std::string reason;  // for people: why the pair is left out, or a result of sampling that is not proved
};

// For one compiled cell. Immutable once made, shared between threads.
struct PairTable {
  std::uint64_t revision = 0;  // of the cell
  std::vector<Body> bodies;
  BodyNames names;          // by body
  BodyNames short_names;    // by body, for people and records: no other node of the cell is named so
  std::vector<Pair> pairs;  // every pair of bodies that could move against each other or is left out for a reason
                            // other than `rigid`; rigid pairs are only counted
  std::size_t rigid_pairs = 0;
  std::size_t triangles = 0;        // of all bodies together
  std::vector<std::string> doubts;  // geometry that should be tested and cannot be, in words
};

// Makes pair tables. Remembers its findings by component, so that neither the second robot of a kind nor the next
// revision of the cell is examined again. The results are the same on every machine. One thread; can take several
// seconds for a new kind of robot.
class PairDerivation {
 public:
  explicit PairDerivation(std::shared_ptr<geometry::SolidLibrary> solids);
  ~PairDerivation();

  // `beyond`: robots that have left their ranges (RangeWatch). Nothing is proved about them, so that their pairs are
  // left out only as `rigid`, `neighbours` or by a rule.
  [[nodiscard]] std::shared_ptr<const PairTable> derive(const CompiledCell& cell, const Settings& settings,
                                                        const std::bitset<kMaxRobots>& beyond = {});

 private:
  friend class PairClassifier;
  struct Memory;
  std::shared_ptr<geometry::SolidLibrary> solids_;
  std::unique_ptr<Memory> memory_;
};

}  // namespace cellmirror::collision
