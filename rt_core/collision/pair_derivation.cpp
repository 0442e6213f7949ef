#include <fmt/core.h>

#include <array>
#include <map>
#include <optional>
#include <utility>

#include "rt_core/cell/short_names.hpp"
#include "rt_core/collision/bodies.hpp"
#include "rt_core/collision/bounds.hpp"
#include "rt_core/collision/mechanism.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/collision/rules.hpp"
#include "rt_core/collision/sampling.hpp"

namespace cellmirror::collision {

// Results keyed by the relative motion and the shapes, bit by bit. The shapes are kept alive, so that no other one gets
// the address of one that is known.
struct PairDerivation::Memory {
  struct Entry {
    PairFinding finding;
    std::vector<std::shared_ptr<const geometry::MeshTree>> kept;
  };
  std::map<std::string, Entry> entries;
};

namespace {

// Beyond this the oldest knowledge is not worth its memory.
constexpr std::size_t kMaxRemembered = 20'000;

void append_shape(std::string& bytes, const Body& body) {
  const auto append = [&bytes](const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
  };
  const std::size_t parts = body.parts.size();
  append(&parts, sizeof parts);
  for (const BodyPart& part : body.parts) {
    const void* tree = part.solid->tree.get();
    append(&tree, sizeof tree);
    append(&part.solid->shape, sizeof part.solid->shape);
    append(part.solid->size.data(), 3 * sizeof(double));
    append(part.X_NG.data(), 16 * sizeof(double));
  }
}

// Some postures of the whole cell, to see cheaply which pairs cannot be touching always.
class ProximityTest {
 public:
  ProximityTest(const CompiledCell& cell, const std::vector<Body>& bodies) {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const double fraction = 0.2 + 0.2 * static_cast<double>(i);
      std::vector<JointValues> q(kMaxRobots);
      for (const CompiledRobot& robot : cell.robots) {
        for (std::size_t joint = 0; joint < robot.joint_names.size(); ++joint) {
          const SampledRange range = sampled_range(robot, joint);
          // Odd joints run the other way, so that the arms do not only stretch and fold.
          const double along = joint % 2 == 0 ? fraction : 1.0 - fraction;
          q[robot.slot][joint] = range.lower + along * (range.upper - range.lower);
        }
      }
      CellPoses poses;
      compute_poses(cell, q, poses);
      place(bodies, poses, boxes_[i]);
    }
  }

  [[nodiscard]] bool may_touch_always(std::size_t a, std::size_t b) const {
    for (const auto& boxes : boxes_) {
      if (lower_bound(boxes[a], boxes[b], 0.0) > 0.0) return false;
    }
    return true;
  }

 private:
  static void place(const std::vector<Body>& bodies, const CellPoses& poses, std::vector<PlacedBox>& boxes) {
    for (const Body& body : bodies) {
      const OrientedBox box = box_around(body);
      PlacedBox& placed = boxes.emplace_back();
      placed.half = box.half;
      placed.radius = ball_around(body).radius;
      placed.place(poses.X_WN[static_cast<std::size_t>(body.node)], box);
    }
  }

  std::array<std::vector<PlacedBox>, 4> boxes_;
};

}  // namespace

// One run of derive().
class PairClassifier {
 public:
  PairClassifier(const CompiledCell& cell, const Settings& settings, const PairTable& table,
                 PairDerivation::Memory& memory, const SlotSet& beyond)
      : cell_(cell),
        table_(table),
        memory_(memory),
        mechanism_(cell, beyond),
        rules_(settings.rules, table),
        proximity_test_(cell, table.bodies) {}

  // Nothing: rigid.
  std::optional<Pair> classifier(std::uint32_t a, std::uint32_t b) {
    const std::int32_t node_a = table_.bodies[a].node;
    const std::int32_t node_b = table_.bodies[b].node;
    if (mechanism_.rigid(node_a, node_b)) return std::nullopt;
    Pair pair{a, b, PairState::tested, {}};
    if (const PairRule* rule = rules_.last_that_fits(a, b)) {
      pair.state = rule->kind == PairRule::Kind::ignore ? PairState::rule_ignore : PairState::rule_test;
      pair.reason = rule_text(*rule);
      return pair;
    }
    const std::int32_t robot = mechanism_.link_of(node_a);
    const bool one_robot = robot >= 0 && robot == mechanism_.link_of(node_b);
    const std::int32_t joint = one_robot ? mechanism_.single_joint(node_a, node_b) : -1;
    if (joint >= 0) {
      pair.state = PairState::neighbours;
      pair.reason = fmt::format("neighbours in one robot: with only the joint {} between them",
                                (*cell_.paths)[static_cast<std::size_t>(joint)]);
      return pair;
    }
    if (one_robot || proximity_test_.may_touch_always(a, b)) {
      PairFinding finding = found(pair, one_robot);
      pair.state = finding.state;
      pair.reason = std::move(finding.reason);
    }
    return pair;
  }

 private:
  PairFinding found(const Pair& pair, bool one_robot) {
    const Body& a = table_.bodies[pair.a];
    const Body& b = table_.bodies[pair.b];
    const RelativeMotion motion = mechanism_.between(a.node, b.node);
    std::string key(1, one_robot ? '1' : '0');
    motion.append_signature(key);
    append_shape(key, a);
    append_shape(key, b);
    const auto known = memory_.entries.find(key);
    if (known != memory_.entries.end()) return known->second.finding;
    if (memory_.entries.size() >= kMaxRemembered) memory_.entries.clear();
    PairDerivation::Memory::Entry entry{examine(motion, a, b, one_robot), {}};
    for (const Body* body : {&a, &b}) {
      for (const BodyPart& part : body->parts) {
        if (part.solid->tree) entry.kept.push_back(part.solid->tree);
      }
    }
    return memory_.entries.emplace(std::move(key), std::move(entry)).first->second.finding;
  }

  const CompiledCell& cell_;
  const PairTable& table_;
  PairDerivation::Memory& memory_;
  Mechanism mechanism_;
  RuleFinder rules_;
  ProximityTest proximity_test_;
};

PairDerivation::PairDerivation(std::shared_ptr<geometry::SolidLibrary> solids)
    : solids_(std::move(solids)), memory_(std::make_unique<Memory>()) {}

PairDerivation::~PairDerivation() = default;

std::shared_ptr<const PairTable> PairDerivation::derive(const CompiledCell& cell, const Settings& settings,
                                                        const SlotSet& beyond) {
  auto table = std::make_shared<PairTable>();
  table->revision = cell.revision;
  CollectedBodies found = collect_bodies(cell, *solids_);
  table->bodies = std::move(found.bodies);
  table->doubts = std::move(found.doubts);
  table->triangles = found.triangles;
  auto names = std::make_shared<std::vector<std::string>>();
  std::vector<std::int32_t> nodes;
  for (const Body& body : table->bodies) {
    names->push_back(body_name(cell, body.node));
    nodes.push_back(body.node);
  }
  table->names = std::move(names);
  table->short_names = std::make_shared<const std::vector<std::string>>(short_body_names(cell, nodes));
  PairClassifier classifier(cell, settings, *table, *memory_, beyond);
  const auto count = static_cast<std::uint32_t>(table->bodies.size());
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) {
      auto pair = classifier.classifier(a, b);
      if (pair)
        table->pairs.push_back(std::move(*pair));
      else
        ++table->rigid_pairs;
    }
  }
  return table;
}

}  // namespace cellmirror::collision
