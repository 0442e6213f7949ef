// Chooses the few constraints that say nearly all of what many candidates say, within as large a ball about the tip as
// they can cover.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/haptics/contact_model.hpp"

namespace cellmirror::contact_model {

// A candidate in the space of the tip: free as long as unit . displacement + gap >= 0.
struct TipPlane {
  Eigen::Vector3d unit = Eigen::Vector3d::UnitZ();
  double gap = 0;    // m of the tip
  double lever = 1;  // m of the touching point a metre of the tip along `unit`
  std::uint32_t candidate = 0;
  bool chosen = false;
};

struct Selection {
  std::array<std::uint32_t, haptics::kMaxConstraints> chosen{};  // indices of planes
  std::size_t count = 0;
  double reach = 0;  // m: within this ball about the tip nothing is cut short by more than the tolerance
};

// m that a plane which is left out may be passed by at the edge of a ball of radius `ball`, m.
[[nodiscard]] double tolerance(double ball);
// By how much `plane` can be passed within a ball, m of the tip, by a tip that keeps to `kept`.
[[nodiscard]] double excess(const TipPlane& kept, const TipPlane& plane, double ball);
// Sorts the planes, nearest first. No heap memory.
[[nodiscard]] Selection select(std::span<TipPlane> planes, double reach);

}  // namespace cellmirror::contact_model
