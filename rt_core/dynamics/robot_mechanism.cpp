#include "rt_core/dynamics/robot_mechanism.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace cellmirror::dynamics {

namespace {

constexpr std::int32_t kNone = -1;

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

Inertia inertia_of(const BodyInertia& body) { return {body.mass_kg, body.p_NC, body.I_C}; }

Drive drive_of(const JointDrive& drive) {
  return {drive.gear_ratio, drive.rotor_inertia, drive.coulomb_friction, drive.viscous_friction, drive.max_effort};
}

// What is the same for all robots: on which joint each node sits, and where.
struct CarriedNodes {
  explicit CarriedNodes(const CompiledCell& cell) : carrier(cell.size(), kNone), X_CN(cell.X_PF) {
    for (std::size_t i = 0; i < cell.size(); ++i) {
      const std::int32_t up = cell.parent[i];
      if (up < 0) continue;
      const bool is_joint = cell.joint_of[at(up)] >= 0;
      carrier[i] = is_joint ? up : carrier[at(up)];
      if (!is_joint) X_CN[i] = X_CN[at(up)] * cell.X_PF[i];
    }
  }
  std::vector<std::int32_t> carrier;  // the next joint node above a node; none: the world
  std::vector<Pose> X_CN;             // in the carrier's frame (behind its motion), or in the world
};

class Builder {
 public:
  Builder(const CompiledCell& cell, const CarriedNodes& nodes, const CompiledRobot& robot)
      : cell_(cell), nodes_(nodes), robot_(robot) {
    made_.slot = robot.slot;
  }

  RobotMechanism build() {
    choose_joints();
    collect_masses();
    if (!has_masses_) return std::move(made_);
    if (auto mechanism = make()) {
      made_.mechanism = std::move(*mechanism);
      if (has_load_) made_.load = make_load();
    } else {
      made_.why_not = mechanism.error().text();
    }
    return std::move(made_);
  }

 private:
  [[nodiscard]] const CompiledJoint& joint_at(std::int32_t node) const {
    return cell_.joints[at(cell_.joint_of[at(node)])];
  }
  [[nodiscard]] bool is_own(std::int32_t node) const { return joint_at(node).slot == robot_.slot; }

  // All joint nodes of the robot, above it and behind it, in the order of the cell: parents first.
  void choose_joints() {
    std::vector<bool> above(cell_.size(), false);
    std::vector<bool> moved(cell_.size(), false);  // by a joint of the robot
    for (std::size_t i = cell_.fixed_count; i < cell_.size(); ++i) {
      if (cell_.joint_of[i] < 0 || joint_at(static_cast<std::int32_t>(i)).slot != robot_.slot) continue;
      for (std::int32_t up = nodes_.carrier[i]; up >= 0 && !above[at(up)]; up = nodes_.carrier[at(up)]) {
        above[at(up)] = true;
      }
    }
    link_of_.assign(cell_.size(), kNone);
    feels_.assign(cell_.size(), false);
    for (std::size_t i = cell_.fixed_count; i < cell_.size(); ++i) {
      if (cell_.joint_of[i] < 0) continue;
      const std::int32_t carrier = nodes_.carrier[i];
      moved[i] = is_own(static_cast<std::int32_t>(i)) || (carrier >= 0 && moved[at(carrier)]);
      feels_[i] = moved[i];
      if (!moved[i] && !above[i]) continue;
      link_of_[i] = static_cast<std::int32_t>(made_.link_nodes.size());
      made_.link_nodes.push_back(static_cast<std::int32_t>(i));
    }
  }

  void collect_masses() {
    inertia_.resize(made_.link_nodes.size());
    load_.resize(made_.link_nodes.size());
    for (const CompiledInertia& body : cell_.inertia) {
      const bool is_joint = cell_.joint_of[at(body.node)] >= 0;
      const std::int32_t carrier = is_joint ? body.node : nodes_.carrier[at(body.node)];
      if (carrier < 0 || !feels_[at(carrier)]) continue;
      const Inertia in_node = inertia_of(body.inertia);
      const Inertia in_link = is_joint ? in_node : moved(in_node, nodes_.X_CN[at(body.node)]);
      const std::size_t link = at(link_of_[at(carrier)]);
      inertia_[link] = joined(inertia_[link], in_link);
      if (is_own(carrier) && named_in_model(body.node)) {
        made_.model_kg += in_node.mass;
        has_masses_ = has_masses_ || !is_empty(in_node);
      } else {
        made_.payload_kg += in_node.mass;
        load_[link] = joined(load_[link], in_link);
        has_load_ = has_load_ || !is_empty(in_node);
      }
    }
  }

  [[nodiscard]] bool named_in_model(std::int32_t node) const {
    for (std::int32_t up = node; up >= 0; up = cell_.naming_parent[at(up)]) {
      if (up == robot_.component) return true;
    }
    return false;
  }

  // Of the joint that drives the node of a link.
  std::uint8_t variable_of(const CompiledJoint& joint) {
    const auto known = std::ranges::find_if(made_.variables, [&](const VariableSource& source) {
      return source.slot == joint.slot && source.joint == joint.joint;
    });
    return static_cast<std::uint8_t>(known - made_.variables.begin());
  }

  void choose_variables() {
    for (std::size_t i = 0; i < robot_.joint_names.size(); ++i) {
      made_.variables.push_back({static_cast<std::uint8_t>(robot_.slot), static_cast<std::uint8_t>(i)});
    }
    std::vector<VariableSource> others;
    for (const std::int32_t node : made_.link_nodes) {
      if (!is_own(node)) others.push_back({joint_at(node).slot, joint_at(node).joint});
    }
    const auto key = [](const VariableSource& source) { return std::pair(source.slot, source.joint); };
    std::ranges::sort(others, {}, key);
    const auto twice = std::ranges::unique(others, {}, key);
    others.erase(twice.begin(), twice.end());
    made_.variables.insert(made_.variables.end(), others.begin(), others.end());
  }

  [[nodiscard]] Link link_at(std::int32_t node) {
    const CompiledJoint& joint = joint_at(node);
    const std::int32_t carrier = nodes_.carrier[at(node)];
    Link link;
    link.parent = carrier < 0 ? kNone : link_of_[at(carrier)];
    link.X_PJ = nodes_.X_CN[at(node)];
    link.axis = joint.axis;
    link.kind = joint.kind;
    link.variable = variable_of(joint);
    link.multiplier = joint.multiplier;
    link.offset = joint.offset;
    link.inertia = inertia_[at(link_of_[at(node)])];
    return link;
  }

  Result<Mechanism> make() {
    choose_variables();
    if (made_.link_nodes.size() > kMaxLinks || made_.variables.size() > kMaxJointsPerRobot) {
      return fail(
          fmt::format("{} joints move it, those of robots that carry it or that it carries included; forces are "
                      "computed for at most {}",
                      made_.variables.size(), kMaxJointsPerRobot));
    }
    std::vector<Link> links;
    for (const std::int32_t node : made_.link_nodes) links.push_back(link_at(node));
    for (const std::int32_t node : robot_.joint_nodes) made_.joint_links.push_back(link_of_[at(node)]);
    std::vector<Drive> drives;
    for (const VariableSource& source : made_.variables) {
      const CompiledRobot* robot = cell_.robot(source.slot);
      const bool known = robot != nullptr && source.joint < robot->drives.size();
      drives.push_back(known ? drive_of(robot->drives[source.joint]) : Drive{});
    }
    const bool flange_is_joint = cell_.joint_of[at(robot_.flange)] >= 0;
    const std::int32_t tip = flange_is_joint ? robot_.flange : nodes_.carrier[at(robot_.flange)];
    const Pose X_LF = flange_is_joint ? Pose::Identity() : nodes_.X_CN[at(robot_.flange)];
    return Mechanism::make(drives, links, tip < 0 ? kNone : link_of_[at(tip)], X_LF * robot_.X_FT);
  }

  // Of what passed the checks of the whole: no drives, since the wrenches of the links do not depend on them.
  [[nodiscard]] std::optional<Mechanism> make_load() const {
    const Mechanism& whole = *made_.mechanism;
    std::vector<Link> links(whole.links().begin(), whole.links().end());
    for (std::size_t i = 0; i < links.size(); ++i) links[i].inertia = load_[i];
    const std::vector<Drive> drives(whole.variable_count());
    auto load = Mechanism::make(drives, links, whole.tip_link(), whole.X_LT());
    return load ? std::optional<Mechanism>(std::move(*load)) : std::nullopt;
  }

  const CompiledCell& cell_;
  const CarriedNodes& nodes_;
  const CompiledRobot& robot_;
  RobotMechanism made_;
  std::vector<std::int32_t> link_of_;  // by joint node
  std::vector<bool> feels_;            // by joint node: the robot carries what is attached there
  std::vector<Inertia> inertia_;       // by link
  std::vector<Inertia> load_;          // by link: the part of it that does not belong to the robot's model
  bool has_masses_ = false;
  bool has_load_ = false;
};

bool same(const Pose& a, const Pose& b) { return a.matrix() == b.matrix(); }

bool same(const CompiledJoint& a, const CompiledJoint& b) {
  return a.axis == b.axis && a.multiplier == b.multiplier && a.offset == b.offset && a.kind == b.kind &&
         a.slot == b.slot && a.joint == b.joint;
}

bool same(const JointDrive& a, const JointDrive& b) {
  return a.gear_ratio == b.gear_ratio && a.rotor_inertia == b.rotor_inertia &&
         a.coulomb_friction == b.coulomb_friction && a.viscous_friction == b.viscous_friction &&
         a.max_effort == b.max_effort;
}

bool same(const CompiledInertia& a, const CompiledInertia& b) {
  return a.node == b.node && a.inertia.mass_kg == b.inertia.mass_kg && a.inertia.p_NC == b.inertia.p_NC &&
         a.inertia.I_C == b.inertia.I_C;
}

bool same(const CompiledRobot& a, const CompiledRobot& b);

template <class List>
bool all_same(const List& a, const List& b) {
  return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return same(x, y); });
}

bool same(const CompiledRobot& a, const CompiledRobot& b) {
  return a.id == b.id && a.slot == b.slot && a.joint_nodes == b.joint_nodes && a.joint_names == b.joint_names &&
         a.component == b.component && a.flange == b.flange && same(a.X_FT, b.X_FT) && all_same(a.drives, b.drives);
}

}  // namespace

std::vector<RobotMechanism> robot_mechanisms(const CompiledCell& cell) {
  const CarriedNodes nodes(cell);
  std::vector<RobotMechanism> mechanisms;
  mechanisms.reserve(cell.robots.size());
  for (const CompiledRobot& robot : cell.robots) mechanisms.push_back(Builder(cell, nodes, robot).build());
  return mechanisms;
}

bool same_masses(const CompiledCell& a, const CompiledCell& b) {
  if (&a == &b) return true;
  return a.paths == b.paths && a.parent == b.parent && a.naming_parent == b.naming_parent && a.joint_of == b.joint_of &&
         all_same(a.inertia, b.inertia) && all_same(a.robots, b.robots) && all_same(a.joints, b.joints) &&
         all_same(a.X_PF, b.X_PF);
}

}  // namespace cellmirror::dynamics
