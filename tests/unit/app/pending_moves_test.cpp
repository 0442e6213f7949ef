// Who waits for a move learns its end once, whatever the tick shows in between.
#include "app/owner/motion/pending_moves.hpp"

#include <gtest/gtest.h>

#include "app/owner/chain_cache.hpp"

namespace cellmirror::app {
namespace {

using State = Activity::State;
using motion::Outcome;

motion::MotionState ended(std::uint32_t first, std::uint32_t last, Outcome outcome) {
  motion::MotionState state;
  state.finished_from = first;
  state.finished = last;
  state.outcome = outcome;
  return state;
}

TEST(PendingMoves, WaitsUntilTheTickSaysThatTheMoveHasEnded) {
  PendingMoves sut("R");
  sut.superseded_all_by_next();
  const ActivityHandle first = sut.watch();
  EXPECT_TRUE(sut.in_flight());
  EXPECT_FALSE(sut.follow(ended(0, 0, Outcome::none)));
  EXPECT_EQ(first->state(), State::running);
  EXPECT_FALSE(sut.follow(ended(1, 1, Outcome::arrived)));
  EXPECT_EQ(first->state(), State::done);
  EXPECT_FALSE(sut.in_flight());
}

TEST(PendingMoves, NewerCommandRefusesWhoWaitsForTheOneBefore) {
  PendingMoves sut("R");
  sut.superseded_all_by_next();
  const ActivityHandle first = sut.watch();
  sut.superseded_all_by_next();
  const ActivityHandle second = sut.watch();
  EXPECT_EQ(first->state(), State::refused);
  EXPECT_NE(first->error().what.find("newer command"), std::string::npos);
  sut.follow(ended(1, 1, Outcome::superseded));
  EXPECT_EQ(second->state(), State::running);
  sut.follow(ended(2, 2, Outcome::arrived));
  EXPECT_EQ(second->state(), State::done);
}

TEST(PendingMoves, EachGroupThatEndsTogetherHasItsOutcome) {
  PendingMoves sut("R");
  sut.superseded_all_by_next();
  const ActivityHandle first = sut.watch();
  sut.queued_next();
  const ActivityHandle second = sut.watch();
  sut.queued_next();
  EXPECT_EQ(sut.count(), 3U);
  EXPECT_TRUE(sut.follow(ended(2, 3, Outcome::stopped)));
  EXPECT_EQ(first->state(), State::done);
  EXPECT_EQ(second->state(), State::refused);
  EXPECT_EQ(sut.count(), 0U);
}

TEST(PendingMoves, BlockedMoveThatOthersFollowIsTheOnlyOneToBeRefused) {
  PendingMoves sut("R");
  sut.superseded_all_by_next();
  const ActivityHandle first = sut.watch();
  sut.queued_next();
  EXPECT_FALSE(sut.follow(ended(1, 1, Outcome::blocked)));
  EXPECT_EQ(first->state(), State::refused);
  EXPECT_TRUE(sut.in_flight());
}

TEST(PendingMoves, GivenUpMovesStayEndedWhateverTheTickShowsAndIdsGoOn) {
  PendingMoves sut("R");
  sut.superseded_all_by_next();
  const ActivityHandle first = sut.watch();
  sut.cancel({"went online", {}});
  EXPECT_EQ(first->state(), State::refused);
  EXPECT_FALSE(sut.in_flight());
  EXPECT_FALSE(sut.follow(ended(1, 1, Outcome::arrived)));
  EXPECT_EQ(first->state(), State::refused);
  EXPECT_EQ(sut.next_id(), 2U);
  sut.superseded_all_by_next();
  EXPECT_FALSE(sut.follow(ended(0, 0, Outcome::none)));  // the robot was loaded again and has forgotten its ids
  EXPECT_TRUE(sut.in_flight());
}

class ChainKeeperTest : public ::testing::Test {
 protected:
  static ChainCache::Chain chain() {
    kinematics::ChainJoint joint;
    auto made = kinematics::Chain::make({{"J", JointKind::revolute, -1, 1}}, std::span(&joint, 1), Pose::Identity());
    return std::make_shared<const kinematics::Chain>(std::move(made.value()));
  }
  ChainCache sut_;
  engine::TickState tick_{8};
};

TEST_F(ChainKeeperTest, KeepsAChainUntilTheNextIsInForceAndItsMovesHaveEnded) {
  auto first = chain();
  const std::weak_ptr<const kinematics::Chain> watched = first;
  sut_.replaced(3, std::move(first), 10, 0);
  sut_.replaced(3, chain(), 20, 7);
  tick_.commands_done = 19;
  tick_.robots[3].motion.finished = 7;
  sut_.release(tick_);
  EXPECT_FALSE(watched.expired());
  tick_.commands_done = 20;
  tick_.robots[3].motion.finished = 6;
  sut_.release(tick_);
  EXPECT_FALSE(watched.expired());
  tick_.robots[3].motion.finished = 7;
  sut_.release(tick_);
  EXPECT_TRUE(watched.expired());
  EXPECT_EQ(sut_.kept(), 1U);
}

TEST_F(ChainKeeperTest, LetsTheChainsOfARemovedRobotGoWhenItIsOut) {
  sut_.replaced(3, chain(), 10, 0);
  sut_.replaced(3, chain(), 20, 7);
  sut_.removed(3, 30);
  tick_.commands_done = 29;
  sut_.release(tick_);
  EXPECT_EQ(sut_.kept(), 2U);
  tick_.commands_done = 30;  // and the tick has forgotten which moves have ended
  sut_.release(tick_);
  EXPECT_EQ(sut_.kept(), 0U);
}

}  // namespace
}  // namespace cellmirror::app
