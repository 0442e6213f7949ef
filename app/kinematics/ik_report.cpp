#include "app/kinematics/ik_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "rt_core/base/counted.hpp"

namespace cellmirror::app {

namespace {

using inverse_kinematics::FoundBy;
using nlohmann::json;

constexpr std::size_t kListed = 12;  // targets that the table shows one by one

// Six digits, and rounding errors about zero as zero.
std::string joint_text(double value) { return fmt::format("{:.6g}", std::abs(value) < 1e-12 ? 0.0 : value); }

double nearest_rank(const std::vector<double>& sorted, double fraction) {
  if (sorted.empty()) return 0.0;
  const double rank = std::ceil(fraction * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

std::string joints_text(const IkReport& report, const IkOutcome& outcome) {
  std::string out;
  for (std::size_t i = 0; i < report.robot.chain.variable_count(); ++i)
    out += (i == 0 ? "" : " ") + joint_text(outcome.q[i]);
  return out;
}

std::string found_by(const IkStatistics& statistics) {
  std::string out;
  for (std::size_t i = 1; i < statistics.by.size(); ++i) {
    if (statistics.by[i] == 0) continue;
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", name_of(static_cast<FoundBy>(i)), statistics.by[i]);
  }
  return out;
}

// The document without its list of solutions.
json summary(const IkReport& report) {
  const IkStatistics& s = report.statistics;
  json names = json::array();
  for (const kinematics::Variable& variable : report.robot.chain.variables()) names.push_back(variable.name);
  json by = json::object();
  for (std::size_t i = 1; i < s.by.size(); ++i) by[std::string(name_of(static_cast<FoundBy>(i)))] = s.by[i];
  return {{"method", name_of(report.settings.method)},
          {"robot", report.robot.name},
          {"base", report.robot.base},
          {"tip", report.robot.tip},
          {"joint_names", std::move(names)},
          {"class", report.class_name},
          {"tolerance", report.settings.tolerance},
          {"time_limit_ms", 1e-3 * static_cast<double>(report.settings.time_limit.count())},
          {"setup_ms", report.run.setup_ms},
          {"samples", s.samples},
          {"solved", s.solved},
          {"rate", s.rate},
          {"timed_out", s.timed_out},
          {"mean_us", s.mean_us},
          {"median_us", s.median_us},
          {"p99_us", s.p99_us},
          {"max_us", s.max_us},
          {"found_by", std::move(by)}};
}

json solution(const IkReport& report, const IkOutcome& outcome) {
  const std::size_t joints = report.robot.chain.variable_count();
  json out = {{"solved", outcome.solved},
              {"joints", std::vector<double>(outcome.q.begin(), outcome.q.begin() + static_cast<long>(joints))},
              {"position_error_m", outcome.position_error_m},
              {"rotation_error_rad", outcome.rotation_error_rad},
              {"time_us", outcome.time_us},
              {"by", name_of(outcome.by)}};
  if (report.settings.max_solutions == 1) return out;
  json alternatives = json::array();
  for (std::size_t at = 0; at + joints <= outcome.alternatives.size(); at += joints)
    alternatives.push_back(std::vector<double>(outcome.alternatives.begin() + static_cast<long>(at),
                                               outcome.alternatives.begin() + static_cast<long>(at + joints)));
  out["alternatives"] = std::move(alternatives);
  return out;
}

std::string text_of(const json& document) {
  return document.dump(-1, ' ', false, json::error_handler_t::replace);  // names may hold any bytes
}

}  // namespace

IkStatistics statistics_of(const IkRun& run) {
  IkStatistics out;
  out.samples = run.outcomes.size();
  std::vector<double> times;
  times.reserve(run.outcomes.size());
  double sum = 0;
  for (const IkOutcome& outcome : run.outcomes) {
    times.push_back(outcome.time_us);
    sum += outcome.time_us;
    if (outcome.timed_out) ++out.timed_out;
    if (!outcome.solved) continue;
    ++out.solved;
    ++out.by.at(static_cast<std::size_t>(outcome.by));
  }
  if (times.empty()) return out;
  std::sort(times.begin(), times.end());
  out.rate = static_cast<double>(out.solved) / static_cast<double>(out.samples);
  out.mean_us = sum / static_cast<double>(times.size());
  out.median_us = nearest_rank(times, 0.5);
  out.p99_us = nearest_rank(times, 0.99);
  out.max_us = times.back();
  return out;
}

void print_json(const IkReport& report, std::FILE* out) {
  std::string head = text_of(summary(report));
  head.pop_back();  // its brace: the solutions follow
  std::fputs(head.c_str(), out);
  std::fputs(",\"solutions\":[", out);
  const char* separator = "";
  for (const IkOutcome& outcome : report.run.outcomes) {
    std::fputs(separator, out);
    std::fputs(text_of(solution(report, outcome)).c_str(), out);
    separator = ",";
  }
  std::fputs("]}\n", out);
}

std::string table(const IkReport& report) {
  const IkStatistics& s = report.statistics;
  std::string out = fmt::format(
      "{}: {} -> {}, {}, class {}\nmethod {}, tolerance {:g}, time limit {:g} ms; set up in {:.1f} ms\n\n",
      report.robot.name, report.robot.base, report.robot.tip, number_of(report.robot.chain.variable_count(), "joint"),
      report.class_name, name_of(report.settings.method), report.settings.tolerance,
      1e-3 * static_cast<double>(report.settings.time_limit.count()), report.run.setup_ms);
  if (s.samples <= kListed) {
    out += fmt::format("{:>6} {:<8} {:<12} {:>10} {:>12} {:>12}  joints [rad, m]\n", "target", "solved", "by",
                       "time us", "error m", "error rad");
    for (std::size_t i = 0; i < s.samples; ++i) {
      const IkOutcome& outcome = report.run.outcomes[i];
      out += fmt::format("{:>6} {:<8} {:<12} {:>10.1f} {:>12.2e} {:>12.2e}  {}\n", i + 1, outcome.solved ? "yes" : "no",
                         name_of(outcome.by), outcome.time_us, outcome.position_error_m, outcome.rotation_error_rad,
                         joints_text(report, outcome));
      for (std::size_t at = 0; at < outcome.alternatives.size(); at += report.robot.chain.variable_count()) {
        out += fmt::format("{:>6} {:<60}", "", "or");
        for (std::size_t j = 0; j < report.robot.chain.variable_count(); ++j)
          out += " " + joint_text(outcome.alternatives[at + j]);
        out += '\n';
      }
    }
    out += '\n';
  }
  out += fmt::format("solved  {} of {} ({:.6g} %)", s.solved, s.samples, 100.0 * s.rate);
  if (s.solved > 0) out += "; " + found_by(s);
  if (s.timed_out > 0) out += fmt::format("; {} stopped by the time limit", s.timed_out);
  out += fmt::format("\ntime    mean {:.1f}, median {:.1f}, p99 {:.1f}, max {:.1f} us\n", s.mean_us, s.median_us,
                     s.p99_us, s.max_us);
  return out;
}

std::string not_reached(const IkReport& report, std::size_t target) {
  const IkOutcome& outcome = report.run.outcomes.at(target);
  const std::size_t joints = report.robot.chain.variable_count();
  std::string out = fmt::format(
      "target {} is not reached within {:g}{}: the nearest pose found is {:.6g} m and {:.6g} rad away, at "
      "the joints {}",
      target + 1, report.settings.tolerance, outcome.timed_out ? " in the time given" : "", outcome.position_error_m,
      outcome.rotation_error_rad, joints_text(report, outcome));
  constexpr std::size_t kJointsForEveryPose = 6;
  const kinematics::Task& task = report.settings.task;
  const bool whole = task.position_axes == 0b111 && task.orientation == kinematics::OrientationTask::full;
  if (joints < kJointsForEveryPose && whole && task.orientation_required)
    out += fmt::format(
        "; with {} joints not every position and orientation can be met together: --class names what is to be", joints);
  return out;
}

}  // namespace cellmirror::app
