#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/kinematics/ik_report.hpp"
#include "rt_core/base/counted.hpp"

namespace cellmirror::app {

namespace {

using plot::Panel;

// An error of exactly zero has no place on a logarithmic axis; it is shown at the end of what doubles resolve.
constexpr double kLeastError = 1e-17;

// Whole decades around all times and the limit: both panels of times have the same axis.
plot::Axis time_axis(const IkReport& report) {
  const double limit_us = static_cast<double>(report.settings.time_limit.count());
  double low = limit_us;
  for (const IkOutcome& outcome : report.run.outcomes) low = std::min(low, std::max(outcome.time_us, 1e-3));
  const double high = std::max(report.statistics.max_us, limit_us);
  return {"time [µs]", true, std::pow(10.0, std::floor(std::log10(low))),
          std::pow(10.0, std::ceil(std::log10(1.1 * high)))};
}

Panel times_panel(const IkReport& report) {
  Panel panel{
      .title = "Time a target", .x = time_axis(report), .y = {"targets"}, .histograms = {{}}, .lines = {}, .marks = {}};
  for (const IkOutcome& outcome : report.run.outcomes) panel.histograms[0].values.push_back(outcome.time_us);
  const IkStatistics& s = report.statistics;
  panel.marks = {{s.median_us, fmt::format("median {:.1f} µs", s.median_us)},
                 {s.mean_us, fmt::format("mean {:.1f} µs", s.mean_us)},
                 {s.p99_us, fmt::format("p99 {:.1f} µs", s.p99_us)}};
  return panel;
}

// The share of all targets that is solved within a time, on the same axis.
Panel share_panel(const IkReport& report) {
  Panel panel{.title = "Solved within a time",
              .x = time_axis(report),
              .y = {"share of the targets [%]", false, 0, 112},
              .histograms = {},
              .lines = {{}},
              .marks = {}};
  std::vector<double> times;
  for (const IkOutcome& outcome : report.run.outcomes) {
    if (outcome.solved) times.push_back(outcome.time_us);
  }
  std::sort(times.begin(), times.end());
  const double samples = static_cast<double>(std::max<std::size_t>(report.statistics.samples, 1));
  for (std::size_t i = 0; i < times.size(); ++i) {
    // A step: up at the time, level until the next.
    panel.lines[0].x.insert(panel.lines[0].x.end(), {times[i], times[i]});
    panel.lines[0].y.insert(panel.lines[0].y.end(),
                            {100.0 * static_cast<double>(i) / samples, 100.0 * static_cast<double>(i + 1) / samples});
  }
  const double limit_us = static_cast<double>(report.settings.time_limit.count());
  panel.marks = {{limit_us, fmt::format("limit {:g} ms", 1e-3 * limit_us)}};
  return panel;
}

Panel error_panel(const IkReport& report, const char* title, const char* label, const char* unit,
                  double IkOutcome::* error) {
  Panel panel{
      .title = title, .x = {label, true}, .y = {"solved targets"}, .histograms = {{}}, .lines = {}, .marks = {}};
  for (const IkOutcome& outcome : report.run.outcomes) {
    if (outcome.solved) panel.histograms[0].values.push_back(std::max(outcome.*error, kLeastError));
  }
  const double tolerance = report.settings.tolerance;
  panel.marks = {{tolerance, fmt::format("tolerance {:g} {}", tolerance, unit)}};
  return panel;
}

}  // namespace

plot::Figure figure(const IkReport& report) {
  const IkStatistics& s = report.statistics;
  plot::Figure out;
  out.title = fmt::format("Inverse kinematics of {}: {} → {}", report.robot.name, report.robot.base, report.robot.tip);
  out.subtitle = fmt::format("method {}, class {}, {}, {} solved ({:.6g} %), tolerance {:g}, time limit {:g} ms",
                             name_of(report.settings.method), report.class_name, number_of(s.samples, "target"),
                             s.solved, 100.0 * s.rate, report.settings.tolerance,
                             1e-3 * static_cast<double>(report.settings.time_limit.count()));
  out.panels = {
      times_panel(report), share_panel(report),
      error_panel(report, "Error of the position", "position error [m]", "m", &IkOutcome::position_error_m),
      error_panel(report, "Error of the orientation", "rotation error [rad]", "rad", &IkOutcome::rotation_error_rad)};
  return out;
}

}  // namespace cellmirror::app
