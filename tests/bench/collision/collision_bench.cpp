// The figures of collision tests, each beside its goal and its yardstick in the same run:
//   collision_bench [FRAMES]    frames of 1 ms of the transfer cell, 3000 where nothing is said
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/collision/checker.hpp"
#include "rt_core/collision/second_opinion.hpp"
#include "tests/bench/collision/fcl_naive.hpp"
#include "tests/stress/collision/moving_cell.hpp"

using namespace cellmirror;
using namespace cellmirror::collision;

namespace {

// The time that this thread had a processor: what a frame costs, whatever else the machine does.
struct Stopwatch {
  static double now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
  }
};

double micros(double from) { return Stopwatch::now() - from; }

double percentile(std::vector<double> values, double percent) {
  if (values.empty()) return 0;
  const auto place =
      std::min(values.size() - 1, static_cast<std::size_t>(percent / 100.0 * static_cast<double>(values.size())));
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(place));
  return values[place];
}

double resident_mb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    if (word != "VmRSS:") continue;
    double kb = 0;
    status >> kb;
    return kb / 1024.0;
  }
  return 0;
}

struct Prepared {
  std::shared_ptr<const PairTable> table;
  Checker checker;
};

void prepare(const MovingCell& cell, const Settings& settings, Prepared& out) {
  const double before = resident_mb();
  const double from = Stopwatch::now();
  PairDerivation derivation(std::make_shared<geometry::SolidLibrary>());
  out.table = derivation.derive(*cell.compiled(), settings);
  const double first = micros(from) / 1e3;
  const double again = Stopwatch::now();
  (void)derivation.derive(*cell.compiled(), settings);
  fmt::print("  {} triangles, {} bodies; trees and pairs derived in {:.0f} ms (again: {:.1f} ms), {:.1f} MB\n",
             out.table->triangles, out.table->bodies.size(), first, micros(again) / 1e3, resident_mb() - before);
  out.checker.adopt(cell.compiled(), out.table, settings);
}

struct Times {
  std::vector<double> ours;  // us a frame
  std::vector<double> naive;
};

// Our findings beside FCL's. A body within a closed mesh touches it; to FCL, whose meshes are surfaces, it is apart.
struct Comparison {
  std::size_t frames = 0;
  std::size_t nested = 0;
  std::size_t differ = 0;
  std::size_t distances = 0;
  double largest = 0;

  void take(const ProximityState& ours, const FclNaive::Answer& fcl, const PairTable& table, const CellPoses& poses) {
    ++frames;
    std::set<std::pair<std::size_t, std::size_t>> touching;
    for (const TouchingPair& pair : ours.touching) {
      touching.insert({pair.a, pair.b});
      if (fcl.touching.contains({pair.a, pair.b})) continue;
      const Body& a = table.bodies[pair.a];
      const Body& b = table.bodies[pair.b];
      const auto pose = [&](const Body& body) { return poses.X_WN[static_cast<std::size_t>(body.node)]; };
      const bool explained = opinion.ask(a, pose(a), b, pose(b), {true, 0.0, pair.depth_m}) == Opinion::agrees;
      ++(explained ? nested : differ);
    }
    for (const auto& pair : fcl.touching) differ += touching.contains(pair) ? 0U : 1U;
    double least = 1e300;
    for (const auto& [pair, distance] : fcl.apart) {
      if (!touching.contains(pair)) least = std::min(least, distance);
    }
    const auto apart = std::ranges::find_if(ours.near, [](const NearPair& near) { return near.distance_m > 0; });
    if (apart == ours.near.end()) return;  // what is not within the warning distance is not told beside a touch
    ++distances;
    largest = std::max(largest, std::abs(least - apart->distance_m));
  }

  SecondOpinion opinion;
};

// `every`: of how many frames one is given to FCL as well.
Times run_frames(MovingCell& cell, Prepared& prepared, int frames, int every) {
  prepared.checker.limit_contacts(1, 16);  // as the gateway does
  Times times;
  FclNaive naive(prepared.table);
  Comparison comparison;
  std::size_t touching = 0;
  const double warning = Settings().warning_distance_m;
  for (int i = 0; i < frames; ++i) {
    const CellPoses& poses = cell.at(0.001 * i);
    const double from = Stopwatch::now();
    const ProximityState& found = prepared.checker.check(poses, Timestamp{i + 1});
    times.ours.push_back(micros(from));
    if (!found.touching.empty()) ++touching;
    if (i % every != 0) continue;
    const double fcl_from = Stopwatch::now();
    const auto& answer = naive.check(poses, warning);
    times.naive.push_back(micros(fcl_from));
    comparison.take(found, answer, *prepared.table, poses);
  }
  const auto& counters = prepared.checker.counters();
  fmt::print(
      "  {} frames, in {} something touches; {:.1f} queries a frame of {} pairs; second opinions {}, disagreements {}, "
      "doubts {}\n",
      frames, touching, static_cast<double>(counters.pairs_computed) / frames,
      std::ranges::count_if(prepared.table->pairs, [](const Pair& pair) { return is_tested(pair.state); }),
      counters.second_opinions, counters.disagreements, counters.doubts);
  fmt::print(
      "  FCL on {} of the frames: {} touching pairs differ ({} more lie within each other, which FCL cannot see); "
      "smallest "
      "distances of the others ({} frames) differ by at most {:.2g} m\n",
      comparison.frames, comparison.differ, comparison.nested, comparison.distances, comparison.largest);
  return times;
}

double report(const Times& times) {
  const double median = percentile(times.ours, 50);
  const double naive = percentile(times.naive, 50);
  fmt::print("  ours: median {:.0f} us, p99 {:.0f} us, largest {:.0f} us\n", median, percentile(times.ours, 99),
             *std::ranges::max_element(times.ours));
  fmt::print("  FCL's dynamic tree manager asked anew: median {:.0f} us, p99 {:.0f} us; ratio of medians {:.1f}\n",
             naive, percentile(times.naive, 99), naive / median);
  return median;
}

// Frames that have nothing to do with each other.
void run_jumps(MovingCell& cell, Prepared& prepared, int frames) {
  std::vector<double> times;
  for (int i = 0; i < frames; ++i) {
    const CellPoses& poses = cell.anywhere(static_cast<std::uint64_t>(i));
    const double from = Stopwatch::now();
    prepared.checker.check(poses, Timestamp{i + 1});
    times.push_back(micros(from));
  }
  fmt::print("  postures at random: median {:.0f} us, p99 {:.0f} us\n", percentile(times, 50), percentile(times, 99));
}

void self_collision(const std::string& id) {
  const SharedRobotCell folder(id);
  if (folder.file().empty()) {
    fmt::print("  {}: skipped: the shared robots are not on this machine\n", id);
    return;
  }
  MovingCell cell(folder.file());
  PairDerivation derivation(std::make_shared<geometry::SolidLibrary>());
  const Settings settings;
  const double from = Stopwatch::now();
  const auto table = derivation.derive(*cell.compiled(), settings);
  const double derived = micros(from) / 1e3;
  Checker checker;
  checker.adopt(cell.compiled(), table, settings);
  CellPoses poses;
  const auto rate = [&](int count, const auto& posture) {
    std::vector<std::vector<JointValues>> q;
    for (int i = 0; i < count; ++i) {
      posture(i);
      q.push_back(cell.positions());
    }
    int touching = 0;
    const double begin = Stopwatch::now();
    for (const auto& positions : q) {
      compute_poses(*cell.compiled(), positions, poses);
      touching += checker.collides(poses) ? 1 : 0;
    }
    const double each = micros(begin) / count;
    return fmt::format("{:.0f} a second ({:.1f} us, {:.0f} % touch)", 1e6 / each, each, 100.0 * touching / count);
  };
  const auto anywhere = rate(4000, [&](int i) { cell.anywhere(static_cast<std::uint64_t>(i)); });
  const auto path = rate(4000, [&](int i) { cell.at(0.01 * i); });
  fmt::print(
      "  {}: {} triangles, pairs derived in {:.0f} ms\n    at random {}\n    along a path, a posture each 10 ms, {}\n",
      id, table->triangles, derived, anywhere, path);
}

// The cell as it is, and with 100,000 triangles and more in the same surfaces.
void transfer_cell(int frames, double share) {
  const Settings settings;
  MovingCell cell(transfer_cell_file(), 1, share);
  Prepared coarse;
  prepare(cell, settings, coarse);
  const double median = report(run_frames(cell, coarse, frames, 10));
  run_jumps(cell, coarse, 300);
  const auto n = static_cast<unsigned>(
      std::ceil(std::sqrt(100'000.0 / static_cast<double>(std::max<std::size_t>(1, coarse.table->triangles)))));
  cell.subdivide(std::max(2U, n));
  fmt::print("the same surfaces in {} times as many triangles (goal: under twice the time)\n", n * n);
  Prepared fine;
  prepare(cell, settings, fine);
  const double fine_median = report(run_frames(cell, fine, frames, 50));
  fmt::print("  median against the coarse cell: {:.2f}\n", fine_median / median);
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 3000;
  fmt::print("times are those of the processor; steps of 1 ms\n");
  fmt::print(
      "transfer cell, all robots in the middle 40 % of their ranges (goal: median under 1000 us, p99 under 2000 us, "
      "ratio at least 10)\n");
  transfer_cell(frames, 0.4);
  fmt::print("transfer cell, all robots in their whole ranges, arms folding into themselves and the floor\n");
  transfer_cell(frames, 1.0);
  fmt::print("self-collision with real meshes, forward kinematics included (goal: 20,000 a second)\n");
  for (const char* id : {"tx90", "ur5e", "lrmate200id", "irb120", "kr6r900sixx"}) self_collision(id);
  return 0;
}
