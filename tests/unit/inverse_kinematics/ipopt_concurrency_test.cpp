// Searches at once from two threads, and of one solver from one thread after another, answer as one after the other.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "rt_core/inverse_kinematics/ipopt_solver.hpp"
#include "tests/unit/inverse_kinematics/ipopt_arms.hpp"

namespace cellmirror::inverse_kinematics {
namespace {

using ipopt_test::odd_arm;
using ipopt_test::pose_at;
using ipopt_test::random_posture;
using ipopt_test::wrist_arm;
using kinematics::Chain;

#ifdef CELLMIRROR_SANITIZED
constexpr int kRequests = 150;
#else
constexpr int kRequests = 500;
#endif

std::vector<Request> requests(const Chain& chain, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Request> all(kRequests);
  for (Request& request : all) {
    const JointValues there = random_posture(chain, random, 0.9);
    request.X_BG = pose_at(chain, there);
    request.present = there;
    for (std::size_t i = 0; i < chain.variable_count(); ++i) {
      request.present[i] += std::uniform_real_distribution<>(-0.5, 0.5)(random);
    }
    request.time_limit = std::chrono::seconds(60);  // time decides nothing
  }
  return all;
}

std::vector<Answer> solve_all(const Chain& chain, const std::vector<Request>& all) {
  const auto solver = make_ipopt_solver(chain, ipopt_test::kClock, {});
  std::vector<Answer> answers;
  for (const Request& request : all) answers.push_back(solver->solve(request).value());
  return answers;
}

void expect_same_bits(const std::vector<Answer>& a, const std::vector<Answer>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_TRUE(a[k].solved);
    EXPECT_EQ(a[k].solved, b[k].solved);
    EXPECT_EQ(a[k].iterations, b[k].iterations);
    ASSERT_EQ(a[k].solutions.size(), b[k].solutions.size());
    for (std::size_t i = 0; i < a[k].solutions.size(); ++i) {
      EXPECT_EQ(std::memcmp(a[k].solutions[i].q.data(), b[k].solutions[i].q.data(), sizeof(JointValues)), 0);
    }
  }
}

TEST(IpoptConcurrency, TwoThreadsAnswerAsOneAfterTheOther) {
  const std::array<Chain, 2> chains = {odd_arm(), wrist_arm()};
  const std::array<std::vector<Request>, 2> asked = {requests(chains[0], 1), requests(chains[1], 2)};
  std::array<std::vector<Answer>, 2> at_once;
  {
    std::array<std::jthread, 2> threads;
    for (std::size_t i = 0; i < 2; ++i) {
      threads[i] = std::jthread([&, i] { at_once[i] = solve_all(chains[i], asked[i]); });
    }
  }
  for (std::size_t i = 0; i < 2; ++i) expect_same_bits(at_once[i], solve_all(chains[i], asked[i]));
}

TEST(IpoptConcurrency, ASolverMayChangeItsThread) {
  const Chain chain = odd_arm();
  std::vector<Request> asked = requests(chain, 3);
  asked.resize(60);
  const auto solver = make_ipopt_solver(chain, ipopt_test::kClock, {});
  std::vector<Answer> answers;
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (k % 3 == 0) {
      answers.push_back(solver->solve(asked[k]).value());
    } else {
      std::jthread([&] { answers.push_back(solver->solve(asked[k]).value()); }).join();
    }
  }
  expect_same_bits(answers, solve_all(chain, asked));
}

}  // namespace
}  // namespace cellmirror::inverse_kinematics
