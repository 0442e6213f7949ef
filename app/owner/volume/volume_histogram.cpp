#include "app/owner/volume/volume_histogram.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace cellmirror::app {

namespace {

constexpr std::size_t kMostSamples = std::size_t{4} << 20U;

// Odd, so that it is no divisor of the usual row lengths.
std::size_t stride_of(std::size_t voxels) { return (voxels / kMostSamples) | std::size_t{1}; }

template <class Value>
VolumeHistogram histogram_of_values(const std::vector<Value>& values, double slope, double intercept) {
  VolumeHistogram histogram;
  if (values.empty()) return histogram;
  const std::size_t stride = stride_of(values.size());
  Value low = std::numeric_limits<Value>::max();
  Value high = std::numeric_limits<Value>::lowest();
  for (std::size_t i = 0; i < values.size(); i += stride) {
    low = std::min(low, values[i]);
    high = std::max(high, values[i]);
  }
  // Stored values: the bins turn around where the slope is negative.
  const double width = std::max(static_cast<double>(high) - static_cast<double>(low), 1.0);
  const double bins_per_value = static_cast<double>(VolumeHistogram::kBins) / width;
  for (std::size_t i = 0; i < values.size(); i += stride) {
    const auto bin =
        static_cast<std::size_t>((static_cast<double>(values[i]) - static_cast<double>(low)) * bins_per_value);
    ++histogram.counts.at(std::min(bin, VolumeHistogram::kBins - 1));
  }
  histogram.low = slope * static_cast<double>(low) + intercept;
  histogram.high = slope * (static_cast<double>(low) + width) + intercept;
  if (histogram.low > histogram.high) {
    std::swap(histogram.low, histogram.high);
    std::ranges::reverse(histogram.counts);
  }
  return histogram;
}

}  // namespace

VolumeHistogram histogram_of(const VoxelGrid& grid) {
  return std::visit([&](const auto& values) { return histogram_of_values(values, grid.slope, grid.intercept); },
                    grid.values);
}

}  // namespace cellmirror::app
