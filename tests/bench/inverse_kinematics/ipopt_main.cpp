// inverse_kinematics_bench_ipopt [targets] [limit_ms] [robot|all] [wall|cpu]: Ipopt's searches on the shared arms:
// rate, times and iterations from the middle of the ranges (cold) and from near the solution, and Ipopt's own linear
// solver and other Hessians on the same targets in the same run. With `cpu` times and limit are the thread's processor
// time, for a machine that does something else meanwhile.
#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "rt_core/inverse_kinematics/ipopt_solver.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "tests/bench/inverse_kinematics/arms.hpp"

namespace {

using namespace cellmirror;
using inverse_kinematics::Answer;
using inverse_kinematics::IpoptSettings;
using inverse_kinematics::Request;

constexpr double kNearNoise = 0.1;  // rad or m, standard deviation

double now_ms(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

struct Figures {
  std::vector<double> ms;
  std::size_t solved = 0;
  double iterations = 0;
  double mean = 0;
};

std::vector<Request> requests(const kinematics::Chain& chain, std::size_t count, bool near) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, kNearNoise);
  std::vector<Request> all;
  for (const JointValues& q : test_arms::random_postures(chain, count, 7)) {
    Request request;
    request.X_BG = kinematics::forward(chain, {q.data(), chain.variable_count()});
    request.present = chain.middle();
    for (std::size_t i = 0; near && i < chain.variable_count(); ++i) {
      request.present[i] = std::clamp(q[i] + noise(random), chain.lower()[i], chain.upper()[i]);
    }
    all.push_back(request);
  }
  return all;
}

Figures measure(inverse_kinematics::Solver& solver, const std::vector<Request>& all, int limit_ms, clockid_t clock) {
  constexpr int kWallMargin = 10;  // of the limit, where processor time is what counts
  Figures figures;
  for (Request request : all) {
    request.time_limit = std::chrono::milliseconds(clock == CLOCK_MONOTONIC ? limit_ms : kWallMargin * limit_ms);
    const double start = now_ms(clock);
    const Result<Answer> answer = solver.solve(request);
    figures.ms.push_back(now_ms(clock) - start);
    if (!answer) {
      fmt::print(stderr, "{}\n", answer.error().text());
      std::exit(1);
    }
    figures.solved += answer->solved && figures.ms.back() <= limit_ms ? 1 : 0;
    figures.iterations += answer->iterations;
    figures.mean += figures.ms.back();
  }
  figures.mean /= static_cast<double>(all.size());
  figures.iterations /= static_cast<double>(all.size());
  std::sort(figures.ms.begin(), figures.ms.end());
  return figures;
}

void print(const std::string& arm, const char* start, const char* variant, const Figures& f) {
  const std::size_t n = f.ms.size();
  fmt::print("{:14} {:5} {:24} {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:8.2f} {:8.1f}\n", arm, start, variant,
             100.0 * static_cast<double>(f.solved) / static_cast<double>(n), f.mean, f.ms[n / 2], f.ms[n * 99 / 100],
             f.ms.back(), f.iterations);
  std::fflush(stdout);
}

struct Variant {
  const char* name;
  IpoptSettings settings;
  std::size_t share;  // one of so many targets
};

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? static_cast<std::size_t>(std::max(1, std::atoi(argv[1]))) : 1000;
  const int limit_ms = argc > 2 ? std::max(1, std::atoi(argv[2])) : 50;
  const std::string only = argc > 3 ? argv[3] : "all";
  const clockid_t clock = argc > 4 && std::string(argv[4]) == "cpu" ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC;
  const std::vector<Variant> variants = {
      {"dense", {}, 1},
      {"dense, exact", {.linear_solver = {}, .hessian = IpoptSettings::Hessian::exact}, 10},
      {"dense, Gauss-Newton", {.linear_solver = {}, .hessian = IpoptSettings::Hessian::gauss_newton}, 10},
      {"MUMPS", {.linear_solver = IpoptSettings::LinearSolver::mumps, .hessian = {}}, 10}};
  fmt::print("{} reachable targets an arm (other variants: a tenth), 1e-5 of each component, {} ms\n", count, limit_ms);
  fmt::print("{:14} {:5} {:24} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "arm", "start", "variant", "solved %", "mean ms",
             "median", "p99", "max", "iterat.");
  for (const test_arms::Arm& arm : test_arms::shared_arms()) {
    if (only != "all" && arm.name != only) continue;
    for (const bool near : {false, true}) {
      std::vector<Request> all = requests(arm.chain, count, near);
      for (const Variant& variant : variants) {
        const auto solver = make_ipopt_solver(arm.chain, test_arms::kClock, variant.settings);
        all.resize(std::max<std::size_t>(1, count / variant.share));
        (void)solver->solve(all.front());
        print(arm.name, near ? "near" : "cold", variant.name, measure(*solver, all, limit_ms, clock));
      }
    }
  }
}
