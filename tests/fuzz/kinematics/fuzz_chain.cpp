// Any bytes as a URDF, with findings too: trees and chains between its nodes, or refusals; where both are there, they
// agree.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "config/parse.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/cell/robot_chain.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace {

using namespace cellmirror;

// Of a node named by its whole path, so that it is no other one.
std::string path_of(const Component& component, std::size_t node) {
  std::string path = component.nodes[node].name;
  for (int at = component.nodes[node].parent; at >= 0; at = component.nodes[static_cast<std::size_t>(at)].parent) {
    path = component.nodes[static_cast<std::size_t>(at)].name + "." + path;
  }
  return path;
}

void compare(const kinematics::Tree& tree, std::size_t base, std::size_t tip) {
  const std::vector<double> q(tree.variables().size(), 0.3);
  std::vector<Pose> X_RL(tree.links().size());
  kinematics::forward(tree, q, X_RL);
  const auto chain = tree.chain(static_cast<std::int32_t>(base), static_cast<std::int32_t>(tip),
                                kinematics::VariableOrder::along_chain);
  if (!chain) return;
  kinematics::Jacobian jacobian;
  const Pose X_BT = kinematics::forward(chain->chain, q, jacobian);
  // Long ways and large factors of mimics cost digits.
  constexpr double kLargest = 100.0;
  for (const kinematics::TreeLink& link : tree.links()) {
    if (!(link.X_PL.translation().cwiseAbs().maxCoeff() < kLargest)) return;
    if (!link.X_PL.linear().isUnitary(1e-14)) return;
    if (link.joint && !(std::abs(link.joint->multiplier) + std::abs(link.joint->offset) < kLargest)) return;
  }
  const Pose X_BT_tree = X_RL[base].inverse() * X_RL[tip];
  constexpr double kAgreed = 1e-6;
  CELLMIRROR_EXPECTS((X_BT.matrix() - X_BT_tree.matrix()).cwiseAbs().maxCoeff() < kAgreed);
  CELLMIRROR_EXPECTS(jacobian.allFinite());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kLargest = 64UL << 10U;
  if (size > kLargest) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Diagnostics diagnostics;
  const auto component = parse_urdf(text, "fuzz.urdf", "/fuzz.urdf", AnyFile(), diagnostics);
  if (!component || component->nodes.empty()) return 0;
  const std::size_t ends[] = {0, component->nodes.size() / 2, component->nodes.size() - 1};
  const auto tree = component_tree(*component);
  for (const std::size_t base : ends) {
    for (const std::size_t tip : ends) {
      if (tree) compare(*tree, base, tip);
      const auto chain = chain_between(*component, path_of(*component, base), path_of(*component, tip));
      CELLMIRROR_EXPECTS(chain.has_value() || !chain.error().what.empty());
    }
  }
  (void)chain_between(*component, text.substr(0, 40), "");
  return 0;
}
