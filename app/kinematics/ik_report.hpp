// What `cellmirror ik` tells of a run: as JSON, as a table, as figures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "app/kinematics/ik_run.hpp"
#include "app/kinematics/robot_choice.hpp"
#include "app/plot/figure.hpp"

namespace cellmirror::app {

struct IkStatistics {
  std::size_t samples = 0;
  std::size_t solved = 0;
  std::size_t timed_out = 0;
  double rate = 0;  // solved / samples
  // Of all targets, also those that were not solved. Percentiles by nearest rank.
  double mean_us = 0;
  double median_us = 0;
  double p99_us = 0;
  double max_us = 0;
  std::array<std::size_t, 5> by{};  // solved targets by FoundBy
};

[[nodiscard]] IkStatistics statistics_of(const IkRun& run);

struct IkReport {
  const ChosenRobot& robot;
  const IkSettings& settings;
  std::string class_name;
  const IkRun& run;
  IkStatistics statistics;
};

// The document of docs/kinematics.md, a target at a time, so that a million of them need no memory of their own.
void print_json(const IkReport& report, std::FILE* out);
[[nodiscard]] std::string table(const IkReport& report);
[[nodiscard]] plot::Figure figure(const IkReport& report);

// "target 3 is not reached: the nearest pose is 0.12 m and 0 rad away, at joints ..."
[[nodiscard]] std::string not_reached(const IkReport& report, std::size_t target);

}  // namespace cellmirror::app
