#include "drivers/can/dbc/unit.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

struct Unit {
  std::string_view word;
  double scale;
};

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kInch = 0.0254;

// In lower case. A DBC is Latin-1 by its format; many are written in UTF-8.
constexpr std::array kWords = std::to_array<Unit>({
    {"deg", kDegree},
    {"degree", kDegree},
    {"degrees", kDegree},
    {"\xB0", kDegree},
    {"\xC2\xB0", kDegree},
    {"deg/s", kDegree},
    {"deg/sec", kDegree},
    {"degree/s", kDegree},
    {"degrees/s", kDegree},
    {"\xB0/s", kDegree},
    {"\xC2\xB0/s", kDegree},
    {"mrad", 1e-3},
    {"mrad/s", 1e-3},
    {"rev", kTurn},
    {"revolution", kTurn},
    {"revolutions", kTurn},
    {"turn", kTurn},
    {"turns", kTurn},
    {"rev/s", kTurn},
    {"rps", kTurn},
    {"rpm", kTurn / 60},
    {"1/min", kTurn / 60},
    {"r/min", kTurn / 60},
    {"rev/min", kTurn / 60},
    {"u/min", kTurn / 60},
    {"mm", 1e-3},
    {"cm", 1e-2},
    {"um", 1e-6},
    {"\xB5m", 1e-6},
    {"\xC2\xB5m", 1e-6},
    {"inch", kInch},
    {"in", kInch},
    {"mm/s", 1e-3},
    {"cm/s", 1e-2},
    {"m/min", 1.0 / 60},
    {"mm/min", 1e-3 / 60},
    {"ncm", 1e-2},
    {"nmm", 1e-3},
});
// Where a capital letter makes another unit.
constexpr std::array kExact = std::to_array<Unit>({
    {"mNm", 1e-3},
    {"kNm", 1e3},
    {"mN", 1e-3},
    {"kN", 1e3},
});

}  // namespace

std::optional<double> si_scale_of(std::string_view unit) {
  const std::string_view word = trimmed(unit);
  if (const auto* exact = std::ranges::find(kExact, word, &Unit::word); exact != kExact.end()) return exact->scale;
  const auto* known = std::ranges::find(kWords, lower_case(word), &Unit::word);
  if (known == kWords.end()) return std::nullopt;
  return known->scale;
}

}  // namespace cellmirror::can
