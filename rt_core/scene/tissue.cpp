#include "rt_core/scene/tissue.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>
#include <string_view>
#include <utility>

#include "rt_core/ports/palette.hpp"
#include "rt_core/ports/tissue_state.hpp"
#include "rt_core/scene/draw_rules.hpp"
#include "rt_core/scene/words.hpp"

namespace cellmirror::scene {

namespace {

constexpr double kNetworkArrowPart = 0.3;  // of the network's diagonal: the longest arrow
constexpr double kShortestLongest = 0.01;  // m
constexpr double kLongestLongest = 0.3;
constexpr double kAxesPart = 0.12;  // of the diagonal: the axes of a central node

double diagonal_of(const TissueNetwork& network) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& node : network.nodes) {
    if (node.allFinite()) box.extend(node);
  }
  return box.isEmpty() ? 0.0 : static_cast<double>(box.diagonal().norm());
}

DrawMode mode_of(std::string_view object, std::span<const DrawRule> rules) {
  for (const DrawRule& rule : rules | std::views::reverse) {
    if (covers(rule, object)) return rule.mode;
  }
  return DrawMode::gouraud;
}

void draw_central_nodes(const TissueView& view, double length_m, Scene& scene) {
  const bool named = view.network.central_nodes.size() == view.surfaces.size();
  for (std::size_t i = 0; i < view.network.central_nodes.size(); ++i) {
    const Pose& X_WN = view.network.central_nodes[i];
    if (!X_WN.matrix().allFinite()) continue;
    scene.axes.push_back({X_WN, length_m, true, named ? view.surfaces[i].name : std::string()});
  }
}

}  // namespace

void TissueMarks::draw_forces(const TissueView& view, double longest_m, Scene& scene) {
  double largest = 0;
  for (const auto& [from, force] : view.network.forces) {
    const auto length = static_cast<double>(force.norm());
    if (std::isfinite(length)) largest = std::max(largest, length);
  }
  if (!(largest > 0)) return;
  shown_ = scale_.update(largest, longest_m);
  for (const auto& [from, force] : view.network.forces) {
    if (!from.allFinite() || !force.allFinite()) continue;
    scene.arrows.push_back({from.cast<double>(), force.cast<double>() / shown_, palette::kTissueForce, false});
  }
}

void TissueMarks::draw(const std::shared_ptr<const TissueView>& view, std::span<const DrawRule> rules, Scene& scene) {
  shown_ = 0;
  scene.tissue = view;
  scene.tissue_modes.clear();
  if (view == nullptr) return;
  for (const TissueSurface& surface : view->surfaces) scene.tissue_modes.push_back(mode_of(surface.name, rules));
  const double diagonal = diagonal_of(view->network);
  if (!(diagonal > 0)) return;
  draw_forces(*view, std::clamp(kNetworkArrowPart * diagonal, kShortestLongest, kLongestLongest), scene);
  draw_central_nodes(*view, kAxesPart * diagonal, scene);
}

void write_network_legend(const TissueView& view, const TissueMarks& marks, Scene& scene) {
  if (view.network.nodes.empty()) return;
  static constexpr std::array<std::pair<TissueNodeKind, std::string_view>, 4> kTexts = {
      std::pair(TissueNodeKind::inner, std::string_view("inner node")),
      std::pair(TissueNodeKind::outer, std::string_view("outer node")),
      std::pair(TissueNodeKind::contact, std::string_view("node in contact")),
      std::pair(TissueNodeKind::fixed, std::string_view("fixed node"))};
  for (const auto& [kind, text] : kTexts) {
    if (std::ranges::find(view.network.kinds, kind) == view.network.kinds.end()) continue;
    scene.legend.push_back({palette::colour_of(kind), std::string(text)});
  }
  const double force = marks.newton_per_metre();
  if (force > 0)
    scene.legend.push_back(
        {palette::kTissueForce, fmt::format("force on tissue, 10 mm = {}", quantity_text(0.01 * force, "N"))});
}

}  // namespace cellmirror::scene
