// Readings of 64 sensors over 100,000 triangles, against fans of Embree's rays on the same postures. The exact reading
// is what a fan's error and missed echoes are counted against. The table at the end is of the least times of this run:
//   ranging_bench --benchmark_repetitions=3
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "rt_core/ranging/cone.hpp"
#include "rt_core/ranging/range_finder.hpp"
#include "tests/bench/ranging/bench_cell.hpp"
#ifdef CELLMIRROR_HAVE_EMBREE
#include "tests/unit/ranging_reference/ray_fan.hpp"
#endif

namespace cellmirror {
namespace {

constexpr std::array<std::size_t, 5> kFans{8, 64, 512, 4096, 32768};
constexpr std::size_t kFar = 397;  // ticks between postures that have nothing to do with each other

struct Bench {
  std::shared_ptr<const CompiledCell> cell = bench_cell();
  ranging::RangeFinder finder{std::make_shared<geometry::SolidLibrary>()};
  CellPoses poses;

  Bench() { finder.adopt(cell); }
  std::span<const RangeReading> read(std::size_t tick) {
    compute_poses(*cell, bench_posture(tick), poses);
    return finder.read(poses, Timestamp{1}, ranging::Selection::active_sensors);
  }
};

void all_sensors(benchmark::State& state, Bench& bench, std::size_t step) {
  std::size_t tick = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(bench.read(tick).data());
    tick += step;
  }
  state.counters["readings/s"] =
      benchmark::Counter(kBenchSensors, benchmark::Counter::kIsIterationInvariantRate, benchmark::Counter::kIs1000);
}

// One cone anywhere around a mesh of 103,000 triangles, looking roughly at it.
void one_cone(benchmark::State& state, double half_angle) {
  const geometry::Solid solid = geometry::make_mesh_solid(bench_rock());
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<Pose> X_SG;
  for (int i = 0; i < 1024; ++i) {
    const Eigen::Vector3d direction(any(random), any(random), any(random));
    Pose X_GS = pose_from_xyz_rpy(Eigen::Vector3d::Zero(), std::numbers::pi * direction);
    X_GS.translation() =
        X_GS.linear() * Eigen::Vector3d(0.5 * any(random), 0.5 * any(random), -2.0 + 0.7 * any(random));
    X_SG.push_back(X_GS.inverse());
  }
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(nearest_in_cone(solid, X_SG[i++ % X_SG.size()], ranging::Cone{half_angle}, 3.0));
  }
}

#ifdef CELLMIRROR_HAVE_EMBREE
struct Fans {
  RayFan rays;
  explicit Fans(const Bench& bench) {
    for (const CompiledGeometry& part : bench.cell->geometry) rays.add(part.geometry->mesh);
    for (std::size_t i = 0; i < bench.cell->geometry.size(); ++i) {
      const auto node = static_cast<std::size_t>(bench.cell->geometry[i].node);
      if (node < bench.cell->fixed_count) rays.place(i, bench.cell->X_WN_fixed[node]);
    }
  }
  void move(const Bench& bench, const CellPoses& poses) {
    for (std::size_t i = 0; i < bench.cell->geometry.size(); ++i) {
      const auto node = static_cast<std::size_t>(bench.cell->geometry[i].node);
      if (node >= bench.cell->fixed_count) rays.place(i, poses.X_WN[node]);
    }
    rays.commit();
  }
  [[nodiscard]] std::optional<double> read(const CompiledSensor& sensor, const CellPoses& poses, std::size_t count) {
    return rays.nearest(poses.X_WN[static_cast<std::size_t>(sensor.node)], sensor.sensor.half_angle_rad,
                        sensor.sensor.range_m, count);
  }
};

void fan(benchmark::State& state, Bench& bench, Fans& fans, std::size_t count) {
  std::size_t tick = 0;
  for (auto _ : state) {
    compute_poses(*bench.cell, bench_posture(tick++), bench.poses);
    fans.move(bench, bench.poses);
    for (const CompiledSensor& sensor : bench.cell->sensors) {
      benchmark::DoNotOptimize(fans.read(sensor, bench.poses, count));
    }
  }
}

struct Accuracy {
  double missed = 0;  // part of the echoes
  double median = 0;  // m, of the echoes that were found
  double p99 = 0;
};

Accuracy accuracy(Bench& bench, Fans& fans, std::size_t count) {
  std::vector<double> errors;
  std::size_t echoes = 0;
  for (std::size_t posture = 0; posture < 8; ++posture) {
    const auto readings = bench.read(posture * kFar);
    fans.move(bench, bench.poses);
    for (std::size_t i = 0; i < readings.size(); ++i) {
      if (!readings[i].distance_m) continue;
      ++echoes;
      const auto found = fans.read(bench.cell->sensors[i], bench.poses, count);
      if (found) errors.push_back(*found - *readings[i].distance_m);
    }
  }
  if (errors.empty()) return {1.0, 0.0, 0.0};
  std::ranges::sort(errors);
  const double found = static_cast<double>(errors.size());
  return {1.0 - found / static_cast<double>(echoes), errors[errors.size() / 2],
          errors[static_cast<std::size_t>(0.99 * (found - 1.0))]};
}
#endif

// Keeps the least time of each benchmark.
class LeastTimes : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      const double seconds = run.cpu_accumulated_time / static_cast<double>(run.iterations);
      const auto [at, added] = times_.emplace(run.run_name.function_name, seconds);
      if (!added) at->second = std::min(at->second, seconds);
    }
  }
  [[nodiscard]] double of(const std::string& name) const {
    const auto found = times_.find(name);
    return found == times_.end() ? 0.0 : found->second;
  }

 private:
  std::map<std::string, double> times_;
};

void print_table(const LeastTimes& times, Bench& bench) {
  std::printf("\n%zu sensors, %zu triangles\n", bench.cell->sensors.size(), triangles_of(*bench.cell));
  for (const char* name : {"all_sensors/every_ms", "all_sensors/anywhere"}) {
    const double seconds = times.of(name);
    if (seconds <= 0.0) continue;
    std::printf("%-22s %8.1f us a round, %5.2f us a reading, %6.0f rounds a second\n", name, 1e6 * seconds,
                1e6 * seconds / kBenchSensors, 1.0 / seconds);
  }
}

#ifdef CELLMIRROR_HAVE_EMBREE
void print_fans(const LeastTimes& times, Bench& bench, Fans& fans) {
  const double ours = times.of("all_sensors/every_ms");
  if (ours <= 0.0) return;
  std::printf("%-10s %12s %8s %16s %16s %16s\n", "rays", "us a reading", "by ours", "missed echoes", "median error",
              "p99 error");
  for (const std::size_t count : kFans) {
    const double seconds = times.of("fan/" + std::to_string(count));
    if (seconds <= 0.0) continue;
    const Accuracy found = accuracy(bench, fans, count);
    std::printf("%-10zu %12.2f %7.1fx %14.2f %% %13.3f mm %13.3f mm\n", count, 1e6 * seconds / kBenchSensors,
                seconds / ours, 100.0 * found.missed, 1e3 * found.median, 1e3 * found.p99);
  }
}
#endif

int run(int argc, char** argv) {
  Bench bench;
  for (const double degrees : {7.5, 15.0, 30.0}) {
    benchmark::RegisterBenchmark(("one_cone/" + std::to_string(degrees).substr(0, 4)).c_str(), one_cone,
                                 degrees * std::numbers::pi / 180.0);
  }
  benchmark::RegisterBenchmark("all_sensors/every_ms", all_sensors, std::ref(bench), 1);
  benchmark::RegisterBenchmark("all_sensors/anywhere", all_sensors, std::ref(bench), kFar);
#ifdef CELLMIRROR_HAVE_EMBREE
  Fans fans(bench);
  for (const std::size_t count : kFans) {
    benchmark::RegisterBenchmark(("fan/" + std::to_string(count)).c_str(), fan, std::ref(bench), std::ref(fans), count);
  }
#endif
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  LeastTimes times;
  benchmark::RunSpecifiedBenchmarks(&times);
  print_table(times, bench);
#ifdef CELLMIRROR_HAVE_EMBREE
  print_fans(times, bench, fans);
#else
  std::puts("without Embree there is nothing to compare with");
#endif
  return 0;
}

}  // namespace
}  // namespace cellmirror

int main(int argc, char** argv) { return cellmirror::run(argc, argv); }
