// Who waits for a move learns its end once, whatever the tick shows in between.
#include "app/owner/motion/pending_moves.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace cellmirror::app
