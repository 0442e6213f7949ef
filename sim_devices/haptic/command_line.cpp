#include "sim_devices/haptic/command_line.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "config/command_line/command_line.hpp"
#include "rt_core/base/text.hpp"
#include "sim_devices/base/text_items.hpp"

namespace cellmirror::sim {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  sim_haptic --key 0x434F0001 --motion 'touch z -0.03; press 2s; drag x 0.02; letgo'\n"
    "  sim_haptic --key 0x434F0001 --axes 5 --motion 'touch insertion 0.1; press 1s; back' --repeat --for 60 --json\n"
    "  sim_haptic --key 0x434F0001 --fault jump:by=0.05@3..3.1 --for 5 --log pose.csv\n"
    "  sim_haptic --key 0x434F0001 --watch --for 10 --log force.csv\n"
    "  sim_haptic --motions       all motions\n"
    "  sim_haptic --faults        all faults\n";

constexpr std::size_t kMaxFaults = 32;

struct Texts {
  std::string key;
  std::string motion;
  std::string start;
  std::string for_s;
  std::vector<std::string> faults;
  bool show_motions = false;
  bool show_faults = false;
};

void add_hand(cli::Command& app, HandParameters& hand) {
  app.option("--mass", hand.held.mass, "kg, of hand and handle").between(0.01, 100.0).show_default();
  app.option("--damping", hand.held.damping, "Ns/m, of the hand").between(0.0, 1000.0).show_default();
  app.option("--stiffness", hand.held.stiffness, "N/m, of the hand").between(0.0, 1e5).show_default();
  app.option("--device-mass", hand.released.mass, "kg, of the handle alone").between(0.01, 100.0).show_default();
  app.option("--device-damping", hand.released.damping, "Ns/m, of the handle alone")
      .between(0.0, 1000.0)
      .show_default();
  app.option("--arm", hand.arm, "m, from the trocar to the hand (4 and 5 axes)").between(0.01, 2.0).show_default();
  app.option("--tremor", hand.tremor, "m, amplitude").between(0.0, 0.01).show_default();
  app.option("--seed", hand.seed, "of the tremor").show_default();
}

void add_options(cli::Command& app, HapticOptions& options, Texts& texts) {
  app.option("--key", texts.key, "of the shared memory, as in the cell file: decimal, or hexadecimal with 0x");
  app.option("--axes", options.axes_given, "4: yaw pitch insertion roll, 5: and jaw, 6: pose, 7: and gripper")
      .between(4, 7)
      .show_default();
  app.option("--rate", options.rate_hz, "samples per second").between(1.0, 10000.0).show_default();
  app.option("--motion", texts.motion, "'touch z -0.03; press 2s; drag x 0.02; letgo'; see --motions");
  app.flag("--repeat", options.repeat, "repeat the motion");
  app.option("--start", texts.start, "start position of the axes, e.g. 0,0,0.12,0 in m and rad");
  app.option("--resolution", options.length_resolution, "m, of the encoders; 0: exact")
      .between(0.0, 0.01)
      .show_default();
  app.option("--angle-resolution", options.angle_resolution, "rad, of the encoders; 0: exact")
      .between(0.0, 0.1)
      .show_default();
  add_hand(app, options.hand);
  app.option("--fault", texts.faults, "KIND[:key=value][@START[..END]], may be repeated; see --faults")
      .one_value_each();
  app.option("--for", texts.for_s, "end after this many seconds; 0: run until a signal (default: to the motion's end)");
  app.option("--wait", options.wait_s, "time limit for the memory to appear, s; 0: none")
      .between(0.0, 1e6)
      .show_default();
  app.option("--poll", options.poll_us, "poll interval for the answer, us; 0: once per period")
      .between(0.0, 1e6)
      .show_default();
  app.option("--priority", options.priority, "SCHED_FIFO priority, where allowed").between(0, 98);
  app.flag("--watch", options.watch, "write nothing: record the gateway's answers (see --log)");
  app.option("--log", options.log, "a CSV file of every period");
  app.option("--control", options.control, "a FIFO to read commands from: motion MOTION, fault FAULT, clear, quit");
  app.flag("--no-input", options.no_input, "read no commands from standard input (it never does)");
  app.flag("--json", options.json, "print the summary as JSON on standard output at the end");
  app.flag("-q,--quiet", options.quiet, "only errors");
  app.flag("--motions", texts.show_motions, "print all motions");
  app.flag("--faults", texts.show_faults, "print all faults");
}

void read_start(const std::string& text, HapticOptions& options, std::string& problems) {
  if (text.empty()) return;
  const auto parts = split(text, ',', kMaxHapticAxes + 1);
  bool good = parts.size() <= options.axes;
  for (std::size_t i = 0; good && i < parts.size(); ++i) {
    const auto value = parse_number(parts[i]);
    good = value && *value >= -10 && *value <= 10;
    if (good) options.start[i] = *value;
  }
  if (!good) {
    problems += fmt::format("sim_haptic: --start '{}': at most {} numbers from -10 to 10, separated by commas\n",
                            printable(text), options.axes);
  }
}

void read_key(const Texts& texts, HapticOptions& options, std::string& problems) {
  const auto key = parse_integer(texts.key);
  if (!key || *key < 1 || *key > 0xffffffffLL) {
    problems += texts.key.empty() ? "sim_haptic: --key is needed: shm_key of [[haptic]] in the cell file\n"
                                  : fmt::format("sim_haptic: --key '{}' is not a key\n", printable(texts.key));
    return;
  }
  options.key = static_cast<std::int32_t>(static_cast<std::uint32_t>(*key));
}

std::string read_texts(const Texts& texts, HapticOptions& options) {
  std::string problems;
  read_key(texts, options, problems);
  read_start(texts.start, options, problems);
  Diagnostics diagnostics;
  options.motion = parse_motion(texts.motion, "--motion", AxisLayout(options.axes), diagnostics);
  if (!diagnostics.ok()) problems += diagnostics.text();
  if (texts.faults.size() > kMaxFaults) problems += fmt::format("sim_haptic: more than {} faults\n", kMaxFaults);
  for (const std::string& text : texts.faults) {
    auto fault = parse_haptic_fault(text);
    if (!fault) {
      problems += fmt::format("sim_haptic: {}\n", fault.error().text());
    } else {
      options.faults.push_back(std::move(*fault));
    }
  }
  if (!texts.for_s.empty()) {
    const auto seconds = parse_number(texts.for_s);
    if (!seconds || *seconds < 0 || *seconds > 1e9) {
      problems += fmt::format("sim_haptic: --for '{}' is not a number of seconds\n", printable(texts.for_s));
    }
    options.for_s = seconds.value_or(0);
  }
  return problems;
}

}  // namespace

ParsedHaptic parse_haptic_command_line(int argc, const char* const* argv) {
  HapticOptions options;
  Texts texts;
  cli::CommandLine app("sim_haptic simulates a haptic device and the hand that holds it, with faults on demand.",
                       "sim_haptic");
  app.footer(kFooter);
  add_options(app, options, texts);
  if (const auto exit_code = app.parse(argc, argv)) return {exit_code, {}};
  options.axes = static_cast<std::size_t>(options.axes_given);
  if (texts.show_motions || texts.show_faults) {
    fmt::print("{}", texts.show_motions ? haptic_motion_help() : haptic_fault_help());
    return {0, {}};
  }
  if (const std::string problems = read_texts(texts, options); !problems.empty()) {
    fmt::print(stderr, "{}", problems);
    return {cli::kExitWrongUsage, {}};
  }
  return {std::nullopt, std::move(options)};
}

}  // namespace cellmirror::sim
