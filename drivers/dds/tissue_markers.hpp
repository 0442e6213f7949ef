// From deformable objects to markers for RViz, all in the frame "world". Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/dds/marker_messages.hpp"
#include "rt_core/ports/tissue_output.hpp"

namespace cellmirror::dds {

inline constexpr double kTissueArrowMPerN = 0.02;     // length of an arrow
inline constexpr double kTissueLongestArrow = 0.2;    // m; larger forces are drawn as long as this
inline constexpr double kTissueLeastForce = 0.01;     // N; smaller ones are not drawn
inline constexpr std::size_t kMaxTissueArrows = 64;   // the first ones
inline constexpr std::size_t kMaxTissueObjects = 64;  // likewise

// A surface with fewer triangles: vertices of the same cell of a grid become one, and triangles that lose a corner by
// it are left out (vertex clustering, Rossignac and Borrel, 1993). Which vertices belong together stays until the
// triangles change, so that the picture of a moving surface is steady.
class ReducedSurface {
 public:
  // At most `most` triangles of `surface`, unless one has none that are finite.
  void update(const TissueSurface& surface, std::size_t most);

  // Three vertices each, as of the last update, m; `cut`: of cut faces.
  [[nodiscard]] const std::vector<MarkerPoint>& corners(bool cut) const { return cut ? cut_corners_ : corners_; }

 private:
  void group(const TissueSurface& surface, std::size_t most);
  bool group(const TissueSurface& surface, double cell_m, std::size_t most);
  void place(const TissueSurface& surface);

  std::shared_ptr<const TissueTopology> topology_;  // that is grouped
  std::size_t most_ = 0;
  std::vector<std::uint32_t> group_of_;  // by vertex
  std::uint32_t groups_ = 0;
  std::vector<std::uint32_t> kept_;   // triangles of the topology
  std::vector<MarkerPoint> centres_;  // of groups
  std::vector<std::uint32_t> sizes_;  // of groups
  std::vector<MarkerPoint> corners_;
  std::vector<MarkerPoint> cut_corners_;
};

// "tissue": the surface of each visible object, id by its place in the view, its cut faces as "tissue_cut"; both as
// TRIANGLE_LIST with at most `most` triangles in all. "tissue_forces": an ARROW for each instrument on which there is a
// force, from its tool centre point. What is not finite is left out. Keeps what it knows of surfaces.
class TissueMarkers {
 public:
  // `most`: triangles. `lifetime_ns`: after which a viewer removes what is not refreshed.
  TissueMarkers(std::size_t most, std::int64_t lifetime_ns) : most_(most), lifetime_ns_(lifetime_ns) {}

  void fill(RosTime stamp, const TissueView& view, std::span<const TissueForceArrow> forces, MarkerArray& message);

 private:
  [[nodiscard]] Marker marker(RosTime stamp, std::string ns, std::size_t id, MarkerType type,
                              MarkerColour colour) const;
  void add_surface(RosTime stamp, const TissueSurface& surface, std::size_t id, std::size_t most, MarkerArray& message);
  void add_arrows(RosTime stamp, std::span<const TissueForceArrow> forces, MarkerArray& message) const;

  std::size_t most_;
  std::int64_t lifetime_ns_;
  std::map<std::size_t, ReducedSurface> surfaces_;  // by place in the view
};

}  // namespace cellmirror::dds
