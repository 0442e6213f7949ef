// What is worth an alarm: pairs, streams, faults, tissue, problems; and nothing where all is well.
#include "app/alarms/alarm_conditions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/unit/app/live_sources.hpp"

namespace cellmirror::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Timestamp kNow{10'000'000'000};

class AlarmConditionsTest : public testing::Test {
 protected:
  AlarmConditionsTest() {
    gateway_.robots[0].online = true;
    gateway_.robots[0].state = DataState::fresh;
    proximity_ = std::make_shared<ProximityState>();
    proximity_->names = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"A", "B", "C"});
    proximity_->pairs = 3;
    proximity_->warning_distance_m = 0.1;
  }

  std::vector<AlarmCondition> look(const std::vector<ProximityEvent>& events = {}) {
    LiveSources sources = gateway_.sources(now_);
    sources.proximity = proximity_;
    sources.problems = problems_;
    sources.tissue = tissue_;
    return sut_.look(sources, faults_, events);
  }
  static TouchingPair touching(std::uint32_t a, std::uint32_t b) {
    TouchingPair out;
    out.a = a;
    out.b = b;
    return out;
  }
  static NearPair near(std::uint32_t a, std::uint32_t b, double distance_m, bool within_warning) {
    NearPair out;
    out.a = a;
    out.b = b;
    out.distance_m = distance_m;
    out.within_warning = within_warning;
    return out;
  }
  static std::vector<std::string> words(const std::vector<AlarmCondition>& conditions) {
    std::vector<std::string> out;
    for (const AlarmCondition& one : conditions) out.push_back(one.kind + ": " + one.subject);
    return out;
  }

  SmallGateway gateway_;
  std::shared_ptr<ProximityState> proximity_;
  std::vector<Problem> problems_;
  std::shared_ptr<TissueReport> tissue_;
  FaultStatus faults_;
  Timestamp now_ = kNow;
  AlarmConditions sut_;
};

TEST_F(AlarmConditionsTest, FindsNothingWhereAllIsWell) { EXPECT_THAT(look(), IsEmpty()); }

TEST_F(AlarmConditionsTest, TellsTouchingPairsFromNearOnes) {
  proximity_->touching = {touching(0, 1)};
  proximity_->near = {near(0, 1, 0.0, true), near(1, 2, 0.05, true), near(0, 2, 0.5, false)};
  const auto found = look();
  EXPECT_THAT(words(found), ElementsAre("collision: A \u2013 B", "near: B \u2013 C"));
  EXPECT_EQ(found[0].priority, AlarmPriority::high);
  EXPECT_EQ(found[1].priority, AlarmPriority::low);
  EXPECT_THAT(found[1].text, HasSubstr("100 mm"));
}

TEST_F(AlarmConditionsTest, MissesNoContactThatWasOverBeforeItLooked) {
  const ProximityEvent touched{.sequence = 7,
                               .change = ProximityChange::touched,
                               .a = "Cell.A",
                               .b = "Cell.B",
                               .posture_time = kNow,
                               .short_a = "A",
                               .short_b = "B"};
  ProximityEvent parted = touched;
  parted.sequence = 8;
  parted.change = ProximityChange::parted;
  EXPECT_THAT(words(look({touched, parted})), ElementsAre("collision: A \u2013 B"));
  EXPECT_EQ(sut_.newest_event(), 8U);
  EXPECT_THAT(look(), IsEmpty());
}

TEST_F(AlarmConditionsTest, KnowsNothingOfPairsThatAreNotTested) {
  proximity_->touching = {touching(0, 1)};
  collision::Settings off;
  off.active = false;
  gateway_.picture.collision = std::make_shared<const collision::Settings>(off);
  EXPECT_THAT(look(), IsEmpty());
}

TEST_F(AlarmConditionsTest, HasAnAlarmForEachStreamThatIsNotFresh) {
  for (const auto& [state, priority] :
       {std::pair(DataState::lost, AlarmPriority::high), std::pair(DataState::implausible, AlarmPriority::high),
        std::pair(DataState::conflict, AlarmPriority::high)}) {
    gateway_.robots[0].state = state;
    const auto found = look();
    ASSERT_THAT(words(found), ElementsAre("stream: ARM"));
    EXPECT_EQ(found[0].priority, priority);
  }
  gateway_.robots[0].online = false;
  EXPECT_THAT(look(), IsEmpty()) << "taken offline on purpose";
}

TEST_F(AlarmConditionsTest, HasNoneForDataThatAreLateForAMoment) {
  for (int i = 0; i < 3; ++i) {
    gateway_.robots[0].state = DataState::stale;
    EXPECT_THAT(look(), IsEmpty());
    now_.ns += 400'000'000;
    EXPECT_THAT(look(), IsEmpty());
    gateway_.robots[0].state = DataState::fresh;
    EXPECT_THAT(look(), IsEmpty());
  }
  gateway_.robots[0].state = DataState::stale;
  EXPECT_THAT(look(), IsEmpty());
  now_.ns += 500'000'000;
  const auto found = look();
  ASSERT_THAT(words(found), ElementsAre("stream: ARM"));
  EXPECT_EQ(found[0].priority, AlarmPriority::medium);
  EXPECT_EQ(found[0].text, "the data of ARM are stale");
}

TEST_F(AlarmConditionsTest, HasTheLoopAndProblems) {
  faults_.latched = true;
  faults_.reason = "the loop stood still";
  problems_ = {{"recording", "the disk is full"}};
  const auto found = look();
  EXPECT_THAT(words(found), ElementsAre("loop: loop", "problem: recording"));
  EXPECT_EQ(found[0].text, "the loop stood still");
  EXPECT_EQ(found[1].text, "the disk is full");
}

TEST_F(AlarmConditionsTest, HasBleedingForAsLongAsItLastsAndTearsOnce) {
  tissue_ = std::make_shared<TissueReport>();
  TissueState& state = tissue_->state;
  state.objects.emplace_back().name = "liver";
  state.vessels.emplace_back(TissueVesselState{.object = "liver", .name = "artery", .bleeding_ml_min = 12.5});
  state.bleeding_ml_min = 12.5;
  state.events = {{.number = 1, .time = kNow, .kind = TissueEventKind::grip, .object = 0},
                  {.number = 2, .time = kNow, .kind = TissueEventKind::tear, .object = 0}};
  EXPECT_THAT(words(look()), ElementsAre("bleeding: artery of liver", "tear: liver"));
  EXPECT_THAT(words(look()), ElementsAre("bleeding: artery of liver"));
  state.vessels.clear();
  EXPECT_THAT(words(look()), ElementsAre("bleeding: the tissue"));
}

}  // namespace
}  // namespace cellmirror::app
