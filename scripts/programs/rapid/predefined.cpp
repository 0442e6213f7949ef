#include "scripts/programs/rapid/predefined.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "rt_core/base/text.hpp"

namespace cellmirror::program::rapid {
namespace {

// mm/s at the TCP; all of them turn by 500 degrees a second.
constexpr auto kSpeeds =
    std::to_array<std::uint16_t>({5,   10,  20,  30,   40,   50,   60,   80,   100,  150,  200,  300, 400,
                                  500, 600, 800, 1000, 1500, 2000, 2500, 3000, 4000, 5000, 6000, 7000});
constexpr double kTurn = 500;  // degrees/s
// The radius of zN is N mm, but for z0.
constexpr auto kZones = std::to_array<std::uint16_t>({0, 1, 5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200});
constexpr double kRadiusOfZ0 = 0.3;  // mm

// "100" of "v100"; none where the rest is not a number without leading zeros.
std::optional<std::uint32_t> number_behind(std::string_view name, std::size_t letters) {
  const std::string_view digits = name.substr(std::min(letters, name.size()));
  std::uint32_t number = 0;
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (digits.empty() || result.ec != std::errc{} || result.ptr != digits.data() + digits.size()) return std::nullopt;
  if (digits.size() > 1 && digits.front() == '0') return std::nullopt;
  return number;
}

bool begins_with(std::string_view name, std::string_view letters) {
  return equal_ignoring_case(name.substr(0, letters.size()), letters);
}

struct Outside {
  std::string_view word;
  std::string_view instead;
};
constexpr auto kOutside = std::to_array<Outside>({
    {"accset", "delete it, and set the accelerations of the robot by SCRIPT"},
    {"connect", "interrupts are not in the subset: test the signal in the program"},
    {"confj", "delete it: axis configurations are not monitored"},
    {"confl", "delete it: axis configurations are not monitored"},
    {"error", "error handlers are not in the subset: delete it, a program ends at an error"},
    {"goto", "write it with IF, WHILE or a PROC"},
    {"movec", "approach the arc by several MoveL"},
    {"movejdo", "write MoveJ, and SetDO behind it"},
    {"moveldo", "write MoveL, and SetDO behind it"},
    {"pulsedo", "write Set, WaitTime and Reset"},
    {"singarea", "delete it: programs do not choose how singular positions are passed"},
    {"stopmove", "write Stop"},
    {"test", "write IF and ELSEIF"},
    {"tperase", "delete it: texts disappear by themselves"},
    {"tpreadfk", "read an input: IF di1 = 1 THEN"},
    {"tpreadnum", "assign the value in the program"},
    {"velset", "delete it, and choose the speeds of the moves"},
    {"waitdo", "write WHILE with TestDI of the input that shows it"},
    {"waituntil", "write WaitDI, or WHILE with a WaitTime in it"},
});

}  // namespace

std::optional<Speed> predefined_speed(std::string_view name) {
  if (equal_ignoring_case(name, "vmax")) return Speed{};
  if (!begins_with(name, "v")) return std::nullopt;
  const auto number = number_behind(name, 1);
  if (!number || std::ranges::find(kSpeeds, *number) == kSpeeds.end()) return std::nullopt;
  return Speed{static_cast<double>(*number), kTurn};
}

std::optional<Zone> predefined_zone(std::string_view name) {
  if (equal_ignoring_case(name, "fine")) return Zone{.fine = true};
  if (!begins_with(name, "z")) return std::nullopt;
  const auto number = number_behind(name, 1);
  if (!number || std::ranges::find(kZones, *number) == kZones.end()) return std::nullopt;
  return Zone{.fine = false, .radius_mm = *number == 0 ? kRadiusOfZ0 : static_cast<double>(*number)};
}

std::optional<SignalName> signal_of(std::string_view name) {
  const bool output = begins_with(name, "do");
  if (!output && !begins_with(name, "di")) return std::nullopt;
  const auto number = number_behind(name, name.size() > 2 && name[2] == '_' ? 3 : 2);
  if (!number || *number < 1 || *number > kMostPorts) return std::nullopt;
  return SignalName{output, *number};
}

std::string_view instead_of(std::string_view word) {
  const auto* const row =
      std::ranges::find_if(kOutside, [&](const Outside& one) { return equal_ignoring_case(one.word, word); });
  return row == kOutside.end() ? std::string_view() : row->instead;
}

}  // namespace cellmirror::program::rapid
