#include "rt_core/volume/bricks.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::volume {

namespace {

constexpr std::uint8_t kFarthestLeap = 12;  // bricks

template <class T>
class LayerMeasurer {
 public:
  LayerMeasurer(const VoxelGrid& grid, const T* voxels)
      : size_(grid.size), voxels_(voxels), low_(grid.size[0]), high_(grid.size[0]) {}

  void measure(std::uint32_t layer, Bricks& bricks) {
    for (std::uint32_t row = 0; row < bricks.count[1]; ++row) {
      collect(layer, row);
      StoredRange* const out =
          bricks.ranges.data() + std::size_t{bricks.count[0]} * (row + std::size_t{bricks.count[1]} * layer);
      for (std::uint32_t b = 0; b < bricks.count[0]; ++b) {
        const auto begin = static_cast<std::ptrdiff_t>(b) * kBrickCells;
        const auto end = static_cast<std::ptrdiff_t>(std::min(b * kBrickCells + kBrickCells + 1, size_[0]));
        out[b] = {*std::min_element(low_.begin() + begin, low_.begin() + end),
                  *std::max_element(high_.begin() + begin, high_.begin() + end)};
      }
    }
  }

 private:
  // The smallest and largest of the rows of voxels of a row of bricks.
  void collect(std::uint32_t layer, std::uint32_t row) {
    const std::size_t width = size_[0];
    bool first = true;
    for (std::uint32_t z = layer * kBrickCells; z <= std::min((layer + 1) * kBrickCells, size_[2] - 1); ++z) {
      for (std::uint32_t y = row * kBrickCells; y <= std::min((row + 1) * kBrickCells, size_[1] - 1); ++y) {
        const T* const line = voxels_ + width * (y + std::size_t{size_[1]} * z);
        if (first) {
          std::copy_n(line, width, low_.begin());
          std::copy_n(line, width, high_.begin());
          first = false;
          continue;
        }
        T* const low = low_.data();
        T* const high = high_.data();
        for (std::size_t x = 0; x < width; ++x) {
          low[x] = std::min(low[x], line[x]);
          high[x] = std::max(high[x], line[x]);
        }
      }
    }
  }

  std::array<std::uint32_t, 3> size_;
  const T* voxels_;
  std::vector<T> low_;
  std::vector<T> high_;
};

// Bytes that are 1 spread to their neighbours along one axis.
void spread(const std::vector<std::uint8_t>& from, std::vector<std::uint8_t>& to, std::size_t length,
            std::size_t stride) {
  const std::size_t block = length * stride;
  for (std::size_t base = 0; base < from.size(); base += block) {
    const std::uint8_t* const in = from.data() + base;
    std::uint8_t* const out = to.data() + base;
    if (length == 1) {
      std::copy_n(in, block, out);
      continue;
    }
    for (std::size_t i = 0; i < stride; ++i) {
      out[i] = in[i] | in[i + stride];
      out[block - stride + i] = in[block - stride + i] | in[block - 2 * stride + i];
    }
    for (std::size_t i = stride; i < block - stride; ++i) out[i] = in[i - stride] | in[i] | in[i + stride];
  }
}

// To all neighbours.
std::vector<std::uint8_t> spread_all(const std::vector<std::uint8_t>& from, const std::array<std::uint32_t, 3>& count) {
  std::vector<std::uint8_t> a(from.size());
  std::vector<std::uint8_t> b(from.size());
  spread(from, a, count[0], 1);
  spread(a, b, count[1], count[0]);
  spread(b, a, count[2], std::size_t{count[0]} * count[1]);
  return a;
}

// From bytes that are 1 where a brick is occupied.
LeapMap leap_map(std::array<std::uint32_t, 3> count, std::vector<std::uint8_t> occupied) {
  LeapMap map;
  map.count = count;
  map.occupied = static_cast<std::size_t>(std::ranges::count(occupied, 1));
  map.leap.resize(occupied.size());
  for (std::size_t i = 0; i < occupied.size(); ++i) map.leap[i] = occupied[i] != 0 ? 0 : kFarthestLeap;
  for (std::uint8_t distance = 1; distance < kFarthestLeap && map.occupied > 0; ++distance) {
    std::vector<std::uint8_t> wider = spread_all(occupied, count);
    for (std::size_t i = 0; i < wider.size(); ++i) map.leap[i] = wider[i] > occupied[i] ? distance : map.leap[i];
    occupied.swap(wider);
  }
  map.leap.resize(map.leap.size() + 3);
  return map;
}

}  // namespace

Bricks empty_bricks(const VoxelGrid& grid) {
  Bricks bricks;
  for (std::size_t axis = 0; axis < 3; ++axis)
    bricks.count[axis] = (grid.size[axis] - 1 + kBrickCells - 1) / kBrickCells;
  bricks.ranges.resize(std::size_t{bricks.count[0]} * bricks.count[1] * bricks.count[2]);
  return bricks;
}

void measure_layers(const VoxelGrid& grid, std::uint32_t begin, std::uint32_t end, Bricks& bricks) {
  std::visit(
      [&](const auto& voxels) {
        LayerMeasurer measurer(grid, voxels.data());
        for (std::uint32_t layer = begin; layer < end; ++layer) measurer.measure(layer, bricks);
      },
      grid.values);
}

void finish(Bricks& bricks) {
  if (bricks.ranges.empty()) return;
  bricks.all = bricks.ranges.front();
  for (const StoredRange& range : bricks.ranges) {
    bricks.all.low = std::min(bricks.all.low, range.low);
    bricks.all.high = std::max(bricks.all.high, range.high);
  }
}

Bricks make_bricks(const VoxelGrid& grid) {
  Bricks bricks = empty_bricks(grid);
  measure_layers(grid, 0, bricks.count[2], bricks);
  finish(bricks);
  return bricks;
}

ValueRange value_range(const VoxelGrid& grid, const Bricks& bricks) {
  const double a = grid.slope * bricks.all.low + grid.intercept;
  const double b = grid.slope * bricks.all.high + grid.intercept;
  return {std::min(a, b), std::max(a, b)};
}

LeapMap leaps_by_table(const Bricks& bricks, StoredRange range, std::span<const Appearance> table,
                       const std::array<double, kLongestStrideLog>& stride_limits) {
  const auto last = static_cast<double>(table.size() - 1);
  const double scale = last / std::max(1.0, static_cast<double>(range.high) - range.low);
  const auto entry = [&](double place) { return static_cast<std::size_t>(std::clamp(place, 0.0, last)); };
  // 1 for the bricks with a value of more than such an extinction.
  const auto denser = [&](double extinction) {
    std::vector<std::uint32_t> before(table.size() + 1);
    for (std::size_t i = 0; i < table.size(); ++i)
      before[i + 1] = before[i] + (static_cast<double>(table[i].extinction) > extinction ? 1U : 0U);
    std::vector<std::uint8_t> found(bricks.ranges.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double low = scale * (bricks.ranges[i].low - range.low);
      const double high = scale * (bricks.ranges[i].high - range.low);
      found[i] = before[entry(std::ceil(high)) + 1] > before[entry(std::floor(low))] ? 1 : 0;
    }
    return found;
  };
  LeapMap map = leap_map(bricks.count, denser(0));
  std::vector<std::uint8_t> strides(bricks.ranges.size());
  for (const double limit : stride_limits) {
    if (!(limit > 0)) continue;
    const std::vector<std::uint8_t> near = spread_all(denser(limit), bricks.count);
    for (std::size_t i = 0; i < strides.size(); ++i)
      strides[i] = static_cast<std::uint8_t>(strides[i] + (near[i] == 0 ? 16 : 0));
  }
  for (std::size_t i = 0; i < strides.size(); ++i) map.leap[i] = map.leap[i] == 0 ? strides[i] : map.leap[i];
  return map;
}

LeapMap leaps_by_threshold(const Bricks& bricks, double threshold, bool falling) {
  std::vector<std::uint8_t> occupied(bricks.ranges.size());
  for (std::size_t i = 0; i < occupied.size(); ++i) {
    const StoredRange& range = bricks.ranges[i];
    occupied[i] = (falling ? range.low <= threshold : range.high >= threshold) ? 1 : 0;
  }
  return leap_map(bricks.count, std::move(occupied));
}

}  // namespace cellmirror::volume
