// Inverse kinematics of every arm beside KDL, on the same targets in the same run:
//   inverse_kinematics_bench_all_arms [targets] [--arms shared|unseen|random|NAME] [--methods auto,fast,kdl] [--seed N]
//   [--limit-us N] [--clock cpu]
// Targets are the poses at uniformly random postures; searches start in the middle of the range; 5 ms, 1e-5; failures
// count in the times. An answer counts when the plain forward kinematics and the limits say so; `false` are answers
// that claimed more.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"
#include "rt_core/kinematics/fast_step.hpp"
#include "tests/bench/inverse_kinematics/arms.hpp"
#include "tests/bench/inverse_kinematics/kdl_solvers.hpp"

namespace cellmirror {
namespace {

using inverse_kinematics::Answer;
using inverse_kinematics::FoundBy;
using inverse_kinematics::Method;
using Clock = std::chrono::steady_clock;

constexpr double kTolerance = 1e-5;
std::chrono::microseconds time_limit{5000};

// --clock cpu: the thread's processor time, for a machine on which others work; it costs a system call.
clockid_t clock_id = CLOCK_MONOTONIC;
double now_us() {
  timespec now{};
  clock_gettime(clock_id, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

struct Tally {
  std::vector<double> us;
  std::size_t solved = 0;
  std::size_t false_claims = 0;
  double distance = 0;
  std::array<std::size_t, 5> by{};
};

bool is_solution(const kinematics::Chain& chain, const JointValues& q, const Pose& X_BG) {
  const std::span<const double> values(q.data(), chain.variable_count());
  const kinematics::Twist error = kinematics::pose_error(kinematics::forward(chain, values), X_BG);
  return chain.within_limits(values) && error.cwiseAbs().maxCoeff() <= kTolerance;
}

using Search = std::function<bool(const Pose&, const JointValues&, JointValues&, Tally&)>;

Tally measure(const kinematics::Chain& chain, const std::vector<Pose>& targets, const Search& search) {
  Tally tally;
  const JointValues start = chain.middle();
  for (const Pose& X_BG : targets) {
    JointValues q = start;
    const double begin = now_us();
    const bool claimed = search(X_BG, start, q, tally);
    tally.us.push_back(now_us() - begin);
    const bool good = is_solution(chain, q, X_BG);
    if (claimed && good) {
      ++tally.solved;
      double sum = 0;
      for (std::size_t i = 0; i < chain.variable_count(); ++i) sum += (q[i] - start[i]) * (q[i] - start[i]);
      tally.distance += std::sqrt(sum);
    }
    if (claimed && !good) ++tally.false_claims;
  }
  return tally;
}

void print(const std::string& arm, const std::string& method, Tally tally) {
  std::sort(tally.us.begin(), tally.us.end());
  double sum = 0;
  for (const double us : tally.us) sum += us;
  const auto quantile = [&](double p) { return tally.us[static_cast<std::size_t>(p * double(tally.us.size() - 1))]; };
  const auto n = static_cast<double>(tally.us.size());
  fmt::print("{:16} {:8} {:8.3f} {:9.2f} {:9.2f} {:9.2f} {:9.1f} {:9.1f} {:6} {:8.3f} ", arm, method,
             100.0 * static_cast<double>(tally.solved) / n, sum / n, quantile(0.5), quantile(0.99), quantile(0.999),
             tally.us.back(), tally.false_claims, tally.distance / std::max(1.0, static_cast<double>(tally.solved)));
  for (std::size_t i = 1; i < tally.by.size(); ++i) {
    if (tally.by[i] > 0) fmt::print(" {}:{}", name_of(static_cast<FoundBy>(i)), tally.by[i]);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

Search ours(Method method, const kinematics::Chain& chain) {
  const auto begin = Clock::now();
  std::shared_ptr<inverse_kinematics::Solver> solver = make_solver(method, chain, test_arms::kClock);
  fmt::print("# made in {:.1f} ms\n", std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
  return [solver](const Pose& X_BG, const JointValues& start, JointValues& q, Tally& tally) {
    inverse_kinematics::Request request;
    request.X_BG = X_BG;
    request.present = start;
    request.tolerance = kTolerance;
    request.time_limit = time_limit;
    const Answer answer = solver->solve(request).value();
    q = answer.solutions.front().q;
    ++tally.by[static_cast<std::size_t>(answer.solutions.front().by)];
    return answer.solved;
  };
}

bool asked(const std::string& methods, const std::string& method) { return methods.find(method) != std::string::npos; }

void bench_arm(const test_arms::Arm& arm, std::size_t count, const std::string& methods, std::uint64_t seed) {
  std::vector<Pose> targets;
  for (const JointValues& q : test_arms::random_postures(arm.chain, count, seed)) {
    targets.push_back(kinematics::forward(arm.chain, {q.data(), arm.chain.variable_count()}));
  }
  if (asked(methods, "auto")) print(arm.name, "auto", measure(arm.chain, targets, ours(Method::automatic, arm.chain)));
  if (asked(methods, "fast")) print(arm.name, "fast", measure(arm.chain, targets, ours(Method::fast, arm.chain)));
  if (asked(methods, "ipopt")) print(arm.name, "ipopt", measure(arm.chain, targets, ours(Method::ipopt, arm.chain)));
  if (asked(methods, "kdl") && arm.chain.plain()) {
    test_arms::KdlSolvers kdl(arm.chain, kTolerance, 0.005);
    // LMA knows no limits: what it finds beyond them is no solution, and no false claim either.
    print(arm.name, "kdl-lma",
          measure(arm.chain, targets, [&](const Pose& X, const JointValues& from, JointValues& q, Tally&) {
            return kdl.levenberg_marquardt(X, from, q) && is_solution(arm.chain, q, X);
          }));
    print(arm.name, "kdl-nrjl",
          measure(arm.chain, targets, [&](const Pose& X, const JointValues& from, JointValues& q, Tally&) {
            return kdl.joint_limited(X, from, q) && is_solution(arm.chain, q, X);
          }));
  }
}

int run(int argc, char** argv) {
  std::size_t count = 1000;
  std::uint64_t seed = 7;
  std::string which = "shared,unseen";
  std::string methods = "auto,fast,kdl";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::string value = i + 1 < argc ? argv[i + 1] : "";
    if (word == "--arms") which = value;
    if (word == "--methods") methods = value;
    if (word == "--limit-us") time_limit = std::chrono::microseconds(std::strtol(value.c_str(), nullptr, 10));
    if (word == "--clock" && value == "cpu") clock_id = CLOCK_THREAD_CPUTIME_ID;
    if (word == "--seed") seed = std::strtoull(value.c_str(), nullptr, 10);
    if (word.starts_with("--")) {
      ++i;
    } else {
      count = std::strtoul(word.c_str(), nullptr, 10);
    }
  }
  fmt::print("{:16} {:8} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>6} {:>8}\n", "arm", "method", "solved%", "mean_us",
             "median_us", "p99_us", "p99.9_us", "max_us", "false", "distance");
  const auto bench_all = [&](const std::vector<test_arms::Arm>& arms, const std::string& group) {
    for (const test_arms::Arm& arm : arms) {
      if (asked(which, group) || asked(which, arm.name)) bench_arm(arm, count, methods, seed);
    }
  };
  bench_all(test_arms::shared_arms(), "shared");
  bench_all(test_arms::unseen_arms(), "unseen");
  if (which == "random") {
    for (std::uint64_t arm = 100; arm < 140; ++arm) {
      bench_arm(test_arms::random_arm(4 + arm % 5, arm), count, methods, seed);
    }
  }
  return 0;
}

}  // namespace
}  // namespace cellmirror

int main(int argc, char** argv) { return cellmirror::run(argc, argv); }
