#include "sim_devices/robot/control_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "rt_core/base/text.hpp"

namespace cellmirror::sim {
namespace {

const std::vector<std::string> kVerbs{"fault", "clear", "emcy",   "die",  "return",
                                      "hold",  "go",    "status", "help", "quit"};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

// "robot=2" or "joint=3".
Result<void> read_source(std::string_view word, Source& source) {
  const std::size_t equals = word.find('=');
  const std::string_view name = word.substr(0, equals);
  const long long number = equals == std::string_view::npos ? -1 : parse_integer(word.substr(equals + 1)).value_or(-1);
  if ((name != "robot" && name != "joint") || number < 1 || number > 127) {
    return fail(fmt::format("'{}' is not a robot or joint", printable(word)),
                "write robot=N or joint=N, counted from 1");
  }
  (name == "robot" ? source.robot : source.joint) = static_cast<int>(number);
  return {};
}

Result<ControlCommand> clear(const std::vector<std::string_view>& words) {
  if (words.size() == 1) return EndFaults{};
  if (words.size() > 2) return fail("clear takes at most one word", "clear | clear ID | clear KIND");
  if (words[1] == "all") return EndFaults{};
  if (const auto id = parse_integer(words[1])) {
    if (*id < 1 || *id > 1'000'000'000) return fail(fmt::format("there is no fault {}", *id), "ask `status`");
    return EndFaults{static_cast<int>(*id), std::nullopt};
  }
  for (std::size_t i = 0; i < kFaultKinds; ++i) {
    if (name_of(static_cast<FaultKind>(i)) == words[1]) return EndFaults{0, static_cast<FaultKind>(i)};
  }
  return fail(fmt::format("there is no fault '{}'", printable(words[1])), "clear | clear ID | clear KIND; ask `help`");
}

Result<ControlCommand> emergency(const std::vector<std::string_view>& words) {
  SendEmergency command;
  const auto code = words.size() > 1 ? parse_integer(words[1]) : std::nullopt;
  if (!code || *code < 0 || *code > 0xFFFF) {
    return fail("emcy needs an error code of 16 bits", "e.g. emcy 0x8611 joint=3");
  }
  command.code = static_cast<std::uint16_t>(*code);
  for (std::size_t i = 2; i < words.size(); ++i) {
    if (words[i].starts_with("register=")) {
      const auto bits = parse_integer(words[i].substr(9));
      if (!bits || *bits < 0 || *bits > 255) return fail("register= needs a byte", "e.g. register=0x21");
      command.error_register = static_cast<std::uint8_t>(*bits);
    } else if (auto read = read_source(words[i], command.source); !read) {
      return std::unexpected(read.error());
    }
  }
  return command;
}

// `die` and `return` are short forms of the fault "death".
Result<ControlCommand> die(const std::vector<std::string_view>& words) {
  Source source;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (auto read = read_source(words[i], source); !read) return std::unexpected(read.error());
  }
  AddFault command;
  command.spec.kind = FaultKind::death;
  command.spec.text = "death";
  command.spec.robot = source.robot;
  command.spec.joint = source.joint;
  return command;
}

}  // namespace

Result<ControlCommand> parse_control_command(std::string_view line) {
  line = trimmed(line);
  if (line.size() > kMaxControlLine) return fail(fmt::format("a command has at most {} bytes", kMaxControlLine));
  const std::vector<std::string_view> words = words_of(line);
  if (words.empty()) return fail("an empty command", "ask `help`");
  const std::string_view verb = words.front();
  if (verb == "fault") {
    if (words.size() != 2) return fail("fault takes one fault without spaces", "e.g. fault delay:s=0.05@0..3");
    auto spec = parse_fault(words[1]);
    if (!spec) return std::unexpected(spec.error());
    return AddFault{std::move(*spec)};
  }
  if (verb == "clear") return clear(words);
  if (verb == "emcy") return emergency(words);
  if (verb == "die") return die(words);
  const bool known = std::find(kVerbs.begin(), kVerbs.end(), verb) != kVerbs.end();
  if (!known) {
    const std::string guess = did_you_mean(verb, kVerbs);
    return fail(fmt::format("there is no command '{}'", printable(verb)), guess.empty() ? "ask `help`" : guess);
  }
  if (words.size() > 1) return fail(fmt::format("{} takes no more parameters", verb));
  if (verb == "return") return EndFaults{0, FaultKind::death};
  if (verb == "hold") return SetHeld{true};
  if (verb == "go") return SetHeld{false};
  if (verb == "status") return AskStatus{};
  if (verb == "help") return AskHelp{};
  return Quit{};
}

std::string control_help() {
  return "  fault FAULT                          injects a fault; its window counts from now\n  clear [ID|KIND|all]    "
         "              ends faults\n  die [robot=N] [joint=N]              the device goes silent\n  return           "
         "                    dead devices reboot\n  emcy CODE [register=R] [robot=N] [joint=N]   an emergency message "
         "(CAN); code 0 is the reset\n  hold | go                            stops | continues the motion\n  status    "
         "                           counters as one line of JSON\n  help | quit\n";
}

}  // namespace cellmirror::sim
