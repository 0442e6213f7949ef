#include "sim_devices/faults/fault_spec.hpp"

#include <fmt/format.h>

#include <array>
#include <span>
#include <vector>

#include "rt_core/base/text.hpp"

namespace cellmirror::sim {
namespace {

constexpr std::size_t kMaxSpecLength = 512;

struct Key {
  std::string_view name;
  double least;
  double most;
  bool whole;  // a whole number
  void (*set)(FaultSpec&, double);
  std::string_view help;
};

constexpr double kLongest = 1e6;  // s

constexpr Key kRobot{"robot",
                     1,
                     64,
                     true,
                     [](FaultSpec& f, double v) { f.robot = static_cast<int>(v); },
                     "only robot N, counted from 1"};
constexpr Key kJoint{"joint",
                     1,
                     127,
                     true,
                     [](FaultSpec& f, double v) { f.joint = static_cast<int>(v); },
                     "only joint N of each robot, counted from 1"};
constexpr Key kProbability{
    "p", 0, 1, false, [](FaultSpec& f, double v) { f.probability = v; }, "probability for each message, default 1"};
constexpr Key kEvery{"every",
                     1,
                     1e9,
                     true,
                     [](FaultSpec& f, double v) { f.every = static_cast<std::uint64_t>(v); },
                     "each N-th message instead of by chance"};
constexpr Key kCount{
    "count", 1, 1e9, true, [](FaultSpec& f, double v) { f.most = static_cast<std::uint64_t>(v); }, "at most N times"};
constexpr Key kSeconds{"s", 0, kLongest, false, [](FaultSpec& f, double v) { f.seconds = v; }, "seconds"};
constexpr Key kJitter{"jitter",
                      0,
                      kLongest,
                      false,
                      [](FaultSpec& f, double v) { f.jitter_s = v; },
                      "random additional seconds, up to this many"};
constexpr Key kNumber{"n",
                      1,
                      1000,
                      true,
                      [](FaultSpec& f, double v) { f.number = static_cast<unsigned>(v); },
                      "copies (repeat), messages that pass (reorder), bits (corrupt); default 1"};
constexpr Key kRate{
    "rate", 0.001, 1e5, false, [](FaultSpec& f, double v) { f.rate_hz = v; }, "messages per second, default 10"};
constexpr Key kBy{"by", -1e6, 1e6, false, [](FaultSpec& f, double v) { f.amount = v; }, "rad or m"};
constexpr Key kId{"id",
                  0,
                  0x1FFFFFFF,
                  true,
                  [](FaultSpec& f, double v) { f.id = static_cast<std::uint32_t>(v); },
                  "CAN identifier, default random"};
constexpr Key kLengthBy{"by",
                        -64,
                        64,
                        true,
                        [](FaultSpec& f, double v) { f.change = static_cast<int>(v); },
                        "bytes or values more or less, default -1"};

constexpr std::array kMessageKeys{kProbability, kEvery, kCount, kRobot, kJoint};
constexpr std::array kValueKeys{kRobot, kJoint};
constexpr std::array kDelayKeys{kSeconds, kJitter};
constexpr std::array kRepeatKeys{kNumber, kSeconds};
constexpr std::array kInsertKeys{kRate, kId, kCount};
constexpr std::array kNumberKeys{kNumber};
constexpr std::array kIdKeys{kId};
constexpr std::array kLengthKeys{kLengthBy};
constexpr std::array kJumpKeys{kBy};
constexpr std::array kBurstKeys{kSeconds};

struct Kind {
  FaultKind kind;
  std::string_view name;
  std::string_view does;
  std::span<const Key> keys;
  std::span<const Key> common;
  bool of_messages;  // takes only=KIND
  std::string_view needed;
  std::string_view example;
};

const std::array<Kind, kFaultKinds> kKinds{{
    {FaultKind::loss, "loss", "messages vanish", {}, kMessageKeys, true, "", "loss:p=0.01"},
    {FaultKind::delay, "delay", "messages are sent later", kDelayKeys, kMessageKeys, true, "s", "delay:s=0.05@5..8"},
    {FaultKind::repeat, "repeat", "messages are sent n times more, s seconds apart", kRepeatKeys, kMessageKeys, true,
     "", "repeat:every=10,n=2"},
    {FaultKind::insert, "insert", "messages of unknown devices", kInsertKeys, {}, false, "", "insert:rate=50,id=0x7AA"},
    {FaultKind::reorder, "reorder", "a message (default: every second one) is held until n later ones have passed it",
     kNumberKeys, kMessageKeys, true, "", "reorder:p=0.1,n=2"},
    {FaultKind::corrupt, "corrupt", "n bits flip", kNumberKeys, kMessageKeys, true, "",
     "corrupt:p=0.001,n=3,only=sample"},
    {FaultKind::wrong_id, "wrong-id", "messages have another identity", kIdKeys, kMessageKeys, true, "",
     "wrong-id:every=100"},
    {FaultKind::wrong_length, "wrong-length", "messages are too short or too long", kLengthKeys, kMessageKeys, true, "",
     "wrong-length:by=-2,only=sample"},
    {FaultKind::frozen,
     "frozen",
     "values freeze, sending continues",
     {},
     kValueKeys,
     false,
     "",
     "frozen:joint=3@10..20"},
    {FaultKind::nan, "nan", "values are not a number (DDS only)", {}, kMessageKeys, false, "", "nan:joint=2,p=0.1"},
    {FaultKind::jump, "jump", "positions are off by a constant", kJumpKeys, kValueKeys, false, "by",
     "jump:by=0.5,joint=1@3..4"},
    {FaultKind::burst, "burst", "messages are collected for s seconds and sent at once", kBurstKeys, kMessageKeys, true,
     "s", "burst:s=0.2"},
    {FaultKind::death,
     "death",
     "silence; at the end of the window the device reboots",
     {},
     kValueKeys,
     false,
     "",
     "death:robot=1@5..8"},
    {FaultKind::bus_off, "bus-off", "an error frame, silence, a restart (CAN only)", {}, {}, false, "", "bus-off@5..6"},
}};

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

std::vector<std::string> key_names(const Kind& kind) {
  std::vector<std::string> names;
  for (const Key& key : kind.keys) names.emplace_back(key.name);
  for (const Key& key : kind.common) names.emplace_back(key.name);
  if (kind.of_messages) names.emplace_back("only");
  return names;
}

std::string joined(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

std::unexpected<Error> refused(std::string_view text, std::string what, std::string remedy) {
  return fail(fmt::format("fault '{}': {}", printable(text), what), std::move(remedy));
}

Result<void> parse_window(std::string_view text, std::string_view window, FaultSpec& spec) {
  const std::size_t dots = window.find("..");
  const std::string_view from = window.substr(0, dots);
  const std::string_view until = dots == std::string_view::npos ? std::string_view{} : window.substr(dots + 2);
  const auto time = [](std::string_view word, double otherwise) -> std::optional<double> {
    return word.empty() ? otherwise : parse_number(word);
  };
  const auto start = time(from, 0.0);
  const auto end = time(until, spec.until_s);
  if (!start || !end || *start < 0 || *start > kLongest || *end <= *start || (from.empty() && until.empty())) {
    return refused(text, fmt::format("'@{}' is not a time window", printable(window)),
                   "write @START..END, @START.. or @..END in seconds, e.g. @5..8");
  }
  spec.from_s = *start;
  spec.until_s = *end;
  return {};
}

Result<void> parse_only(std::string_view text, std::string_view value, FaultSpec& spec) {
  for (std::size_t i = 0; i < kMessageKindNames.size(); ++i) {
    if (kMessageKindNames[i] == value) {
      spec.only = static_cast<MessageKind>(i);
      return {};
    }
  }
  return refused(text, fmt::format("there is no kind of message '{}'", printable(value)),
                 fmt::format("kinds: {}", fmt::join(kMessageKindNames, ", ")));
}

const Key* find_key(const Kind& kind, std::string_view name) {
  for (const std::span<const Key> keys : {kind.keys, kind.common}) {
    for (const Key& key : keys) {
      if (key.name == name) return &key;
    }
  }
  return nullptr;
}

std::optional<double> parse_value(const Key& key, std::string_view value) {
  if (!key.whole) return parse_number(value);
  const auto number = parse_integer(value);
  return number ? std::optional(static_cast<double>(*number)) : std::nullopt;
}

Result<void> parse_key(std::string_view text, const Kind& kind, std::string_view item, FaultSpec& spec) {
  const std::size_t equals = item.find('=');
  const std::string_view name = trimmed(item.substr(0, equals));
  const std::string_view value =
      equals == std::string_view::npos ? std::string_view{} : trimmed(item.substr(equals + 1));
  if (kind.of_messages && name == "only") return parse_only(text, value, spec);
  const Key* key = find_key(kind, name);
  if (key == nullptr) {
    const std::vector<std::string> names = key_names(kind);
    return refused(text, fmt::format("{} has no key '{}'", kind.name, printable(name)),
                   names.empty() ? "it takes none" : fmt::format("its keys: {}", joined(names)));
  }
  const auto number = parse_value(*key, value);
  if (!number || *number < key->least || *number > key->most) {
    return refused(text, fmt::format("{}='{}' is out of range", key->name, printable(value)),
                   fmt::format("{} is {} from {} to {}", key->name, key->whole ? "a whole number" : "a number",
                               key->least, key->most));
  }
  key->set(spec, *number);
  return {};
}

}  // namespace

std::string_view name_of(FaultKind kind) { return kKinds[static_cast<std::size_t>(kind)].name; }

Result<FaultSpec> parse_fault(std::string_view text) {
  text = trimmed(text);
  if (text.size() > kMaxSpecLength) {
    return refused(text, fmt::format("longer than {} bytes", kMaxSpecLength), "split it into several faults");
  }
  const std::size_t at = text.find('@');
  const std::string_view head = text.substr(0, at);
  const std::size_t colon = head.find(':');
  const std::string_view name = trimmed(head.substr(0, colon));
  const Kind* found = nullptr;
  for (const Kind& kind : kKinds) {
    if (kind.name == name) found = &kind;
  }
  if (found == nullptr) {
    const std::string guess = did_you_mean(name, kind_names());
    return refused(text, fmt::format("there is no fault '{}'", printable(name)),
                   guess.empty() ? fmt::format("faults: {}", joined(kind_names())) : guess);
  }
  FaultSpec spec;
  spec.kind = found->kind;
  spec.text = text;
  if (at != std::string_view::npos) {
    if (auto window = parse_window(text, trimmed(text.substr(at + 1)), spec); !window)
      return std::unexpected(window.error());
  }
  std::string_view rest = colon == std::string_view::npos ? std::string_view{} : head.substr(colon + 1);
  bool needed_seen = found->needed.empty();
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    if (auto key = parse_key(text, *found, item, spec); !key) return std::unexpected(key.error());
    needed_seen = needed_seen || trimmed(item.substr(0, item.find('='))) == found->needed;
    rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
  }
  // Were every message held, none could pass.
  if (spec.kind == FaultKind::reorder && spec.every == 0 && spec.probability >= 1) spec.every = 2;
  if (!needed_seen) {
    return refused(text, fmt::format("{} needs {}=", found->name, found->needed),
                   fmt::format("e.g. {}", found->example));
  }
  return spec;
}

std::string fault_help() {
  std::string help =
      "A fault is KIND[:key=value[,key=value...]][@START..END]; the window is in seconds after the start of the "
      "program,\nor after the command that injects the fault. Without a window it lasts to the end.\n\n";
  for (const Kind& kind : kKinds) {
    help += fmt::format("  {:<13} {}\n  {:<13} e.g. {}\n", kind.name, kind.does, "", kind.example);
    for (const Key& key : kind.keys) help += fmt::format("  {:<13}   {:<7} {}\n", "", key.name, key.help);
    if (const auto names = key_names(kind); !names.empty())
      help += fmt::format("  {:<13}   keys: {}\n", "", joined(names));
  }
  help += "\n  Keys of most kinds:\n";
  for (const Key& key : kMessageKeys) help += fmt::format("    {:<7} {}\n", key.name, key.help);
  help += fmt::format("    only    only messages of one kind: {}\n", fmt::join(kMessageKindNames, ", "));
  return help;
}

}  // namespace cellmirror::sim
