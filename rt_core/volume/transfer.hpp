// What a value of a volume looks like: colour and extinction by VolumeSettings.
//
// MEDICAL_LUT goes by Hounsfield units: air, fat, soft tissue and bone, with ramps between them. A kind of weight w has
// the extinction 1000 w^4 per metre: a path of 4 mm through bone of weight 1 lets 2 % through, one of 100 mm through
// tissue of weight 0.3 lets 44 % through. Volumes in other units are read as if their range were -1000 to 2000.
//
// The other tables go by the range of the values: x = 0 at the smallest, 1 at the largest. Level and window place a
// ramp,
//   y = clamp(1/2 + tan(window) (x - (level - 1) / 2), 0, 1),
// so level moves its middle from the smallest value (1) to the largest (3), and window is the angle of its slope: 0 is
// level, pi/4 takes the whole range, 1.57 is a step. Level 2 and window pi/4 leave y = x. The strength s is
//   LIN_LUT, RAINBOW_LUT: min(1, gain y)    EXP_LUT: 1 - exp(-gain y)    USERn_LUT: min(1, gain opacity(y)),
// and the extinction is opacity * s * 40 / (longest edge of the volume): at opacity 1, a tenth of that edge lets 2 %
// through where s = 1. LIN and EXP are grey by s, RAINBOW runs from blue (y = 0) to red (y = 1); a user's table is read
// at smallest + y (largest - smallest).
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "rt_core/ports/volume_settings.hpp"
#include "rt_core/ports/volume_user_table.hpp"

namespace cellmirror::volume {

// Of the values of a volume, in the unit of VoxelGrid::value().
struct ValueRange {
  double low = 0;
  double high = 1;
  bool operator==(const ValueRange&) const = default;
};

struct Appearance {
  std::array<float, 3> rgb{};  // 0 to 1, sRGB
  float extinction = 0;        // per metre, at least 0
  float lit = 0;               // 0 to 1: how far light shades it; what is nearly transparent is not shaded
};

// At `count` values, evenly from the range's low to its high one.
struct TransferFunction {
  ValueRange range;
  std::vector<Appearance> entries;  // at least 2
  [[nodiscard]] const Appearance& at(double value) const;
};

// USER1_LUT, USER2_LUT; null: the built-in one, as LIN_LUT and as RAINBOW_LUT.
using UserTables = std::array<std::shared_ptr<const VolumeUserTable>, 2>;

struct TransferRequest {
  VolumeSettings settings;
  ValueRange range;
  bool hounsfield = false;
  double longest_edge_m = 0.4;
  UserTables user;
};

inline constexpr std::size_t kTransferEntries = 4096;

// What is not finite or out of range is brought into it. Allocates; any thread.
[[nodiscard]] TransferFunction make_transfer(const TransferRequest& request, std::size_t count = kTransferEntries);

}  // namespace cellmirror::volume
