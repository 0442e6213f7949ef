#include "app/gateway/node_fault_request.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <vector>

#include "rt_core/base/text.hpp"
#include "rt_core/ports/io_image.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kLongestText = 200;
constexpr double kLongestDelay = 10.0;      // s
constexpr double kLongestFault = 86'400.0;  // s
constexpr std::size_t kMostKeys = 4;

Nanoseconds nanoseconds(double s) { return Nanoseconds(std::llround(s * 1e9)); }

// The number of a name in a list; tells the known ones.
Result<std::size_t> place_of(std::string_view name, std::span<const std::string_view> names, std::string_view what) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  return fail(fmt::format("there is no {} {}", what, printable(name)),
              fmt::format("known: {}", fmt::join(names, ", ")));
}

Result<double> number_in(std::string_view key, std::string_view text, double least, double most) {
  // Hexadecimal, as error codes are written.
  const auto whole = parse_integer(text);
  const auto number = whole ? std::optional(static_cast<double>(*whole)) : parse_number(text);
  if (!number || !(*number >= least && *number <= most))
    return fail(fmt::format("{}={} is no number from {} to {}", key, printable(text), least, most));
  return *number;
}

struct Key {
  NodeFaultKind kind;
  std::string_view name;
  double least;
  double most;
  bool needed;
  void (*set)(NodeFault&, double);
};

constexpr double kMostBit = kIoBits - 1;
constexpr Key kKeys[] = {
    {NodeFaultKind::loss, "p", 0, 1, false, [](NodeFault& fault, double value) { fault.probability = value; }},
    {NodeFaultKind::delay, "s", 0, kLongestDelay, true,
     [](NodeFault& fault, double value) { fault.by = nanoseconds(value); }},
    {NodeFaultKind::emergency, "code", 1, 0xFFFF, true,
     [](NodeFault& fault, double value) { fault.code = static_cast<std::uint16_t>(value); }},
    {NodeFaultKind::stuck, "bit", 0, kMostBit, false,
     [](NodeFault& fault, double value) { fault.input = static_cast<std::uint8_t>(value); }},
    {NodeFaultKind::stuck, "channel", 1, kIoAnalogues, false,
     [](NodeFault& fault, double value) {
       fault.analogue = true;
       fault.input = static_cast<std::uint8_t>(value - 1);
     }},
    {NodeFaultKind::stuck, "value", -32768, 32767, true,
     [](NodeFault& fault, double value) { fault.value = static_cast<std::int16_t>(value); }},
};

Result<void> set_key(NodeFault& fault, std::string_view name, std::string_view text) {
  const bool of_frames = fault.kind == NodeFaultKind::loss || fault.kind == NodeFaultKind::delay;
  if (name == "only" && of_frames) {
    const auto frames = place_of(text, kNodeFrameNames, "kind of frames");
    if (!frames) return std::unexpected(frames.error());
    fault.only = static_cast<NodeFrames>(*frames);
    return {};
  }
  std::vector<std::string_view> known;
  for (const Key& key : kKeys) {
    if (key.kind != fault.kind) continue;
    known.push_back(key.name);
    if (key.name != name) continue;
    const auto value = number_in(name, text, key.least, key.most);
    if (!value) return std::unexpected(value.error());
    key.set(fault, *value);
    return {};
  }
  if (of_frames) known.emplace_back("only");
  return fail(fmt::format("{} is no key of this fault", printable(name)),
              known.empty() ? "it has none" : fmt::format("known: {}", fmt::join(known, ", ")));
}

Result<void> check_keys(const NodeFault& fault, const std::vector<std::string_view>& given) {
  const auto has = [&given](std::string_view name) { return std::ranges::find(given, name) != given.end(); };
  for (const Key& key : kKeys) {
    if (key.kind == fault.kind && key.needed && !has(key.name)) return fail(fmt::format("{}= is missing", key.name));
  }
  if (fault.kind != NodeFaultKind::stuck) return {};
  if (has("bit") == has("channel")) return fail("an input is bit= or channel=");
  if (has("bit") && fault.value != 0 && fault.value != 1) return fail("a digital input has the value 0 or 1");
  return {};
}

}  // namespace

Result<NodeFault> parse_node_fault(std::string_view text) {
  if (text.size() > kLongestText) return fail("the fault is too long");
  const std::size_t colon = text.find(':');
  const auto kind = place_of(text.substr(0, colon), kNodeFaultNames, "fault");
  if (!kind) return std::unexpected(kind.error());
  NodeFault fault;
  fault.kind = static_cast<NodeFaultKind>(*kind);
  std::vector<std::string_view> given;
  std::string_view left = colon == std::string_view::npos ? std::string_view{} : text.substr(colon + 1);
  while (!left.empty()) {
    const std::string_view item = left.substr(0, left.find(','));
    left.remove_prefix(std::min(item.size() + 1, left.size()));
    const std::size_t equals = item.find('=');
    const std::string_view name = item.substr(0, equals);
    if (equals == std::string_view::npos) return fail(fmt::format("{} is no key=value", printable(item)));
    if (std::ranges::find(given, name) != given.end() || given.size() >= kMostKeys)
      return fail(fmt::format("{}= comes twice, or there are too many keys", printable(name)));
    given.push_back(name);
    if (const auto set = set_key(fault, name, item.substr(equals + 1)); !set) return std::unexpected(set.error());
  }
  if (const auto whole = check_keys(fault, given); !whole) return std::unexpected(whole.error());
  return fault;
}

Result<FaultRequest> fault_request(const ControlRequest& request) {
  FaultRequest out;
  constexpr std::string_view kKnown[] = {"node", "fault", "end", "for_s", "channel"};
  for (const auto& [name, text] : request.arguments) {
    if (std::ranges::find(kKnown, name) == std::end(kKnown))
      return fail(fmt::format("the member {} is not known", printable(name)),
                  fmt::format("known: {}", fmt::join(kKnown, ", ")));
  }
  constexpr double kMostNode = 127;
  const auto node = number_in("node", request.argument("node").value_or(""), 1, kMostNode);
  if (!node) return std::unexpected(node.error());
  out.channel = request.argument("channel").value_or("");
  out.order.ends_all = request.argument("end") == "true";
  if (!out.order.ends_all) {
    const auto fault = parse_node_fault(request.argument("fault").value_or(""));
    if (!fault) return std::unexpected(fault.error());
    out.order.fault = *fault;
  }
  out.order.node = static_cast<std::uint8_t>(*node);
  if (const auto text = request.argument("for_s")) {
    const auto time = number_in("for_s", *text, 0, kLongestFault);
    if (!time) return std::unexpected(time.error());
    out.order.fault.lasts = nanoseconds(*time);
  }
  return out;
}

}  // namespace cellmirror::app
