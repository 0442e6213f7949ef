#include "sim_devices/haptic/haptic_fault.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "rt_core/base/text.hpp"
#include "sim_devices/base/text_items.hpp"

namespace cellmirror::sim {
namespace {

constexpr std::size_t kMaxSpecLength = 200;
constexpr double kLongest = 1e6;

struct Kind {
  std::string_view name;
  std::string_view does;
  std::string_view example;
};

// In the order of HapticFaultKind.
constexpr std::array<Kind, 11> kKinds{{
    {"freeze", "no more writes, the process lives", "freeze@3"},
    {"stuck", "values freeze, writing continues", "stuck@3..4"},
    {"jump", "the pose is off by `by` m and rad (0.05)", "jump:by=0.05@3..4"},
    {"nan", "a coordinate is not a number", "nan@3..3.1"},
    {"rotation", "the quaternion is not a rotation", "rotation@3..3.1"},
    {"late", "time stamps are older by `s` seconds (0.02)", "late:s=0.02@3"},
    {"dead", "the process is killed", "dead@3"},
    {"twice", "a second process writes into the same memory", "twice@3..4"},
    {"invalid", "the device clears its good bit", "invalid@3..4"},
    {"torn", "the process is killed while it writes", "torn@3"},
    {"unbounded", "coordinates of 1e300", "unbounded@3..3.1"},
}};

std::unexpected<Error> refused(std::string_view text, std::string what, std::string remedy) {
  return fail(fmt::format("fault '{}': {}", printable(text), what), std::move(remedy));
}

Result<void> parse_window(std::string_view text, std::string_view window, HapticFaultSpec& spec) {
  const std::size_t dots = window.find("..");
  const auto from = parse_number(window.substr(0, dots));
  const std::string_view end = dots == std::string_view::npos ? std::string_view{} : window.substr(dots + 2);
  const auto until = end.empty() ? std::optional(spec.until_s) : parse_number(end);
  if (!from || !until || *from < 0 || *from > kLongest || *until <= *from) {
    return refused(text, fmt::format("'@{}' is not a time window", printable(window)),
                   "write @START or @START..END in seconds, e.g. @3..4");
  }
  spec.from_s = *from;
  spec.until_s = *until;
  return {};
}

Result<void> parse_key(std::string_view text, std::string_view item, HapticFaultSpec& spec) {
  const auto pair = parse_key_value(item);
  const bool by = pair && pair->key == "by" && spec.kind == HapticFaultKind::jump;
  const bool s = pair && pair->key == "s" && spec.kind == HapticFaultKind::late;
  const auto value = pair ? parse_number(pair->value) : std::nullopt;
  if (!(by || s) || !value || *value <= 0 || *value > 1000) {
    return refused(text, fmt::format("'{}' is not understood", printable(item)),
                   "jump takes by=METRES, late takes s=SECONDS, the others take nothing");
  }
  (by ? spec.by : spec.late_s) = *value;
  return {};
}

}  // namespace

std::string_view name_of(HapticFaultKind kind) { return kKinds[static_cast<std::size_t>(kind)].name; }

Result<HapticFaultSpec> parse_haptic_fault(std::string_view text) {
  text = trimmed(text);
  if (text.size() > kMaxSpecLength) return refused(text, "too long", "split it into several faults");
  const std::size_t at = text.find('@');
  const std::string_view head = text.substr(0, at);
  const std::size_t colon = head.find(':');
  const std::string_view name = trimmed(head.substr(0, colon));
  std::vector<std::string> names;
  HapticFaultSpec spec;
  spec.text = text;
  bool found = false;
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    names.emplace_back(kKinds[i].name);
    if (kKinds[i].name == name) {
      spec.kind = static_cast<HapticFaultKind>(i);
      found = true;
    }
  }
  if (!found) {
    const std::string guess = did_you_mean(name, names);
    return refused(text, fmt::format("there is no fault '{}'", printable(name)),
                   guess.empty() ? fmt::format("faults: {}", fmt::join(names, ", ")) : guess);
  }
  if (at != std::string_view::npos) {
    if (auto window = parse_window(text, trimmed(text.substr(at + 1)), spec); !window) {
      return std::unexpected(window.error());
    }
  }
  if (colon != std::string_view::npos) {
    for (const std::string_view item : split(head.substr(colon + 1), ',', 8)) {
      if (auto key = parse_key(text, item, spec); !key) return std::unexpected(key.error());
    }
  }
  return spec;
}

std::string haptic_fault_help() {
  std::string help =
      "A fault is KIND[:key=value][@START] or @START..END, in seconds after the device's first write; without an end "
      "it\nlasts.\n\n";
  for (const Kind& kind : kKinds) help += fmt::format("  {:<10} {:<48} {}\n", kind.name, kind.does, kind.example);
  return help;
}

void strike(const HapticFaultSpec& fault, const HapticSample& before, HapticSample& sample) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kHuge = 1e300;
  switch (fault.kind) {
    case HapticFaultKind::stuck:
      sample.p_DH = before.p_DH;
      sample.q_DH = before.q_DH;
      sample.gripper = before.gripper;
      sample.axes = before.axes;
      return;
    case HapticFaultKind::jump:
      sample.p_DH.array() += fault.by;
      for (std::size_t i = 0; i < sample.axis_count; ++i) sample.axes[i] += fault.by;
      return;
    case HapticFaultKind::nan:
      sample.p_DH.y() = kNan;
      sample.axes[1] = kNan;
      return;
    case HapticFaultKind::rotation:
      sample.q_DH.coeffs().setZero();
      return;
    case HapticFaultKind::late:
      sample.time = sample.time - Nanoseconds(static_cast<std::int64_t>(fault.late_s * 1e9));
      return;
    case HapticFaultKind::invalid:
      sample.valid = false;
      return;
    case HapticFaultKind::unbounded:
      sample.p_DH.setConstant(kHuge);
      sample.axes.fill(kHuge);
      return;
    case HapticFaultKind::freeze:
    case HapticFaultKind::dead:
    case HapticFaultKind::twice:
    case HapticFaultKind::torn:
      return;  // not a matter of values
  }
}

}  // namespace cellmirror::sim
