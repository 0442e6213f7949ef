// The same postures in two cells: which bodies touch in one of them alone, and which come nearer.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/proximity/proximity_cell.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

// Of one pair of bodies over all postures.
struct PairOverPostures {
  std::optional<std::uint64_t> first_touch = {};  // number of the posture, from 0
  double deepest_m = 0;
  std::optional<double> nearest_m = {};  // where it was within the warning distance, or nearest of all
  std::uint64_t nearest_at = 0;
};

using BodyNamePair = std::pair<std::string, std::string>;

struct CellOverPostures {
  std::string cell = {};
  std::uint64_t postures = 0;
  std::uint64_t touching = 0;  // postures
  std::uint64_t in_doubt = 0;  // postures
  std::map<BodyNamePair, PairOverPostures> pairs = {};
};

// Runs over the postures of a file (config/posture_file.hpp). Nothing, and all faults on standard error, where the cell
// has no such joints.
[[nodiscard]] std::optional<CellOverPostures> over_postures(const ProximityCell& cell, const std::string& postures);

// Distances that differ by less are equal: 1 mm.
inline constexpr double kEqualDistance = 1e-3;

struct PairChange {
  BodyNamePair bodies;
  std::optional<PairOverPostures> before;
  std::optional<PairOverPostures> after;
};
// Pairs that touch in one alone, then those whose smallest distances differ, each in the order of their names.
[[nodiscard]] std::vector<PairChange> compare(const CellOverPostures& before, const CellOverPostures& after);

// `times_s`: of the postures.
[[nodiscard]] std::string comparison_text(const CellOverPostures& before, const CellOverPostures& after,
                                          std::span<const double> times_s);
[[nodiscard]] std::string comparison_json(const CellOverPostures& before, const CellOverPostures& after,
                                          std::span<const double> times_s, std::span<const std::string> changed_files);

}  // namespace cellmirror::app
