#include "drivers/dds/tissue_markers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

namespace cellmirror::dds {

namespace {

constexpr MarkerColour kFlesh{0.78F, 0.40F, 0.36F, 1.0F};  // of an object without colours
constexpr MarkerColour kRawFlesh{0.75F, 0.12F, 0.12F, 1.0F};
constexpr MarkerColour kYellow{0.95F, 0.80F, 0.10F, 1.0F};
constexpr double kShaftDiameter = 0.002;  // m
constexpr double kHeadDiameter = 0.005;   // m
constexpr double kGrowth = 1.3;           // of the grid's cells, until few enough triangles are left
constexpr int kMostGrowths = 40;          // far more than a cell needs to swallow a body

MarkerPoint marker_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

bool usable(const TissueSurface& surface) {
  if (!surface.topology) return false;
  const std::size_t vertices = surface.vertices.size();
  return std::ranges::all_of(surface.topology->triangles, [&](const std::array<std::uint32_t, 3>& triangle) {
    return std::ranges::all_of(triangle, [&](std::uint32_t vertex) { return vertex < vertices; });
  });
}

// About the distance between neighbours if so many triangles were spread over the box of the vertices.
double first_cell(const TissueSurface& surface, std::size_t most) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e9F);
  Eigen::Vector3f high = -low;
  for (const Eigen::Vector3f& vertex : surface.vertices) {
    if (!vertex.allFinite()) continue;
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  const double size = std::max(0.0, static_cast<double>((high - low).maxCoeff()));
  return std::max(1e-6, size / std::sqrt(static_cast<double>(std::max<std::size_t>(most, 1))));
}

MarkerColour colour_of(const TissueTopology& topology) {
  if (topology.rgb.empty()) return kFlesh;
  std::array<double, 3> sum{};
  for (const std::array<float, 3>& rgb : topology.rgb)
    for (std::size_t i = 0; i < 3; ++i) sum.at(i) += static_cast<double>(rgb.at(i));
  const auto mean = [&](std::size_t i) {
    return static_cast<float>(std::clamp(sum.at(i) / static_cast<double>(topology.rgb.size()), 0.0, 1.0));
  };
  return {mean(0), mean(1), mean(2), 1.0F};
}

}  // namespace

// Each vertex by itself where few enough triangles come of it.
void ReducedSurface::group(const TissueSurface& surface, std::size_t most) {
  topology_ = surface.topology;
  most_ = most;
  const std::size_t triangles = topology_->triangles.size();
  if (triangles <= most) {
    groups_ = static_cast<std::uint32_t>(surface.vertices.size());
    group_of_.resize(groups_);
    std::iota(group_of_.begin(), group_of_.end(), 0U);
    kept_.resize(triangles);
    std::iota(kept_.begin(), kept_.end(), 0U);
    return;
  }
  double cell_m = first_cell(surface, most);
  for (int i = 0; i < kMostGrowths && !group(surface, cell_m, most); ++i) cell_m *= kGrowth;
  if (kept_.size() > most) kept_.resize(most);
}

// True where at most `most` triangles are left.
bool ReducedSurface::group(const TissueSurface& surface, double cell_m, std::size_t most) {
  constexpr double kFarthest = 1e6;  // cells
  std::map<std::array<int, 3>, std::uint32_t> cells;
  group_of_.resize(surface.vertices.size());
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    const auto cell = [&](Eigen::Index axis) {
      const double at = std::floor(static_cast<double>(surface.vertices[i][axis]) / cell_m);
      return std::isfinite(at) ? static_cast<int>(std::clamp(at, -kFarthest, kFarthest)) : 0;
    };
    const std::array<int, 3> key{cell(0), cell(1), cell(2)};
    group_of_[i] = cells.try_emplace(key, static_cast<std::uint32_t>(cells.size())).first->second;
  }
  groups_ = static_cast<std::uint32_t>(cells.size());
  kept_.clear();
  std::set<std::array<std::uint32_t, 3>> known;
  for (std::uint32_t i = 0; i < topology_->triangles.size(); ++i) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t corner = 0; corner < 3; ++corner)
      corners.at(corner) = group_of_[topology_->triangles[i].at(corner)];
    // The same three in the same order, wherever it begins.
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    if (known.insert(corners).second) kept_.push_back(i);
  }
  return kept_.size() <= most;
}

void ReducedSurface::place(const TissueSurface& surface) {
  centres_.assign(groups_, MarkerPoint{});
  sizes_.assign(groups_, 0);
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    const MarkerPoint at = marker_point(surface.vertices[i].cast<double>());
    for (std::size_t axis = 0; axis < 3; ++axis) centres_[group_of_[i]].at(axis) += at.at(axis);
    ++sizes_[group_of_[i]];
  }
  for (std::uint32_t group = 0; group < groups_; ++group)
    for (double& axis : centres_[group]) axis /= std::max<double>(sizes_[group], 1.0);
  corners_.clear();
  cut_corners_.clear();
  for (const std::uint32_t triangle : kept_) {
    std::array<MarkerPoint, 3> three{};
    for (std::size_t corner = 0; corner < 3; ++corner)
      three.at(corner) = centres_[group_of_[topology_->triangles[triangle].at(corner)]];
    const bool finite = std::ranges::all_of(three, [](const MarkerPoint& p) {
      return std::ranges::all_of(p, [](double axis) { return std::isfinite(axis); });
    });
    if (!finite) continue;
    const bool cut = triangle < topology_->cut_face.size() && topology_->cut_face[triangle] != 0;
    std::vector<MarkerPoint>& to = cut ? cut_corners_ : corners_;
    to.insert(to.end(), three.begin(), three.end());
  }
}

void ReducedSurface::update(const TissueSurface& surface, std::size_t most) {
  if (!usable(surface)) {
    topology_ = nullptr;
    corners_.clear();
    cut_corners_.clear();
    return;
  }
  const bool same = surface.topology == topology_ && most == most_ && group_of_.size() == surface.vertices.size();
  if (!same) group(surface, most);
  place(surface);
}

Marker TissueMarkers::marker(RosTime stamp, std::string ns, std::size_t id, MarkerType type,
                             MarkerColour colour) const {
  Marker made;
  made.header = {stamp, "world"};
  made.ns = std::move(ns);
  made.id = static_cast<std::int32_t>(id);
  made.type = type;
  made.colour = colour;
  made.lifetime_ns = lifetime_ns_;
  return made;
}

void TissueMarkers::add_surface(RosTime stamp, const TissueSurface& surface, std::size_t id, std::size_t most,
                                MarkerArray& message) {
  ReducedSurface& reduced = surfaces_[id];
  reduced.update(surface, most);
  for (const bool cut : {false, true}) {
    if (reduced.corners(cut).empty()) continue;
    Marker made = marker(stamp, cut ? "tissue_cut" : "tissue", id, MarkerType::triangle_list,
                         cut ? kRawFlesh : colour_of(*surface.topology));
    made.points = reduced.corners(cut);
    message.markers.push_back(std::move(made));
  }
}

void TissueMarkers::add_arrows(RosTime stamp, std::span<const TissueForceArrow> forces, MarkerArray& message) const {
  for (std::size_t i = 0; i < std::min(forces.size(), kMaxTissueArrows); ++i) {
    const TissueForceArrow& force = forces[i];
    const double size = force.force_W.norm();
    if (!force.at.allFinite() || !std::isfinite(size) || size < kTissueLeastForce) continue;
    const double length = std::min(size * kTissueArrowMPerN, kTissueLongestArrow);
    Marker arrow = marker(stamp, "tissue_forces", i, MarkerType::arrow, kYellow);
    arrow.scale = {kShaftDiameter, kHeadDiameter, 0};
    arrow.points = {marker_point(force.at), marker_point(force.at + length / size * force.force_W)};
    message.markers.push_back(std::move(arrow));
  }
}

void TissueMarkers::fill(RosTime stamp, const TissueView& view, std::span<const TissueForceArrow> forces,
                         MarkerArray& message) {
  message.markers.clear();
  const std::size_t count = std::min(view.surfaces.size(), kMaxTissueObjects);
  std::size_t all = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (const auto& topology = view.surfaces[i].topology) all += topology->triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    const TissueSurface& surface = view.surfaces[i];
    if (!surface.visible || !surface.topology) continue;
    // A large object gets more of them.
    const std::size_t triangles = surface.topology->triangles.size();
    add_surface(stamp, surface, i, all <= most_ ? triangles : triangles * most_ / all, message);
  }
  add_arrows(stamp, forces, message);
}

}  // namespace cellmirror::dds
