#include "sim_devices/camera/head_fault.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <vector>

#include "rt_core/base/text.hpp"
#include "sim_devices/base/text_items.hpp"

namespace cellmirror::sim {
namespace {

constexpr std::size_t kMaxSpecLength = 200;
constexpr double kLongest = 1e6;  // s

struct Kind {
  std::string_view name;
  std::string_view does;
  std::string_view example;
};

// In the order of HeadFaultKind.
constexpr std::array<Kind, kHeadFaultKinds> kKinds{{
    {"stuck", "an axis does not move, and its drive says so", "stuck:joint=1@3..8"},
    {"slow", "an axis has only `by` of its speed (0.1)", "slow:by=0.2@3"},
    {"runaway", "an axis drives to its stop", "runaway:joint=2@3..4"},
    {"deaf", "records are ignored", "deaf@3..8"},
    {"late", "records take effect `s` seconds later (0.5)", "late:s=1"},
}};

std::unexpected<Error> refused(std::string_view text, std::string what, std::string remedy) {
  return fail(fmt::format("fault '{}': {}", printable(text), what), std::move(remedy));
}

std::string_view name_in(std::string_view text) {
  text = trimmed(text);
  return trimmed(text.substr(0, text.find_first_of(":@")));
}

std::optional<HeadFaultKind> kind_of(std::string_view name) {
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    if (kKinds[i].name == name) return static_cast<HeadFaultKind>(i);
  }
  return {};
}

Result<void> parse_window(std::string_view text, std::string_view window, HeadFaultSpec& spec) {
  const std::size_t dots = window.find("..");
  const auto from = parse_number(window.substr(0, dots));
  const std::string_view end = dots == std::string_view::npos ? std::string_view{} : window.substr(dots + 2);
  const auto until = end.empty() ? std::optional(spec.until_s) : parse_number(end);
  if (!from || !until || !(*from >= 0) || !(*from <= kLongest) || !(*until > *from)) {
    return refused(text, fmt::format("'@{}' is not a time window", printable(window)),
                   "write @START or @START..END in seconds, e.g. @3..4");
  }
  spec.from_s = *from;
  spec.until_s = *until;
  return {};
}

Result<void> parse_key(std::string_view text, std::string_view item, HeadFaultSpec& spec) {
  const auto pair = parse_key_value(item);
  const auto value = pair ? parse_number(pair->value) : std::nullopt;
  const bool of_axis =
      spec.kind == HeadFaultKind::stuck || spec.kind == HeadFaultKind::slow || spec.kind == HeadFaultKind::runaway;
  if (value && pair->key == "joint" && of_axis && (*value == 1 || *value == 2)) {
    spec.joint = static_cast<int>(*value);
  } else if (value && pair->key == "by" && spec.kind == HeadFaultKind::slow && *value >= 0 && *value <= 1) {
    spec.scale = *value;
  } else if (value && pair->key == "s" && spec.kind == HeadFaultKind::late && *value > 0 && *value <= 60) {
    spec.delay_s = *value;
  } else {
    return refused(text, fmt::format("'{}' is not understood", printable(item)),
                   "stuck, slow and runaway take joint=1 (pan) or 2 (tilt), slow by=0 to 1, late s=SECONDS up to 60");
  }
  return {};
}

}  // namespace

std::string_view name_of(HeadFaultKind kind) { return kKinds[static_cast<std::size_t>(kind)].name; }

bool is_head_fault(std::string_view text) { return kind_of(name_in(text)).has_value(); }

Result<HeadFaultSpec> parse_head_fault(std::string_view text) {
  text = trimmed(text);
  if (text.size() > kMaxSpecLength) return refused(text, "too long", "split it into several faults");
  HeadFaultSpec spec;
  spec.text = text;
  const auto kind = kind_of(name_in(text));
  if (!kind) {
    std::vector<std::string> names;
    for (const Kind& known : kKinds) names.emplace_back(known.name);
    const std::string guess = did_you_mean(name_in(text), names);
    return refused(text, fmt::format("there is no fault '{}'", printable(name_in(text))),
                   guess.empty() ? fmt::format("faults: {}", fmt::join(names, ", ")) : guess);
  }
  spec.kind = *kind;
  const std::size_t at = text.find('@');
  const std::string_view head = text.substr(0, at);
  if (at != std::string_view::npos) {
    if (auto window = parse_window(text, trimmed(text.substr(at + 1)), spec); !window) {
      return std::unexpected(window.error());
    }
  }
  const std::size_t colon = head.find(':');
  if (colon == std::string_view::npos) return spec;
  for (const std::string_view item : split(head.substr(colon + 1), ',', 8)) {
    if (auto key = parse_key(text, item, spec); !key) return std::unexpected(key.error());
  }
  return spec;
}

std::string head_fault_help() {
  std::string help = "Faults of the head's motion (its drives also have all faults of `sim_robot faults`):\n\n";
  for (const Kind& kind : kKinds) help += fmt::format("  {:<9} {:<46} {}\n", kind.name, kind.does, kind.example);
  return help;
}

}  // namespace cellmirror::sim
