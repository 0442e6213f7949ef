#include "sim_devices/haptic/motion_script.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "rt_core/base/text.hpp"
#include "sim_devices/base/text_items.hpp"

namespace cellmirror::sim {
namespace {

struct VerbRow {
  std::string_view name;
  std::string_view form;
  std::string_view does;
  int directions;
  bool amount_needed;
  bool amount_taken;
  bool duration_taken;
  std::string_view keys;  // blank-separated
  double duration_s;
};

// In the order of MotionVerb.
constexpr std::array<VerbRow, 10> kVerbs{{
    {"hold", "hold [TIME]", "stays where it is", 0, false, false, true, "for", 1},
    {"touch", "touch DIRECTION DISTANCE", "moves until it feels the force `at`, or to the end of the distance", 1, true,
     true, false, "speed at", 0},
    {"press", "press [DEPTH] [TIME]", "sets its target deeper in the direction of the last touch, and stays", 0, false,
     true, true, "for", 1},
    {"drag", "drag DIRECTION DISTANCE", "moves regardless of force", 1, true, true, false, "speed", 0},
    {"tap", "tap DIRECTION DISTANCE", "touches and returns, `times` times, one per `period`", 1, true, true, false,
     "times period at", 0},
    {"sine", "sine DIRECTION AMPLITUDE [TIME]", "oscillates about its position", 1, true, true, true, "period for", 1},
    {"circle", "circle DIRECTION DIRECTION RADIUS [TIME]", "begins at its position in the first direction", 2, true,
     true, true, "period for", 1},
    {"back", "back", "returns to the start of the motion", 0, false, false, false, "speed", 0},
    {"letgo", "letgo [TIME]", "releases the handle, then holds it at its new position", 0, false, false, true, "for",
     0.5},
    {"button", "button NUMBER on|off", "presses or releases a button, from 1", 0, false, false, false, "", 0},
}};

struct KeyRow {
  std::string_view name;
  double least;
  double most;
  std::string_view unit;
};
constexpr std::array<KeyRow, 5> kKeys{{{"speed", 1e-4, 100, "m/s or rad/s"},
                                       {"at", 1e-6, 1000, "N or Nm"},
                                       {"times", 1, 100000, ""},
                                       {"period", 0.01, 1000, "a time, e.g. 500ms"},
                                       {"for", 0, 1e6, "a time, e.g. 2s"}}};
constexpr double kFarthest = 10;  // m or rad
constexpr std::size_t kMaxWords = 16;

class ScriptReader {
 public:
  ScriptReader(std::string_view text, std::string_view file, const AxisLayout& layout, Diagnostics& diagnostics)
      : text_(text), file_(file), layout_(layout), diagnostics_(diagnostics) {}

  std::vector<MotionStep> read() {
    std::string_view rest = text_;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find_first_of(";\n"), rest.size());
      std::string_view statement = rest.substr(0, end);
      std::size_t used = end;
      if (const std::size_t comment = statement.find('#'); comment != std::string_view::npos) {
        statement = statement.substr(0, comment);
        used = std::min(rest.find('\n'), rest.size());
      }
      if (!trimmed(statement).empty() && !take(statement)) break;
      rest.remove_prefix(std::min(used + 1, rest.size()));
    }
    return std::move(steps_);
  }

 private:
  bool take(std::string_view statement) {
    if (steps_.size() == kMaxMotionSteps) {
      error(statement, fmt::format("more than {} steps", kMaxMotionSteps), "repeat the motion instead (--repeat)");
      return false;
    }
    const auto all = words(statement, kMaxWords + 1);
    if (all.empty()) return true;
    if (all.size() > kMaxWords) {
      error(all.back(), "too many words for one step", "separate steps by ';'");
      return true;
    }
    const std::string_view name = all.front();
    for (std::size_t i = 0; i < kVerbs.size(); ++i) {
      if (kVerbs[i].name == name) {
        step_ = MotionStep{};
        step_.verb = static_cast<MotionVerb>(i);
        step_.duration_s = kVerbs[i].duration_s;
        read_step(kVerbs[i], all);
        return true;
      }
    }
    std::vector<std::string> names;
    for (const VerbRow& row : kVerbs) names.emplace_back(row.name);
    const std::string guess = did_you_mean(name, names);
    error(name, fmt::format("there is no motion '{}'", printable(name, 40)),
          guess.empty() ? fmt::format("motions: {}", fmt::join(names, ", ")) : guess);
    return true;
  }

  void read_step(const VerbRow& verb, const std::vector<std::string_view>& all) {
    const std::size_t errors_before = diagnostics_.errors();
    directions_ = 0;
    amount_.reset();
    if (step_.verb == MotionVerb::button) {
      read_button(verb, all);
    } else {
      for (std::size_t i = 1; i < all.size(); ++i) read_word(verb, all[i]);
      if (directions_ < verb.directions || (verb.amount_needed && !amount_)) {
        error(all.front(), fmt::format("'{}' is not complete", verb.name), fmt::format("write {}", verb.form));
      }
    }
    if (diagnostics_.errors() != errors_before) return;
    if (step_.verb == MotionVerb::press && !amount_) amount_ = kUsualDepth;
    step_.amount = std::abs(amount_.value_or(0));
    if (amount_.value_or(0) < 0) {
      for (double& part : step_.direction) part = -part;
    }
    if (step_.verb == MotionVerb::circle && std::abs(dot(step_.direction, step_.sideways)) > 1e-9) {
      error(all.front(), "the circle's two directions are not at right angles", "e.g. circle x y 0.01");
      return;
    }
    steps_.push_back(step_);
  }

  void read_button(const VerbRow& verb, const std::vector<std::string_view>& all) {
    const auto number = all.size() == 3 ? parse_integer(all[1]) : std::nullopt;
    if (!number || *number < 1 || *number > 32 || (all[2] != "on" && all[2] != "off")) {
      error(all.front(), "the button is invalid", fmt::format("write {}, buttons 1 to 32", verb.form));
      return;
    }
    step_.button = static_cast<std::uint32_t>(*number);
    step_.on = all[2] == "on";
  }

  void read_word(const VerbRow& verb, std::string_view word) {
    if (const auto pair = parse_key_value(word)) return read_key(verb, word, *pair);
    if (const auto duration = parse_duration(word); duration && verb.duration_taken) {
      step_.duration_s = *duration;
      return;
    }
    if (const auto number = parse_number(word); number && verb.amount_taken && !amount_) {
      if (std::abs(*number) > kFarthest) {
        error(word, fmt::format("{} is farther than {} m (rad)", printable(word, 40), kFarthest), "");
        return;
      }
      amount_ = number;
      return;
    }
    if (const auto direction = parse_direction(word); direction && directions_ < verb.directions) {
      (directions_++ == 0 ? step_.direction : step_.sideways) = *direction;
      return;
    }
    error(word, fmt::format("'{}' does not belong to {}", printable(word, 40), verb.name),
          verb.directions > 0 ? fmt::format("write {}; directions: {}, -{}, or a vector 1,0,-1", verb.form,
                                            fmt::join(layout_.names(), ", "), layout_.names()[0])
                              : fmt::format("write {}", verb.form));
  }

  void read_key(const VerbRow& verb, std::string_view word, const KeyValue& pair) {
    const auto allowed = words(verb.keys, kKeys.size());
    const auto row = std::find_if(kKeys.begin(), kKeys.end(), [&](const KeyRow& key) { return key.name == pair.key; });
    if (row == kKeys.end() || std::find(allowed.begin(), allowed.end(), pair.key) == allowed.end()) {
      error(word, fmt::format("{} has no key '{}'", verb.name, printable(pair.key, 40)),
            allowed.empty() ? "it takes none" : fmt::format("its keys: {}", fmt::join(allowed, ", ")));
      return;
    }
    const bool is_time = row->name == "period" || row->name == "for";
    const auto value = is_time ? parse_duration(pair.value) : parse_number(pair.value);
    const bool whole = row->name == "times";
    if (!value || *value < row->least || *value > row->most || (whole && std::floor(*value) != *value)) {
      error(word, fmt::format("{}='{}' is out of range", row->name, printable(pair.value, 40)),
            fmt::format("from {} to {} {}", row->least, row->most, row->unit));
      return;
    }
    if (row->name == "speed") step_.speed = *value;
    if (row->name == "at") step_.threshold = *value;
    if (row->name == "times") step_.times = static_cast<std::uint32_t>(*value);
    if (row->name == "period") step_.period_s = *value;
    if (row->name == "for") step_.duration_s = *value;
  }

  std::optional<Coordinates> parse_direction(std::string_view word) const {
    Coordinates direction{};
    const double sign = word.starts_with('-') ? -1 : 1;
    const std::string_view name = word.starts_with('-') || word.starts_with('+') ? word.substr(1) : word;
    if (const auto axis = layout_.find(name)) {
      direction[*axis] = sign;
      return direction;
    }
    const auto parts = split(word, ',', 4);
    if (parts.size() != 3) return std::nullopt;
    double squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto part = parse_number(parts[i]);
      if (!part || std::abs(*part) > 1e6) return std::nullopt;
      direction[i] = *part;
      squared += *part * *part;
    }
    if (squared < 1e-12) return std::nullopt;
    for (double& part : direction) part /= std::sqrt(squared);
    return direction;
  }

  static double dot(const Coordinates& a, const Coordinates& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  }

  void error(std::string_view at, std::string message, std::string remedy) {
    const auto offset = static_cast<std::size_t>(at.data() - text_.data());
    const std::string_view before = text_.substr(0, offset);
    const std::size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    diagnostics_.error({std::string(file_), static_cast<int>(line), static_cast<int>(offset - line_start + 1)},
                       std::move(message), std::move(remedy));
  }

  static constexpr double kUsualDepth = 0.005;

  std::string_view text_;
  std::string_view file_;
  const AxisLayout& layout_;
  Diagnostics& diagnostics_;
  std::vector<MotionStep> steps_;
  MotionStep step_;
  int directions_ = 0;
  std::optional<double> amount_;
};

}  // namespace

std::vector<MotionStep> parse_motion(std::string_view text, std::string_view file, const AxisLayout& layout,
                                     Diagnostics& diagnostics) {
  if (text.size() > kMaxMotionText) {
    diagnostics.error({std::string(file)}, fmt::format("longer than {} bytes", kMaxMotionText), "shorten the motion");
    return {};
  }
  return ScriptReader(text, file, layout, diagnostics).read();
}

std::string haptic_motion_help() {
  std::string help =
      "A motion is a list of steps, separated by ';':\n  touch z -0.03 speed=0.02; press 0.004 2s; drag x 0.02; letgo; "
      "back\n\n";
  for (const VerbRow& verb : kVerbs) {
    help +=
        fmt::format("  {:<42} {}{}\n", verb.form, verb.does,
                    verb.keys.empty() ? "" : fmt::format(" [{}]", fmt::join(words(verb.keys, kKeys.size()), "=, ")));
  }
  help +=
      "\nDirections: yaw, pitch, insertion, roll, jaw (4 and 5 axes), x, y, z, rx, ry, rz, gripper (6 and 7 axes), "
      "each\n"
      "also with '-', or a vector such as 1,0,-1 of the first three. Distances in m or rad, times as 2s or 250ms.\n\n";
  for (const KeyRow& key : kKeys) {
    help += fmt::format("  {:<8} {} to {} {}\n", fmt::format("{}=", key.name), key.least, key.most, key.unit);
  }
  return help;
}

}  // namespace cellmirror::sim
