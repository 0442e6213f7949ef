#include "app/kinematics/ik_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/kinematics/targets.hpp"

namespace cellmirror::app {
namespace {

using inverse_kinematics::FoundBy;
using kinematics::Chain;
using testing::HasSubstr;

// A slide along z, and a turn about it without limits.
Chain slide_and_turn() {
  std::vector<kinematics::Variable> variables = {{"lift", JointKind::prismatic, 0.1, 0.5},
                                                 {"turn", JointKind::continuous, -INFINITY, INFINITY}};
  std::vector<kinematics::ChainJoint> joints(2);
  joints[0].kind = JointKind::prismatic;
  joints[1].kind = JointKind::continuous;
  joints[1].variable = 1;
  return Chain::make(variables, joints, Pose::Identity()).value();
}

IkOutcome outcome(bool solved, double time_us, FoundBy by) {
  IkOutcome out;
  out.solved = solved;
  out.time_us = time_us;
  out.by = by;
  out.q[0] = 0.25;
  out.q[1] = -1.5;
  return out;
}

class Report : public testing::Test {
 protected:
  Report() {
    for (int i = 1; i <= 200; ++i)
      run_.outcomes.push_back(outcome(i != 7, i, i == 7 ? FoundBy::nobody : FoundBy::fast));
    run_.outcomes[6].position_error_m = 0.125;
    run_.outcomes[6].timed_out = true;
    run_.outcomes[0].alternatives = {0.3, 1.0, 0.4, 2.0};
  }

  [[nodiscard]] IkReport report() const { return {robot_, settings_, "align_POS", run_, statistics_of(run_)}; }

  [[nodiscard]] nlohmann::json document() const {
    char* text = nullptr;
    std::size_t size = 0;
    std::FILE* out = open_memstream(&text, &size);
    print_json(report(), out);
    std::fclose(out);
    const std::unique_ptr<char, decltype(&std::free)> owner(text, std::free);
    return nlohmann::json::parse(std::string(text, size));
  }

  ChosenRobot robot_{"crane \xff", "base", "hook", slide_and_turn()};
  IkSettings settings_;
  IkRun run_;
};

TEST_F(Report, CountsAndRanksTimes) {
  const IkStatistics sut = statistics_of(run_);
  EXPECT_EQ(sut.samples, 200U);
  EXPECT_EQ(sut.solved, 199U);
  EXPECT_EQ(sut.timed_out, 1U);
  EXPECT_DOUBLE_EQ(sut.rate, 0.995);
  EXPECT_DOUBLE_EQ(sut.mean_us, 100.5);
  EXPECT_DOUBLE_EQ(sut.median_us, 100);
  EXPECT_DOUBLE_EQ(sut.p99_us, 198);
  EXPECT_DOUBLE_EQ(sut.max_us, 200);
  EXPECT_EQ(sut.by[static_cast<std::size_t>(FoundBy::fast)], 199U);
}

TEST_F(Report, OfNothingHasNoNumbersThatAreNone) {
  run_.outcomes.clear();
  const nlohmann::json sut = document();
  EXPECT_EQ(sut["rate"], 0.0);
  EXPECT_EQ(sut["p99_us"], 0.0);
  EXPECT_TRUE(sut["solutions"].empty());
  EXPECT_TRUE(plot::png_of(figure(report())));
}

TEST_F(Report, KeepsTheOrderOfTheTargetsAndTellsWhatIsNotSolved) {
  const nlohmann::json sut = document();
  ASSERT_EQ(sut["solutions"].size(), 200U);
  EXPECT_EQ(sut["class"], "align_POS");
  EXPECT_EQ(sut["joint_names"], nlohmann::json({"lift", "turn"}));
  const nlohmann::json& failed = sut["solutions"][6];
  EXPECT_EQ(failed["solved"], false);
  EXPECT_EQ(failed["joints"], nlohmann::json({0.25, -1.5}));
  EXPECT_EQ(failed["position_error_m"], 0.125);
  EXPECT_EQ(failed["by"], "none");
  EXPECT_EQ(sut["solutions"][199]["time_us"], 200.0);
  EXPECT_FALSE(failed.contains("alternatives"));
}

TEST_F(Report, ListsTheOtherPosturesWhereTheyWereAskedFor) {
  settings_.max_solutions = 8;
  const nlohmann::json sut = document();
  EXPECT_EQ(sut["solutions"][0]["alternatives"], nlohmann::json::parse("[[0.3,1.0],[0.4,2.0]]"));
  EXPECT_TRUE(sut["solutions"][1]["alternatives"].empty());
}

TEST_F(Report, TellsThePersonWhatWasNotReached) {
  EXPECT_THAT(not_reached(report(), 6), HasSubstr("target 7 is not reached within 1e-05 in the time given"));
  EXPECT_THAT(not_reached(report(), 6), HasSubstr("0.125 m"));
  EXPECT_THAT(table(report()), HasSubstr("solved  199 of 200 (99.5 %); fast 199; 1 stopped by the time limit"));
  EXPECT_THAT(table(report()), HasSubstr("median 100.0, p99 198.0"));
}

TEST_F(Report, DrawsEvenWhatHasNoError) { EXPECT_TRUE(plot::png_of(figure(report()))); }

TEST(ReachableTargets, LieWithinTheLimitsAndDependOnTheSeedAlone) {
  const Chain chain = slide_and_turn();
  const auto sut = reachable_targets(chain, 1000, 42);
  ASSERT_EQ(sut.size(), 1000U);
  double lowest = 1, highest = 0, most = 0;
  for (const Pose& X_BG : sut) {
    lowest = std::min(lowest, X_BG.translation().z());
    highest = std::max(highest, X_BG.translation().z());
    most = std::max(most, std::abs(std::atan2(X_BG(1, 0), X_BG(0, 0))));
  }
  EXPECT_GE(lowest, 0.1);
  EXPECT_LT(lowest, 0.11);
  EXPECT_LE(highest, 0.5);
  EXPECT_GT(highest, 0.49);
  EXPECT_GT(most, 3.0);
  EXPECT_TRUE(sut[999].isApprox(reachable_targets(chain, 1000, 42)[999], 0.0));
  EXPECT_FALSE(sut[0].isApprox(reachable_targets(chain, 1, 43)[0]));
}

}  // namespace
}  // namespace cellmirror::app
