#include "tests/unit/dynamics/peer_arms.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "config/parse.hpp"

namespace cellmirror::dynamics {

namespace {

class OneComponent final : public ComponentSource {
 public:
  explicit OneComponent(const Component& component) : component_(std::make_shared<const Component>(component)) {}
  Result<std::shared_ptr<const Component>> component(std::string_view /*file*/) override { return component_; }

 private:
  std::shared_ptr<const Component> component_;
};

std::string inertial(double mass, const Eigen::Vector3d& c, const Eigen::Matrix3d& I) {
  return fmt::format(
      "<inertial><origin xyz=\"{} {} {}\"/><mass value=\"{}\"/><inertia ixx=\"{}\" iyy=\"{}\" izz=\"{}\" ixy=\"{}\" "
      "ixz=\"{}\" iyz=\"{}\"/></inertial>",
      c.x(), c.y(), c.z(), mass, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2));
}

struct PublishedBody {
  const char* axis;   // of its joint
  double y_offset;    // of its joint from the one before, m
  double mass;        // kg
  Eigen::Vector3d c;  // m
  double I11, I22, I33, I21;
};

// Tuerk 1990; Otter, Tuerk 1988. Of the first body only I22 is known, and only that matters: with any mass on its axis
// the efforts are the same. The last body is the hand, of which nothing is known but that the load hangs there.
std::string manutec_urdf(double payload_kg) {
  const PublishedBody bodies[] = {{"0 1 0", 0, 1.0, {0, 0, 0}, 1.16, 1.16, 1.16, 0},
                                  {"1 0 0", 0, 56.5, {0.172, 0.205, 0}, 2.58, 0.64, 2.73, -0.46},
                                  {"1 0 0", 0.5, 26.4, {0.064, -0.034, 0}, 0.279, 0.245, 0.413, -0.070},
                                  {"0 1 0", 0, 28.7, {0, 0.32, 0}, 1.67, 0.081, 1.67, 0},
                                  {"1 0 0", 0.73, 5.2, {0, 0.023, 0}, 1.25, 0.81, 1.53, 0},
                                  {"0 1 0", 0, payload_kg, {0, 0.12, 0}, 0.1, 0.1, 0.1, 0}};
  // DLR's y is the world's z, its z the world's -y.
  std::string text = "<robot name=\"R\"><link name=\"L0\"/>\n";
  for (int i = 0; i < 6; ++i) {
    const PublishedBody& body = bodies[i];
    Eigen::Matrix3d I = Eigen::Vector3d(body.I11, body.I22, body.I33).asDiagonal();
    I(0, 1) = I(1, 0) = body.I21;
    text += fmt::format("<link name=\"L{}\">{}</link>\n", i + 1, inertial(body.mass, body.c, I));
    const char* turn = i == 0 ? "1.5707963267948966 0 0" : "0 0 0";
    text += fmt::format(
        "<joint name=\"J_{0}\" type=\"continuous\"><parent link=\"L{1}\"/><child link=\"L{0}\"/><origin xyz=\"0 {2} "
        "0\" rpy=\"{3}\"/><axis xyz=\"{4}\"/></joint>\n",
        i + 1, i, body.y_offset, turn, body.axis);
  }
  return text + "</robot>\n";
}

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  if (text.str().empty()) throw std::runtime_error("cannot read " + file);
  return text.str();
}

std::string random_inertial(std::mt19937_64& random) {
  std::uniform_real_distribution<double> length(-0.5, 0.5);
  std::uniform_real_distribution<double> size(0.1, 1.0);
  const auto vector = [&](auto& of) {
    const double x = of(random);
    const double y = of(random);
    return Eigen::Vector3d(x, y, of(random));
  };
  // Of a box, turned.
  const double mass = 10 * size(random);
  const Eigen::Vector3d squares = vector(size).cwiseAbs2();
  const Eigen::Vector3d moments = mass / 12 * (squares.sum() * Eigen::Vector3d::Ones() - squares);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(6 * length(random), vector(length).normalized()).toRotationMatrix();
  return inertial(mass, vector(length), R * moments.asDiagonal() * R.transpose());
}

}  // namespace

RobotMechanism mechanism_of_component(const Component& component, std::vector<std::string>& joints) {
  auto root = std::make_shared<Component>();
  ComponentNode node;
  node.name = "Arm";
  node.abstract.emplace();
  node.abstract->file = "arm";
  root->nodes.push_back(std::move(node));
  Diagnostics diagnostics;
  auto cell = Cell::build(root, std::make_shared<OneComponent>(component), diagnostics);
  if (!cell) throw std::runtime_error(diagnostics.text());
  const auto compiled = cell->compile();
  if (compiled->robots.size() != 1) throw std::runtime_error("there is not one robot");
  joints = compiled->robots[0].joint_names;
  RobotMechanism made = robot_mechanisms(*compiled)[0];
  if (!made.mechanism) throw std::runtime_error("no mechanism: " + made.why_not);
  return made;
}

std::vector<PeerArm> arms_with_masses() {
  std::vector<PeerArm> arms;
  for (const SharedArm& shared : shared_arms()) {
    if (shared.urdf.find("<inertial") == std::string::npos) continue;
    PeerArm arm;
    arm.id = shared.id;
    arm.base = shared.base;
    arm.tip = shared.tip;
    arm.urdf = shared.urdf;
    arm.ours = mechanism_of_component(component_of_urdf(shared.urdf), arm.joints);
    arms.push_back(std::move(arm));
  }
  return arms;
}

PeerArm manutec_r3(double payload_kg) {
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  const std::string file =
      std::string(source == nullptr ? "." : source) + "/config/cells/transfer_cell/envlib/manutec_r3.mpc";
  Diagnostics diagnostics;
  const auto component = parse_component(text_of(file), file, AnyFile(), diagnostics);
  if (!component) throw std::runtime_error(diagnostics.text());
  PeerArm arm;
  arm.id = "Manutec r3";
  arm.base = "L0";
  arm.tip = "L6";
  arm.urdf = manutec_urdf(payload_kg);
  arm.ours = mechanism_of_component(*component, arm.joints);
  // The transfer cell's hand is 0.12 m beyond the wrist.
  const Eigen::Matrix3d moments = Eigen::Vector3d(0.1, 0.1, 0.1).asDiagonal();
  auto held = arm.ours.mechanism->with_payload({payload_kg, Eigen::Vector3d::Zero(), moments});
  if (!held) throw std::runtime_error(held.error().text());
  arm.ours.mechanism = std::move(*held);
  return arm;
}

PeerArm random_tree(std::mt19937_64& random) {
  constexpr std::size_t kLinks = 12;
  PeerArm arm;
  arm.id = "random tree";
  arm.base = "L0";
  for (bool moves = false; !moves;) {
    arm.urdf = random_urdf(kLinks, false, random);
    moves = arm.urdf.find("revolute") != std::string::npos || arm.urdf.find("prismatic") != std::string::npos;
  }
  for (std::size_t i = 1; i < kLinks; ++i) {
    const std::string bare = fmt::format("<link name=\"L{}\"/>", i);
    arm.urdf.replace(arm.urdf.find(bare), bare.size(),
                     fmt::format("<link name=\"L{}\">{}</link>", i, random_inertial(random)));
  }
  arm.ours = mechanism_of_component(component_of_urdf(arm.urdf), arm.joints);
  return arm;
}

State random_state(std::size_t variables, std::mt19937_64& random) {
  const auto values = [&](double most) {
    std::uniform_real_distribution<double> value(-most, most);
    std::vector<double> all(variables);
    for (double& one : all) one = value(random);
    return all;
  };
  State state;
  state.q = values(2);
  state.qd = values(2);
  state.qdd = values(10);
  return state;
}

}  // namespace cellmirror::dynamics
