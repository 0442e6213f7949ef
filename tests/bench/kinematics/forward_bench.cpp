// Forward kinematics and Jacobians against Orocos KDL, on the arms of ../shared/data/robots and the same postures. The
// ratios at the end are of the least times of this run:
//   kinematics_bench --benchmark_repetitions=5
// Without the arms there is nothing to measure, and it says so.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "rt_core/kinematics/forward.hpp"
#include "tests/unit/kinematics/kdl_chain.hpp"
#include "tests/unit/kinematics/shared_arms.hpp"

namespace cellmirror {
namespace {

constexpr std::size_t kPostures = 1024;  // a power of two

struct Arm {
  explicit Arm(const SharedArm& from)
      : id(from.id),
        chain(chain_of_urdf(from.urdf, from.base, from.tip)),
        kdl(kdl_chain(from.urdf, from.base, from.tip)) {
    std::mt19937_64 random(1);
    for (std::size_t i = 0; i < kPostures; ++i) {
      q.push_back(random_posture(chain, random));
      KDL::JntArray values(kdl.getNrOfJoints());
      for (unsigned k = 0; k < values.rows(); ++k) values(k) = q.back()[k];
      kdl_q.push_back(values);
    }
  }
  [[nodiscard]] std::span<const double> values(std::size_t i) const {
    return {q[i % kPostures].data(), chain.variable_count()};
  }

  std::string id;
  kinematics::Chain chain;
  KDL::Chain kdl;
  std::vector<JointValues> q;
  std::vector<KDL::JntArray> kdl_q;
};

void forward_ours(benchmark::State& state, const Arm& arm) {
  std::size_t i = 0;
  for (auto _ : state) {
    Pose X_BT = kinematics::forward(arm.chain, arm.values(i++));
    benchmark::DoNotOptimize(X_BT);
  }
}

void forward_kdl(benchmark::State& state, const Arm& arm) {
  KDL::ChainFkSolverPos_recursive solver(arm.kdl);
  KDL::Frame frame;
  std::size_t i = 0;
  for (auto _ : state) {
    solver.JntToCart(arm.kdl_q[i++ % kPostures], frame);
    benchmark::DoNotOptimize(frame);
  }
}

void jacobian_ours(benchmark::State& state, const Arm& arm) {
  kinematics::Jacobian jacobian;
  std::size_t i = 0;
  for (auto _ : state) {
    Pose X_BT = kinematics::forward(arm.chain, arm.values(i++), jacobian);
    benchmark::DoNotOptimize(X_BT);
    benchmark::DoNotOptimize(jacobian);
  }
}

void jacobian_kdl(benchmark::State& state, const Arm& arm) {
  KDL::ChainJntToJacSolver solver(arm.kdl);
  KDL::Jacobian jacobian(arm.kdl.getNrOfJoints());
  std::size_t i = 0;
  for (auto _ : state) {
    solver.JntToJac(arm.kdl_q[i++ % kPostures], jacobian);
    benchmark::DoNotOptimize(jacobian);
  }
}

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
  void print_ratio(const std::string& subject, const std::string& arm) const {
    const auto ours = times_.find(subject + "/" + arm + "/ours");
    const auto kdl = times_.find(subject + "/" + arm + "/kdl");
    if (ours == times_.end() || kdl == times_.end()) return;
    std::printf("%-9s %-12s KDL %7.1f ns  ours %6.1f ns  ratio %5.1f\n", subject.c_str(), arm.c_str(), kdl->second,
                ours->second, kdl->second / ours->second);
  }

 private:
  std::map<std::string, double> times_;
};

int run(int argc, char** argv) {
  const auto shared = shared_arms();
  if (shared.empty()) {
    std::puts("skipped: the robots of ../shared/data are not on this machine");
    constexpr int kSkipped = 77;
    return kSkipped;
  }
  std::vector<std::unique_ptr<Arm>> arms;
  for (const SharedArm& arm : shared) arms.push_back(std::make_unique<Arm>(arm));
  for (const auto& arm : arms) {
    const auto add = [&](const std::string& name, auto function) {
      benchmark::RegisterBenchmark(name.c_str(), function, std::cref(*arm));
    };
    add("forward/" + arm->id + "/kdl", forward_kdl);
    add("forward/" + arm->id + "/ours", forward_ours);
    add("jacobian/" + arm->id + "/kdl", jacobian_kdl);
    add("jacobian/" + arm->id + "/ours", jacobian_ours);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  LeastTimes reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  for (const auto& arm : arms) {
    reporter.print_ratio("forward", arm->id);
    reporter.print_ratio("jacobian", arm->id);
  }
  return 0;
}

}  // namespace
}  // namespace cellmirror

int main(int argc, char** argv) { return cellmirror::run(argc, argv); }
