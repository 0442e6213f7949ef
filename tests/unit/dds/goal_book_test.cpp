// Goals of an action: who is answered what, and when.
#include "drivers/dds/goal_book.hpp"

#include <gtest/gtest.h>

namespace cellmirror::dds {
namespace {

GoalId id(std::uint8_t number) {
  GoalId out{};
  out[0] = number;
  return out;
}
RequestName from(std::int64_t number) { return {{{}, number}}; }
RosTime at(std::int32_t sec) { return {sec, 0}; }

TEST(GoalBook, AGoalIsAnsweredOnceAndItsResultGoesToThoseThatWait) {
  GoalBook sut;
  ASSERT_TRUE(sut.ask(id(1), from(10), at(1)));
  EXPECT_FALSE(sut.ask(id(1), from(11), at(1))) << "the id is known";
  EXPECT_TRUE(sut.status().empty());
  EXPECT_EQ(sut.result_of(id(1), from(12))->status, GoalStatus::unknown) << "it was not taken yet";
  EXPECT_EQ(sut.answer(id(1), true), from(10));
  EXPECT_FALSE(sut.answer(id(1), true).has_value());
  EXPECT_EQ(sut.running(), id(1));
  EXPECT_FALSE(sut.result_of(id(1), from(13)).has_value());
  EXPECT_FALSE(sut.result_of(id(1), from(14)).has_value());
  const auto finished = sut.finish(id(1), {GoalEnd::succeeded, 0, "well"});
  ASSERT_TRUE(finished.has_value());
  EXPECT_EQ(finished->waiting, (std::vector<RequestName>{from(13), from(14)}));
  EXPECT_EQ(finished->reply.status, GoalStatus::succeeded);
  EXPECT_FALSE(sut.finish(id(1), {}).has_value());
  EXPECT_EQ(sut.result_of(id(1), from(15))->result.text, "well");
  EXPECT_FALSE(sut.running().has_value());
}

TEST(GoalBook, ARefusedGoalIsForgotten) {
  GoalBook sut;
  ASSERT_TRUE(sut.ask(id(1), from(10), at(1)));
  EXPECT_EQ(sut.answer(id(1), false), from(10));
  EXPECT_TRUE(sut.status().empty());
  EXPECT_TRUE(sut.ask(id(1), from(11), at(2)));
}

TEST(GoalBook, CancelsByIdByTimeAndAll) {
  GoalBook sut;
  for (std::uint8_t i = 1; i <= 4; ++i) {
    ASSERT_TRUE(sut.ask(id(i), from(i), at(i)));
    ASSERT_TRUE(sut.answer(id(i), true).has_value());
  }
  sut.finish(id(4), {GoalEnd::succeeded, 0, {}});
  const auto numbers = [&](const CancelRequest& request) {
    std::vector<int> out;
    for (const GoalInfo& goal : sut.cancel(request).goals) out.push_back(goal.id[0]);
    return out;
  };
  EXPECT_EQ(numbers({id(2), {}}), (std::vector<int>{2}));
  EXPECT_EQ(numbers({{}, at(1)}), (std::vector<int>{1}));
  EXPECT_EQ(numbers({id(3), at(1)}), (std::vector<int>{1, 3})) << "that one, and those before the time";
  EXPECT_EQ(numbers({{}, {}}), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(sut.cancel({id(4), {}}).code, CancelCode::terminated);
  EXPECT_EQ(sut.cancel({id(9), {}}).code, CancelCode::unknown_goal);
  EXPECT_EQ(sut.status()[1].status, GoalStatus::canceling);
}

TEST(GoalBook, ForgetsTheOldestThatHasEndedAndTakesNoMoreThanItHolds) {
  GoalBook sut;
  for (std::uint8_t i = 1; i <= GoalBook::kMostGoals; ++i) {
    ASSERT_TRUE(sut.ask(id(i), from(i), at(1)));
    ASSERT_TRUE(sut.answer(id(i), true).has_value());
  }
  EXPECT_FALSE(sut.ask(id(100), from(0), at(2)));
  sut.finish(id(7), {});
  EXPECT_TRUE(sut.ask(id(100), from(0), at(2)));
  EXPECT_EQ(sut.result_of(id(7), from(1))->status, GoalStatus::unknown);
  for (std::size_t i = 0; i < GoalBook::kMostWaiting; ++i)
    EXPECT_FALSE(sut.result_of(id(1), from(static_cast<std::int64_t>(i))).has_value());
  EXPECT_TRUE(sut.result_of(id(1), from(99)).has_value()) << "too many wait";
}

}  // namespace
}  // namespace cellmirror::dds
