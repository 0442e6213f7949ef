// cellmirror ik: joint values for poses of the tip, and how well and how fast they are found.
#include <fmt/format.h>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/console/progress_line.hpp"
#include "app/kinematics/ik_report.hpp"
#include "app/kinematics/ik_run.hpp"
#include "app/kinematics/robot_choice.hpp"
#include "app/kinematics/targets.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "config/target_file.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/text.hpp"
#include "scripts/lang/command_table.hpp"

namespace cellmirror::app {

namespace {

using inverse_kinematics::Method;

struct IkOptions {
  RobotChoice robot;
  std::string targets;
  std::optional<std::size_t> samples;
  std::uint64_t seed = 1;
  std::string method = "auto";
  std::string class_name;
  double timeout_ms = 5.0;
  double tolerance = 1e-5;
  std::string start;
  bool all = false;
  std::string plot;
  bool json = false;
};

constexpr double kLongestTimeout = 60'000;  // ms
constexpr double kWidestTolerance = 0.1;    // m, rad
constexpr std::size_t kMaxAlternatives = 64;
constexpr std::size_t kMaxTargetsForAll = 100'000;  // with all their solutions they have to be kept

std::span<const script::Choice> classes() {
  return script::forms_of("rob_inverse_class").front()->parameters[0].choices;
}

std::optional<InverseClass> class_of(const std::string& name) {
  for (std::size_t i = 0; i < classes().size(); ++i) {
    if (equal_ignoring_case(name, classes()[i].word)) return static_cast<InverseClass>(i);
  }
  return std::nullopt;
}

// A number above zero up to `most`; a range of the command line takes nan.
void above_zero(cli::Option option, double most) {
  const auto wrong = [most](const std::string& text) {
    const auto value = parse_number(text);
    if (value && *value > 0.0 && *value <= most) return std::string{};
    return fmt::format("{} is no number above 0 up to {:g}", printable(text), most);
  };
  option.check(wrong, fmt::format("(0..{:g}]", most));
}

std::string wrong_count(const std::string& text) {
  const auto value = parse_integer(text);
  if (value && *value >= 1 && *value <= static_cast<long long>(kMaxTargets)) return {};
  return fmt::format("{} is no count from 1 to {}", printable(text), kMaxTargets);
}

std::string wrong_class(const std::string& text) {
  if (class_of(text)) return {};
  std::vector<std::string> names;
  for (const script::Choice& choice : classes()) names.emplace_back(choice.word);
  std::string hint = did_you_mean(text, names);
  if (hint.empty()) hint = "cellmirror commands rob_inverse_class lists them";
  return fmt::format("there is no class {}; {}", printable(text), hint);
}

// What the options have to do with each other; empty: all is well.
std::string wrong_usage(const IkOptions& options) {
  if (std::string wrong = misuse(options.robot); !wrong.empty()) return wrong;
  if (options.samples || !options.targets.empty()) return {};
  return "there are no targets; name a file (--targets F.csv) or a count (--samples N)";
}

Method method_of(const std::string& name) {
  if (name == "fast") return Method::fast;
  return name == "ipopt" ? Method::ipopt : Method::automatic;
}

std::optional<std::vector<Pose>> targets_of(const IkOptions& options, const kinematics::Chain& chain,
                                            Diagnostics& diagnostics) {
  if (options.samples) return reachable_targets(chain, *options.samples, options.seed);
  const auto text = read_text_file(options.targets, kLargestTargetFile);
  if (text) return parse_targets(*text, options.targets, diagnostics);
  diagnostics.error({options.targets}, text.error().what, text.error().remedy);
  return std::nullopt;
}

Result<IkSettings> settings_of(const IkOptions& options, const kinematics::Chain& chain, InverseClass inverse_class) {
  IkSettings out;
  out.method = method_of(options.method);
  out.task = kinematics::task_of(inverse_class, chain);
  out.tolerance = options.tolerance;
  // At least one microsecond: less would be no time at all.
  out.time_limit = std::chrono::microseconds(std::max(1L, std::lround(1e3 * options.timeout_ms)));
  out.max_solutions = options.all ? kMaxAlternatives : 1;
  out.start = chain.middle();
  if (options.start.empty()) return out;
  const auto start = parse_joints(options.start, "--seed-joints", chain);
  if (!start) return std::unexpected(start.error());
  if (const std::string beyond = beyond_limits(chain, *start); !beyond.empty())
    std::fprintf(stderr, "cellmirror: --seed-joints: %s; the search starts at the limit\n", beyond.c_str());
  std::copy(start->begin(), start->end(), out.start.begin());
  return out;
}

Result<IkRun> run_with_progress(const kinematics::Chain& chain, const IkSettings& settings,
                                std::span<const Pose> targets) {
  ProgressLine line("targets");
  return run_ik(chain, settings, targets, SystemClock(), [&](std::size_t done) { line.update(done, targets.size()); });
}

// Prints what was found, and gives the exit status: one target that is not reached is a failure, of many it is a
// figure.
int print(const IkOptions& options, const IkReport& report) {
  if (options.json) {
    print_json(report, stdout);
  } else {
    std::fputs(table(report).c_str(), stdout);
  }
  if (std::fflush(stdout) != 0)
    return refuse("standard output cannot be written: " + std::string(std::strerror(errno)));
  if (!options.plot.empty()) {
    if (const auto drawn = plot::write_png(figure(report), options.plot); !drawn) return refuse(drawn.error().text());
  }
  if (report.run.false_claims > 0)
    return refuse(fmt::format("{} solutions failed the check by forward kinematics; this is a bug, please report it",
                              report.run.false_claims));
  if (report.statistics.samples == 1 && report.statistics.solved == 0) return refuse(not_reached(report, 0));
  return kExitDone;
}

int solve(const IkOptions& options) {
  Diagnostics diagnostics;
  const auto robot = choose_robot(options.robot, diagnostics);
  const auto targets = robot ? targets_of(options, robot->chain, diagnostics) : std::nullopt;
  if (!robot || !targets) {
    std::fputs(diagnostics.text(Severity::warning).c_str(), stderr);
    return kExitRefused;
  }
  if (options.all && targets->size() > kMaxTargetsForAll)
    return refuse(fmt::format("--all keeps every solution of {} targets at most; there are {}", kMaxTargetsForAll,
                              targets->size()));
  const InverseClass inverse_class =
      options.class_name.empty() ? robot->inverse_class : class_of(options.class_name).value_or(robot->inverse_class);
  const auto settings = settings_of(options, robot->chain, inverse_class);
  if (!settings) return refuse(settings.error().text());
  const auto run = run_with_progress(robot->chain, *settings, *targets);
  if (!run) return refuse(run.error().text());
  const std::string word(classes()[static_cast<std::size_t>(inverse_class)].word);
  return print(options, {*robot, *settings, word, *run, statistics_of(*run)});
}

}  // namespace

void add_ik(cli::Command program, Action& action) {
  auto options = std::make_shared<IkOptions>();
  cli::Command sub = program.subcommand("ik", "Find joint values for poses of the tip (inverse kinematics)");
  add_robot_options(sub, options->robot);
  auto targets = sub.option("--targets", options->targets,
                            "CSV of targets: header px,py,pz,qx,qy,qz,qw; tip in base, m, unit quaternion");
  auto samples = sub.option("--samples", options->samples, "draw so many reachable targets at random")
                     .check(wrong_count, fmt::format("1..{}", kMaxTargets))
                     .excludes(targets);
  sub.option("--seed", options->seed, "seed of the random targets").show_default().needs(samples);
  above_zero(sub.option("--timeout-ms", options->timeout_ms, "time limit per target").show_default(), kLongestTimeout);
  above_zero(sub.option("--tol", options->tolerance, "bound of each component of the error: m, rad").show_default(),
             kWidestTolerance);
  sub.option("--method", options->method, "auto, ipopt or fast").show_default().one_of({"auto", "ipopt", "fast"});
  sub.option("--class", options->class_name, "what has to be met, as in rob_inverse_class (default: align_FRAME)")
      .check(wrong_class, "CLASS");
  sub.option("--seed-joints", options->start,
             "'q1 q2 ...': where the search starts, rad or m (default: middle of the range)");
  sub.flag("--all", options->all, "several solutions per target");
  sub.option("--plot", options->plot, "draw the distributions of times and errors: a PNG file");
  sub.flag("--json", options->json, "one JSON document (docs/kinematics.md)");
  sub.footer("Example: cellmirror ik --urdf arm.urdf --base base_link --tip tool0 --samples 1000 --plot arm.png");
  sub.when_named([options, &action] { action = [options] { return solve(*options); }; },
                 [options] { return wrong_usage(*options); });
}

}  // namespace cellmirror::app
