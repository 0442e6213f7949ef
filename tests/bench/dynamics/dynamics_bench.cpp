// Inverse dynamics against Orocos KDL and MuJoCo, on the same arms and states. The ratios at the end are of the least
// times of this run:
//   dynamics_bench --benchmark_repetitions=5
// Ours and KDL's are of a posture that was not seen before (sines and cosines included), as are MuJoCo's two: mj_rne
// with the kinematics that it needs, and the whole mj_inverse.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "rt_core/dynamics/inverse_dynamics.hpp"
#include "tests/unit/dynamics/kdl_dynamics.hpp"
#include "tests/unit/dynamics/peer_arms.hpp"
#ifdef CELLMIRROR_HAVE_MUJOCO
#include "tests/unit/dynamics/mujoco_dynamics.hpp"
#endif

namespace cellmirror::dynamics {
namespace {

constexpr std::size_t kStates = 1024;  // a power of two

struct Case {
  explicit Case(PeerArm from) : arm(std::move(from)), kdl(arm.urdf, arm.base, arm.tip) {
    std::mt19937_64 random(1);
    for (std::size_t i = 0; i < kStates; ++i) states.push_back(random_state(arm.joints.size(), random));
#ifdef CELLMIRROR_HAVE_MUJOCO
    const std::vector<Drive> no_drives(arm.joints.size());
    mujoco = std::make_unique<MujocoDynamics>(arm.urdf, arm.joints, no_drives);
#endif
  }
  PeerArm arm;
  KdlDynamics kdl;
#ifdef CELLMIRROR_HAVE_MUJOCO
  std::unique_ptr<MujocoDynamics> mujoco;
#endif
  std::vector<State> states;
};

void ours(benchmark::State& state, Case& of) {
  DynamicsOutput output;
  std::size_t i = 0;
  for (auto _ : state) {
    const State& at = of.states[i++ % kStates];
    inverse_dynamics(*of.arm.ours.mechanism, {at.q, at.qd, at.qdd}, output);
    benchmark::DoNotOptimize(output);
  }
}

void kdl(benchmark::State& state, Case& of) {
  std::size_t i = 0;
  for (auto _ : state) {
    const State& at = of.states[i++ % kStates];
    of.kdl.set(at.q, at.qd, at.qdd);
    of.kdl.compute(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
    benchmark::DoNotOptimize(of.kdl.effort(0));
  }
}

#ifdef CELLMIRROR_HAVE_MUJOCO
void mujoco(benchmark::State& state, Case& of, bool whole) {
  std::size_t i = 0;
  for (auto _ : state) {
    const State& at = of.states[i++ % kStates];
    of.mujoco->set(at.q, at.qd, at.qdd);
    if (whole) {
      of.mujoco->compute();
    } else {
      of.mujoco->compute_bare();
    }
    benchmark::DoNotOptimize(whole ? of.mujoco->effort(0) : of.mujoco->bare_effort(0));
  }
}
#endif

// Keeps the least time of each benchmark.
class LeastTimes : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      const auto [at, added] = times_.emplace(run.run_name.function_name, run.GetAdjustedCPUTime());
      if (!added) at->second = std::min(at->second, run.GetAdjustedCPUTime());
    }
  }
  void print_ratios(const std::string& arm) const {
    const auto mine = times_.find(arm + "/ours");
    if (mine == times_.end()) return;
    std::printf("%-12s ours %6.0f ns", arm.c_str(), mine->second);
    for (const char* peer : {"KDL", "mj_rne", "mj_inverse"}) {
      const auto other = times_.find(arm + "/" + peer);
      if (other == times_.end()) continue;
      std::printf("   %s %6.0f ns (ratio %.1f)", peer, other->second, other->second / mine->second);
    }
    std::printf("\n");
  }

 private:
  std::map<std::string, double> times_;
};

int run(int argc, char** argv) {
  std::vector<std::unique_ptr<Case>> cases;
  cases.push_back(std::make_unique<Case>(manutec_r3(15.0)));
  for (PeerArm& arm : arms_with_masses()) cases.push_back(std::make_unique<Case>(std::move(arm)));
  for (const auto& of : cases) {
    const std::string name = of->arm.id + "/";
    benchmark::RegisterBenchmark((name + "ours").c_str(), ours, std::ref(*of));
    benchmark::RegisterBenchmark((name + "KDL").c_str(), kdl, std::ref(*of));
#ifdef CELLMIRROR_HAVE_MUJOCO
    benchmark::RegisterBenchmark((name + "mj_rne").c_str(), mujoco, std::ref(*of), false);
    benchmark::RegisterBenchmark((name + "mj_inverse").c_str(), mujoco, std::ref(*of), true);
#endif
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  LeastTimes reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  for (const auto& of : cases) reporter.print_ratios(of->arm.id);
  return 0;
}

}  // namespace
}  // namespace cellmirror::dynamics

int main(int argc, char** argv) { return cellmirror::dynamics::run(argc, argv); }
