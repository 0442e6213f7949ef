#include "app/volume_info/volume_summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace cellmirror::app {

namespace {

constexpr std::size_t kStoredValues = 65536;

double value_of(const VoxelGrid& grid, double stored) { return grid.slope * stored + grid.intercept; }

// The stored value that `share` of the voxels do not exceed.
int stored_at_share(const VolumeSummary& summary, std::uint64_t total, double share) {
  const auto wanted = static_cast<std::uint64_t>(share * static_cast<double>(total));
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < summary.counts.size(); ++i) {
    below += summary.counts[i];
    if (below > wanted) return static_cast<int>(i) + summary.first_stored;
  }
  return static_cast<int>(summary.counts.size()) - 1 + summary.first_stored;
}

std::uint8_t grey_of(double value, const GreyWindow& window) {
  const double share = (value - window.middle) / window.width + 0.5;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

}  // namespace

VolumeSummary summarise(const VoxelGrid& grid) {
  VolumeSummary out;
  out.counts.assign(kStoredValues, 0);
  std::visit(
      [&](const auto& values) {
        using Stored = typename std::decay_t<decltype(values)>::value_type;
        out.first_stored = std::numeric_limits<Stored>::min();
        for (const Stored stored : values) ++out.counts[static_cast<std::size_t>(stored - out.first_stored)];
      },
      grid.values);
  std::uint64_t total = 0;
  double sum = 0;
  for (std::size_t i = 0; i < out.counts.size(); ++i) {
    total += out.counts[i];
    sum += static_cast<double>(out.counts[i]) * (static_cast<double>(i) + out.first_stored);
  }
  if (total == 0) return out;
  const auto used = [](std::uint64_t count) { return count > 0; };
  const auto first = std::ranges::find_if(out.counts, used) - out.counts.begin();
  const auto last = out.counts.rend() - std::find_if(out.counts.rbegin(), out.counts.rend(), used) - 1;
  const double one_end = value_of(grid, static_cast<double>(first + out.first_stored));
  const double other_end = value_of(grid, static_cast<double>(last + out.first_stored));
  out.least = std::min(one_end, other_end);
  out.most = std::max(one_end, other_end);
  out.mean = value_of(grid, sum / static_cast<double>(total));
  constexpr double kOne = 0.01;
  out.percent_1 = value_of(grid, stored_at_share(out, total, grid.slope < 0 ? 1 - kOne : kOne));
  out.percent_50 = value_of(grid, stored_at_share(out, total, 0.5));
  out.percent_99 = value_of(grid, stored_at_share(out, total, grid.slope < 0 ? kOne : 1 - kOne));
  return out;
}

MaterialShares material_shares(const VoxelGrid& grid, const VolumeSummary& summary) {
  constexpr double kAirBelow = -500;
  constexpr double kFatBelow = -10;
  constexpr double kTissueBelow = 200;
  MaterialShares out;
  for (std::size_t i = 0; i < summary.counts.size(); ++i) {
    if (summary.counts[i] == 0) continue;
    const double value = value_of(grid, static_cast<double>(i) + summary.first_stored);
    double& share = value < kAirBelow      ? out.air
                    : value < kFatBelow    ? out.fat
                    : value < kTissueBelow ? out.tissue
                                           : out.bone;
    share += static_cast<double>(summary.counts[i]) / static_cast<double>(grid.count());
  }
  return out;
}

GreyWindow usual_window(const VoxelGrid& grid, const VolumeSummary& summary) {
  if (grid.hounsfield) return {40, 400};  // soft tissue
  const double width = summary.percent_99 - summary.percent_1;
  if (width > 0) return {0.5 * (summary.percent_1 + summary.percent_99), width};
  return {0.5 * (summary.least + summary.most), std::max(summary.most - summary.least, 1.0)};
}

MiddleSlice middle_slice(const VoxelGrid& grid, std::size_t axis, const GreyWindow& window) {
  MiddleSlice out;
  out.across = axis == 0 ? 1 : 0;
  out.up = axis == 2 ? 1 : 2;
  out.width = static_cast<int>(grid.size[out.across]);
  out.height = static_cast<int>(grid.size[out.up]);
  const std::array<std::size_t, 3> step{1, grid.size[0], std::size_t{grid.size[0]} * grid.size[1]};
  const std::size_t start = grid.size[axis] / 2 * step[axis];
  out.grey.reserve(std::size_t{grid.size[out.across]} * grid.size[out.up]);
  std::visit(
      [&](const auto& values) {
        for (std::size_t y = 0; y < grid.size[out.up]; ++y) {
          for (std::size_t x = 0; x < grid.size[out.across]; ++x) {
            const double stored = values[start + y * step[out.up] + x * step[out.across]];
            out.grey.push_back(grey_of(value_of(grid, stored), window));
          }
        }
      },
      grid.values);
  return out;
}

}  // namespace cellmirror::app
