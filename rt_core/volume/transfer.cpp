#include "rt_core/volume/transfer.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::volume {

namespace {

constexpr double kDensestMedical = 1000;  // per metre
constexpr double kDensestEdge = 40;       // extinction along the longest edge, at opacity 1
constexpr double kLeastStrength = 1e-9;   // less is nothing: the ramp begins at 0 but for rounding
constexpr double kLitFrom = 20;           // per metre: half lit at 5 times this
constexpr double kLowestRead = -1000;     // HU that the range of a volume in other units is read as
constexpr double kHighestRead = 2000;

using Rgb = std::array<float, 3>;

double bounded(double value, double low, double high) {
  return std::isfinite(value) ? std::clamp(value, low, high) : low;
}

// From 0 at `from` to 1 at `to`.
double ramp(double value, double from, double to) { return std::clamp((value - from) / (to - from), 0.0, 1.0); }

Appearance medical(double hounsfield, const MedicalTableParameters& weights) {
  // Where one kind passes into the next. Attenuation of tissues: fat about -100, water 0, muscle 40, blood 60, spongy
  // bone from about 150, compact bone from 300.
  const double beyond_air = ramp(hounsfield, -400, -150);
  const double beyond_fat = ramp(hounsfield, -40, 10);
  const double beyond_tissue = ramp(hounsfield, 120, 250);
  const std::array<double, 4> share = {1 - beyond_air, beyond_air - beyond_fat, beyond_fat - beyond_tissue,
                                       beyond_tissue};
  const std::array<double, 4> weight = {weights.air, weights.fat, weights.tissue, weights.bone};
  static constexpr std::array<Rgb, 4> kColours = {Rgb{0.55F, 0.70F, 0.88F}, Rgb{0.93F, 0.80F, 0.50F},
                                                  Rgb{0.82F, 0.38F, 0.31F}, Rgb{0.96F, 0.93F, 0.84F}};
  Appearance look;
  double sum = 0;
  double greatest_share = -1;
  for (std::size_t kind = 0; kind < 4; ++kind) {
    const double extinction = share[kind] * kDensestMedical * std::pow(bounded(weight[kind], 0, 1), 4);
    if (share[kind] > greatest_share && sum <= 0) look.rgb = kColours[kind];
    greatest_share = std::max(greatest_share, share[kind]);
    if (extinction <= 0) continue;
    sum += extinction;
    const auto part = static_cast<float>(extinction / sum);
    for (std::size_t c = 0; c < 3; ++c) look.rgb[c] += part * (kColours[kind][c] - look.rgb[c]);
  }
  look.extinction = static_cast<float>(sum);
  look.lit = static_cast<float>(sum > kLitFrom ? (sum - kLitFrom) / (sum + 3 * kLitFrom) : 0);
  return look;
}

// Blue, cyan, green, yellow, red.
Rgb rainbow(double y) {
  const double at = 4 * y;
  const auto part = [](double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); };
  return {part(at - 2), part(std::min(at, 4 - at)), part(2 - at)};
}

VolumeUserRow row_at(const VolumeUserTable& table, double value) {
  const auto after = std::ranges::upper_bound(table.rows, value, {}, &VolumeUserRow::value);
  if (after == table.rows.begin()) return table.rows.front();
  if (after == table.rows.end()) return table.rows.back();
  const VolumeUserRow& a = *(after - 1);
  const VolumeUserRow& b = *after;
  const auto part = static_cast<float>((value - a.value) / (b.value - a.value));
  VolumeUserRow row{.value = value, .rgb = {}, .opacity = std::lerp(a.opacity, b.opacity, part)};
  for (std::size_t c = 0; c < 3; ++c) row.rgb[c] = std::lerp(a.rgb[c], b.rgb[c], part);
  return row;
}

struct Ramped {
  VolumeTable table;
  VolumeTableParameters parameters;  // within their ranges
  const VolumeUserTable* user;       // null unless the table is one
  ValueRange range;
  double densest;  // per metre
};

Appearance ramped(const Ramped& by, double x) {
  const VolumeTableParameters& p = by.parameters;
  const double y = std::clamp(0.5 + std::tan(p.window) * (x - (p.level - 1) / 2), 0.0, 1.0);
  Appearance look;
  double strength = std::min(1.0, p.gain * y);
  if (by.user != nullptr) {
    const VolumeUserRow row = row_at(*by.user, by.range.low + y * (by.range.high - by.range.low));
    look.rgb = row.rgb;
    strength = std::min(1.0, p.gain * static_cast<double>(row.opacity));
  } else if (by.table == VolumeTable::rainbow) {
    look.rgb = rainbow(y);
  } else {
    if (by.table == VolumeTable::exponential) strength = 1 - std::exp(-p.gain * y);
    look.rgb.fill(static_cast<float>(strength));
  }
  if (strength < kLeastStrength) strength = 0;
  look.extinction = static_cast<float>(by.densest * p.opacity * strength);
  look.lit = static_cast<float>(std::clamp((strength * p.opacity - 0.1) / 0.4, 0.0, 1.0));
  return look;
}

VolumeTableParameters within_ranges(const VolumeTableParameters& p) {
  return {.opacity = bounded(p.opacity, 0, kMostVolumeOpacity),
          .gain = bounded(p.gain, 0, kMostVolumeGain),
          .level = bounded(p.level, kLeastVolumeLevel, kMostVolumeLevel),
          .window = bounded(p.window, 0, kMostVolumeWindow)};
}

Ramped ramped_by(const TransferRequest& request, ValueRange range) {
  const VolumeSettings& settings = request.settings;
  const auto index = std::min(static_cast<std::size_t>(settings.table), kVolumeTables - 1);
  Ramped by{.table = settings.table,
            .parameters = within_ranges(settings.parameters[index]),
            .user = nullptr,
            .range = range,
            .densest = kDensestEdge / std::max(request.longest_edge_m, 1e-6)};
  for (std::size_t u = 0; u < request.user.size(); ++u) {
    const VolumeTable table = u == 0 ? VolumeTable::user1 : VolumeTable::user2;
    if (settings.table != table) continue;
    by.table = u == 0 ? VolumeTable::linear : VolumeTable::rainbow;
    const VolumeUserTable* const rows = request.user[u].get();
    if (rows != nullptr && rows->rows.size() >= 2) by.user = rows;
  }
  return by;
}

}  // namespace

const Appearance& TransferFunction::at(double value) const {
  const double last = static_cast<double>(entries.size() - 1);
  const double place = (value - range.low) / (range.high - range.low) * last;
  return entries[static_cast<std::size_t>(std::lround(bounded(place, 0, last)))];
}

TransferFunction make_transfer(const TransferRequest& request, std::size_t count) {
  TransferFunction made;
  made.range = request.range;
  if (!std::isfinite(made.range.low) || !std::isfinite(made.range.high)) made.range = {};
  if (!(made.range.high > made.range.low)) made.range.high = made.range.low + 1;
  made.entries.resize(std::max<std::size_t>(count, 2));
  const Ramped by = ramped_by(request, made.range);
  for (std::size_t i = 0; i < made.entries.size(); ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(made.entries.size() - 1);
    const double low = request.hounsfield ? made.range.low : kLowestRead;
    const double high = request.hounsfield ? made.range.high : kHighestRead;
    made.entries[i] = request.settings.table == VolumeTable::medical
                          ? medical(std::lerp(low, high, x), request.settings.medical)
                          : ramped(by, x);
  }
  return made;
}

}  // namespace cellmirror::volume
