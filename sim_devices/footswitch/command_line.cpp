#include "sim_devices/footswitch/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "config/command_line/command_line.hpp"
#include "rt_core/base/text.hpp"
#include "sim_devices/base/text_items.hpp"
#include "sim_devices/footswitch/switch_bits.hpp"

namespace cellmirror::sim {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  sim_footswitch --key 0x434F0010 --press 1 --for 0.5\n"
    "  sim_footswitch --key 0x434F0010 --press 1,3 --times 5            both at once, five times\n"
    "  sim_footswitch --key 0x434F0010 --hold 2                         until Ctrl-C\n"
    "  sim_footswitch --key 0x434F0010 --sequence '1+ 2+ 500ms 1-,2-' --bounce 4,3ms\n"
    "  sim_footswitch --key 0x434F0010 --random 20 --inputs 8 --for 10 --seed 7 --json\n";

struct Texts {
  std::string key;
  std::vector<std::string> press;
  std::vector<std::string> hold;
  std::string sequence;
  std::string bounce;
  double for_s = -1;
  double press_s = 0.2;
  int times = 1;
  double gap_s = 0.1;
  double random_hz = 0;
  int inputs = 8;
  std::uint64_t seed = 1;
  bool repeat = false;
};

void add_options(cli::Command& app, FootSwitchOptions& options, Texts& texts) {
  app.option("--key", texts.key, "of the shared memory (bin_ela_shm): decimal, or hexadecimal with 0x");
  app.option("--press", texts.press, "presses switch N (1,3: several at once), for --for seconds each")
      .list_divided_by(',');
  app.option("--times", texts.times, "number of presses").between(1, 100000).show_default();
  app.option("--hold", texts.hold, "closes switch N until the end").list_divided_by(',');
  app.option("--sequence", texts.sequence, "N+ closes, N- opens, 1+,2+ at once, waits as 500ms; '1+ 2+ 500ms 1- 2-'");
  app.option("--gap", texts.gap_s, "s, between changes of a sequence, and between presses")
      .between(0.0, 1000.0)
      .show_default();
  app.option("--bounce", texts.bounce, "N,TIME: every change bounces N times within that time, e.g. 4,3ms");
  app.option("--random", texts.random_hz, "random presses per second").between(0.0, 10000.0);
  app.option("--inputs", texts.inputs, "switches that --random presses: 1 to N")
      .between(1, static_cast<int>(kMaxSwitches))
      .show_default();
  app.option("--seed", texts.seed, "of the random numbers").show_default();
  app.option("--for", texts.for_s,
             "s, how long a press lasts (default 0.2), --hold holds (default: until a signal), or the duration of "
             "--random (default 10)")
      .between(0.0, 1e6);
  app.option("--wait", options.wait_s, "time limit for the memory to appear, s; 0: none")
      .between(0.0, 1e6)
      .show_default();
  app.option("--priority", options.priority, "SCHED_FIFO priority, where allowed").between(0, 98);
  app.option("--log", options.log, "a CSV file of every change: time_ns,input,on,bounce");
  app.option("--control", options.control, "a FIFO to read commands from: one sequence per line, or quit");
  app.flag("--no-input", options.no_input, "read no commands from standard input (it never does)");
  app.flag("--json", options.json, "print the summary as JSON on standard output at the end");
  app.flag("-q,--quiet", options.quiet, "only errors");
}

std::vector<std::uint32_t> read_inputs(const std::vector<std::string>& texts, std::string_view option,
                                       std::string& problems) {
  std::vector<std::uint32_t> inputs;
  for (const std::string& text : texts) {
    const auto number = parse_integer(text);
    if (!number || *number < 1 || *number > kMaxSwitches) {
      problems += fmt::format("sim_footswitch: {} {}: switches are 1 to {}\n", option, printable(text), kMaxSwitches);
    } else {
      inputs.push_back(static_cast<std::uint32_t>(*number));
    }
  }
  return inputs;
}

void add_presses(const std::vector<std::uint32_t>& inputs, const Texts& texts, std::vector<SwitchChange>& plan) {
  double at = 0;
  for (int i = 0; i < texts.times && !inputs.empty(); ++i) {
    for (const std::uint32_t input : inputs) plan.push_back({at, input, true, false});
    at += texts.for_s >= 0 ? texts.for_s : texts.press_s;
    for (const std::uint32_t input : inputs) plan.push_back({at, input, false, false});
    at += texts.gap_s;
  }
}

void read_bounce(const Texts& texts, FootSwitchOptions& options, std::string& problems) {
  if (texts.bounce.empty()) return;
  const auto parts = split(texts.bounce, ',', 2);
  const long long count = parse_integer(parts[0]).value_or(0);
  const double within = parts.size() == 2 ? parse_duration(parts[1]).value_or(-1) : -1;
  if (count < 1 || count > 1000 || within < 0 || within > 10) {
    problems += fmt::format("sim_footswitch: --bounce '{}': write N,TIME, e.g. 4,3ms\n", printable(texts.bounce));
    return;
  }
  options.plan = with_bounces(options.plan, static_cast<unsigned>(count), within, texts.seed);
}

std::string read_texts(const Texts& texts, FootSwitchOptions& options) {
  std::string problems;
  const auto key = parse_integer(texts.key);
  if (!key || *key < 1 || *key > 0xffffffffLL) {
    problems += texts.key.empty() ? "sim_footswitch: --key is needed: shm_key of [foot_switches] in the cell file\n"
                                  : fmt::format("sim_footswitch: --key '{}' is not a key\n", printable(texts.key));
  } else {
    options.key = static_cast<std::int32_t>(static_cast<std::uint32_t>(*key));
  }
  add_presses(read_inputs(texts.press, "--press", problems), texts, options.plan);
  options.holds = read_inputs(texts.hold, "--hold", problems);
  for (const std::uint32_t input : options.holds) options.plan.push_back({0, input, true, false});
  Diagnostics diagnostics;
  const auto sequence = parse_switch_sequence(texts.sequence, "--sequence", texts.gap_s, diagnostics);
  if (!diagnostics.ok()) problems += diagnostics.text();
  options.plan.insert(options.plan.end(), sequence.begin(), sequence.end());
  if (texts.random_hz > 0) {
    const auto random = random_presses(texts.random_hz, static_cast<std::uint32_t>(texts.inputs),
                                       texts.for_s >= 0 ? texts.for_s : 10, texts.seed);
    options.plan.insert(options.plan.end(), random.begin(), random.end());
  }
  if (options.plan.empty() && options.control.empty() && problems.empty()) {
    problems = "sim_footswitch: nothing to do; name --press, --hold, --sequence, --random or --control\n";
  }
  sort_by_time(options.plan);
  read_bounce(texts, options, problems);
  const bool until_told = !options.holds.empty() || !options.control.empty();
  options.for_s = texts.for_s >= 0 ? texts.for_s : until_told ? -1 : 0;
  options.gap_s = texts.gap_s;
  for (const SwitchChange& change : options.plan) {
    options.bytes = std::max<std::uint64_t>(options.bytes, bytes_for(change.input));
  }
  return problems;
}

}  // namespace

ParsedFootSwitch parse_foot_switch_command_line(int argc, const char* const* argv) {
  FootSwitchOptions options;
  Texts texts;
  cli::CommandLine app("sim_footswitch simulates a foot that presses switches, with bounces on demand.",
                       "sim_footswitch");
  app.footer(kFooter);
  add_options(app, options, texts);
  if (const auto exit_code = app.parse(argc, argv)) return {exit_code, {}};
  if (const std::string problems = read_texts(texts, options); !problems.empty()) {
    fmt::print(stderr, "{}", problems);
    return {cli::kExitWrongUsage, {}};
  }
  return {std::nullopt, std::move(options)};
}

}  // namespace cellmirror::sim
