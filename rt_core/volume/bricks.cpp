#include "rt_core/volume/bricks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cellmirror::volume {

namespace {

constexpr std::uint8_t kFarthestLeap = 12;  // bricks

template <class T>
class LayerMeasurer {
 public:
  LayerMeasurer(const VoxelGrid& grid, const T* voxels)
      : size_(grid.size), voxels_(voxels), low_(grid.size[0]), high_(grid.size[0]) {}

  // One of blocks: the range of each, without its neighbours.
  void measure(std::uint32_t layer, Bricks& bricks) {
    const std::size_t across = 2 * std::size_t{bricks.count[0]};
    const std::uint32_t rows = 2 * bricks.count[1];
    for (std::uint32_t row = 0; row < rows; ++row) {
      collect(layer, row);
      const std::size_t first = across * (row + std::size_t{rows} * layer);
      std::uint16_t* const low = bricks.blocks.low.data() + first;
      std::uint16_t* const high = bricks.blocks.high.data() + first;
      for (std::size_t b = 0; b < across; ++b) {
        const std::size_t begin = std::min<std::size_t>(b * kBlockCells, size_[0] - 1);
        const std::size_t end = std::min<std::size_t>(b * kBlockCells + kBlockCells, size_[0] - 1);
        T least = low_[begin];
        T most = high_[begin];
        for (std::size_t x = begin + 1; x <= end; ++x) {
          least = std::min(least, low_[x]);
          most = std::max(most, high_[x]);
        }
        low[b] = static_cast<std::uint16_t>(least - bricks.blocks.bias);
        high[b] = static_cast<std::uint16_t>(most - bricks.blocks.bias);
      }
    }
  }

 private:
  // The smallest and largest of the rows of voxels of a row of blocks.
  void collect(std::uint32_t layer, std::uint32_t row) {
    const std::size_t width = size_[0];
    const auto last = [](std::uint32_t block, std::uint32_t size) {
      return std::min((block + 1) * kBlockCells, size - 1);
    };
    bool first = true;
    for (std::uint32_t z = std::min(layer * kBlockCells, size_[2] - 1); z <= last(layer, size_[2]); ++z) {
      for (std::uint32_t y = std::min(row * kBlockCells, size_[1] - 1); y <= last(row, size_[1]); ++y) {
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

// The place of a brick's first block.
std::size_t first_block(const Bricks& bricks, std::size_t x, std::size_t y, std::size_t z) {
  return 2 * x + 2 * std::size_t{bricks.count[0]} * (2 * y + 2 * std::size_t{bricks.count[1]} * (2 * z));
}

// The places of a brick's blocks after that of its first one.
std::array<std::size_t, 8> block_places(const Bricks& bricks) {
  const std::size_t row = 2 * std::size_t{bricks.count[0]};
  const std::size_t layer = row * 2 * bricks.count[1];
  return {0, 1, row, row + 1, layer, layer + 1, layer + row, layer + row + 1};
}

// Of the blocks of a layer of bricks.
void join_blocks(std::uint32_t layer, Bricks& bricks) {
  const std::array<std::size_t, 8> places = block_places(bricks);
  std::size_t i = std::size_t{bricks.count[0]} * bricks.count[1] * layer;
  for (std::size_t y = 0; y < bricks.count[1]; ++y) {
    for (std::size_t x = 0; x < bricks.count[0]; ++x, ++i) {
      const std::size_t first = first_block(bricks, x, y, layer);
      std::uint16_t low = bricks.blocks.low[first];
      std::uint16_t high = bricks.blocks.high[first];
      for (const std::size_t place : places) {
        low = std::min(low, bricks.blocks.low[first + place]);
        high = std::max(high, bricks.blocks.high[first + place]);
      }
      bricks.ranges[i] = {low + bricks.blocks.bias, high + bricks.blocks.bias};
    }
  }
}

// Each value joined with its neighbours along one axis.
template <class T, class Join>
void spread(const std::vector<T>& from, std::vector<T>& to, std::size_t length, std::size_t stride, const Join& join) {
  const std::size_t block = length * stride;
  for (std::size_t base = 0; base < from.size(); base += block) {
    const T* const in = from.data() + base;
    T* const out = to.data() + base;
    if (length == 1) {
      std::copy_n(in, block, out);
      continue;
    }
    for (std::size_t i = 0; i < stride; ++i) {
      out[i] = join(in[i], in[i + stride]);
      out[block - stride + i] = join(in[block - stride + i], in[block - 2 * stride + i]);
    }
    for (std::size_t i = stride; i < block - stride; ++i) out[i] = join(join(in[i - stride], in[i]), in[i + stride]);
  }
}

// With all neighbours.
template <class T, class Join>
std::vector<T> spread_all(const std::vector<T>& from, const std::array<std::uint32_t, 3>& count, const Join& join) {
  std::vector<T> a(from.size());
  std::vector<T> b(from.size());
  spread(from, a, count[0], 1, join);
  spread(a, b, count[1], count[0], join);
  spread(b, a, count[2], std::size_t{count[0]} * count[1], join);
  return a;
}

std::vector<std::uint8_t> spread_all(const std::vector<std::uint8_t>& from, const std::array<std::uint32_t, 3>& count) {
  return spread_all(from, count, [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a | b); });
}

// From bytes that are 1 where a brick is occupied.
LeapMap leap_map(std::array<std::uint32_t, 3> count, std::vector<std::uint8_t> occupied) {
  LeapMap map;
  map.count = count;
  map.occupied = static_cast<std::size_t>(std::ranges::count(occupied, 1));
  std::vector<std::uint8_t> leap(occupied.size());
  for (std::size_t i = 0; i < occupied.size(); ++i) leap[i] = occupied[i] != 0 ? 0 : kFarthestLeap;
  for (std::uint8_t distance = 1; distance < kFarthestLeap && map.occupied > 0; ++distance) {
    std::vector<std::uint8_t> wider = spread_all(occupied, count);
    for (std::size_t i = 0; i < wider.size(); ++i) leap[i] = wider[i] > occupied[i] ? distance : leap[i];
    occupied.swap(wider);
  }
  map.leap.assign(leap.begin(), leap.end());
  return map;
}

// Whether a range of stored values has one of more than such an extinction: by the first entry from each entry on that
// has it.
class DenserThan {
 public:
  DenserThan(std::span<const Appearance> table, StoredRange range, double extinction)
      : low_(range.low),
        last_(static_cast<double>(table.size() - 1)),
        scale_(last_ / std::max(1.0, static_cast<double>(range.high) - range.low)),
        next_(table.size()) {
    auto next = static_cast<std::uint32_t>(table.size());
    for (std::size_t i = table.size(); i-- > 0;) {
      if (static_cast<double>(table[i].extinction) > extinction) next = static_cast<std::uint32_t>(i);
      next_[i] = next;
    }
  }

  [[nodiscard]] bool operator()(std::int32_t low, std::int32_t high) const {
    const double from = place(low);
    const double to = place(high);
    const auto whole = static_cast<std::uint32_t>(to);
    return next_[static_cast<std::uint32_t>(from)] <= whole + (static_cast<double>(whole) < to ? 1U : 0U);
  }

 private:
  [[nodiscard]] double place(std::int32_t value) const {
    return std::clamp(scale_ * (static_cast<double>(value) - low_), 0.0, last_);
  }

  double low_;
  double last_;
  double scale_;
  std::vector<std::uint32_t> next_;
};

std::vector<std::uint8_t> bricks_that(const Bricks& bricks, const DenserThan& denser) {
  std::vector<std::uint8_t> found(bricks.ranges.size());
  for (std::size_t i = 0; i < found.size(); ++i) found[i] = denser(bricks.ranges[i].low, bricks.ranges[i].high) ? 1 : 0;
  return found;
}

// How many of the limits a brick's blocks keep, beside those that the brick itself keeps: two bits each.
std::uint32_t strides_of_blocks(const BlockRanges& blocks, std::size_t first, const std::array<std::size_t, 8>& places,
                                std::span<const DenserThan> limits, std::uint32_t of_brick) {
  std::uint32_t strides = 0;
  for (std::size_t b = 0; b < places.size(); ++b) {
    std::uint32_t stride = of_brick;
    for (const DenserThan& denser : limits) {
      const std::size_t i = first + places[b];
      stride += denser(blocks.low[i] + blocks.bias, blocks.high[i] + blocks.bias) ? 0U : 1U;
    }
    strides |= stride << (2 * b);
  }
  return strides;
}

}  // namespace

Bricks empty_bricks(const VoxelGrid& grid) {
  Bricks bricks;
  for (std::size_t axis = 0; axis < 3; ++axis)
    bricks.count[axis] = (grid.size[axis] - 1 + kBrickCells - 1) / kBrickCells;
  bricks.ranges.resize(std::size_t{bricks.count[0]} * bricks.count[1] * bricks.count[2]);
  bricks.blocks.low.resize(8 * bricks.ranges.size());
  bricks.blocks.high.resize(8 * bricks.ranges.size());
  if (std::holds_alternative<std::vector<std::int16_t>>(grid.values))
    bricks.blocks.bias = std::numeric_limits<std::int16_t>::min();
  return bricks;
}

void measure_layers(const VoxelGrid& grid, std::uint32_t begin, std::uint32_t end, Bricks& bricks) {
  std::visit(
      [&](const auto& voxels) {
        LayerMeasurer measurer(grid, voxels.data());
        for (std::uint32_t layer = begin; layer < end; ++layer) {
          measurer.measure(2 * layer, bricks);
          measurer.measure(2 * layer + 1, bricks);
          join_blocks(layer, bricks);
        }
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
  const std::array<std::uint32_t, 3> blocks = {2 * bricks.count[0], 2 * bricks.count[1], 2 * bricks.count[2]};
  bricks.blocks.low =
      spread_all(bricks.blocks.low, blocks, [](std::uint16_t a, std::uint16_t b) { return std::min(a, b); });
  bricks.blocks.high =
      spread_all(bricks.blocks.high, blocks, [](std::uint16_t a, std::uint16_t b) { return std::max(a, b); });
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
                       const std::array<double, kLongestStrideLog>& stride_limits, double step_voxels) {
  LeapMap map = leap_map(bricks.count, bricks_that(bricks, DenserThan(table, range, 0)));
  // What steps pass beyond a block is in its neighbours if they are no longer than a block; else, with steps of a
  // voxel, in those of its brick.
  std::vector<std::uint8_t> of_bricks(bricks.ranges.size());
  std::vector<DenserThan> of_blocks;
  for (std::size_t k = 0; k < stride_limits.size(); ++k) {
    if (!(stride_limits[k] > 0)) continue;
    DenserThan denser(table, range, stride_limits[k]);
    if (!bricks.blocks.low.empty() && std::exp2(k + 1) * step_voxels <= kBlockCells) {
      of_blocks.push_back(std::move(denser));
      continue;
    }
    const std::vector<std::uint8_t> near = spread_all(bricks_that(bricks, denser), bricks.count);
    for (std::size_t i = 0; i < near.size(); ++i)
      of_bricks[i] = static_cast<std::uint8_t>(of_bricks[i] + (near[i] == 0 ? 1 : 0));
  }
  constexpr std::uint32_t kEachBlock = 0x5555;  // 1 in the two bits of each
  const std::array<std::size_t, 8> places = block_places(bricks);
  std::size_t i = 0;
  for (std::size_t z = 0; z < bricks.count[2]; ++z) {
    for (std::size_t y = 0; y < bricks.count[1]; ++y) {
      for (std::size_t x = 0; x < bricks.count[0]; ++x, ++i) {
        if (map.leap[i] != 0) continue;
        const std::uint32_t strides = of_blocks.empty() ? kEachBlock * of_bricks[i]
                                                        : strides_of_blocks(bricks.blocks, first_block(bricks, x, y, z),
                                                                            places, of_blocks, of_bricks[i]);
        map.leap[i] = strides << kStrideShift;
      }
    }
  }
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
