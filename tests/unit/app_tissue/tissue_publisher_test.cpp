// Events of tissue on their way to outputs and the log: each one once, with names.
#include "app/io/tissue_publisher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/app_tissue/sample_report.hpp"

namespace cellmirror::app {
namespace {

using test::kNow;
using test::sample_cell;
using test::tissue_event;
using testing::ElementsAre;
using testing::IsEmpty;

class Events final : public TissueEventOutput {
 public:
  void publish_tissue_events(std::span<const NamedTissueEvent> events) override {
    for (const NamedTissueEvent& event : events) {
      numbers.push_back(event.event.number);
      newest = event;
    }
  }
  std::vector<std::uint64_t> take() { return std::exchange(numbers, {}); }
  std::vector<std::uint64_t> numbers;
  NamedTissueEvent newest;
};

class Shapes final : public TissueShapeOutput {
 public:
  [[nodiscard]] Nanoseconds tissue_period() const override { return period; }
  void publish_tissue_shapes(Timestamp /*time*/, const TissueView& view,
                             std::span<const TissueForceArrow> arrows) override {
    steps.push_back(view.step);
    forces.assign(arrows.begin(), arrows.end());
  }
  Nanoseconds period{500'000'000};
  std::vector<std::uint64_t> steps;
  std::vector<TissueForceArrow> forces;
};

class TissuePublishing : public testing::Test {
 protected:
  void report(std::vector<TissueEvent> events) {
    auto made = std::make_shared<TissueReport>(test::sample_report());
    made->state.events = std::move(events);
    board_.publish(std::move(made));
    sut_.look(cell_, robots_);
  }
  void report_numbers(std::uint64_t first, std::uint64_t last) {
    std::vector<TissueEvent> events;
    for (std::uint64_t i = first; i <= last; ++i) events.push_back(tissue_event(i, TissueEventKind::grip));
    report(std::move(events));
  }
  std::vector<std::uint64_t> news(std::size_t output) {
    sut_.publish_events(output, events_);
    return events_.take();
  }

  Board<TissueReport> board_;
  std::shared_ptr<TissueView> view_;
  int asked_ = 0;
  CellState cell_ = sample_cell();
  std::vector<RobotState> robots_ = std::vector<RobotState>(2);
  Events events_;
  Shapes shapes_;
  TissuePublisher sut_{{&board_,
                        [this] {
                          ++asked_;
                          return view_;
                        }},
                       2};
};

TEST_F(TissuePublishing, EachOutputGetsEachEventOnce) {
  report_numbers(1, 3);
  EXPECT_THAT(news(0), ElementsAre(1, 2, 3));
  EXPECT_THAT(news(0), IsEmpty());
  report_numbers(2, 5);
  EXPECT_THAT(news(0), ElementsAre(4, 5));
  EXPECT_THAT(news(1), ElementsAre(2, 3, 4, 5)) << "the first was gone before this output was due";
  EXPECT_EQ(events_.newest.robot, "GRASPER");
  EXPECT_EQ(events_.newest.object, "liver");
}

TEST_F(TissuePublishing, NumbersThatBeginAgainAreNew) {
  report_numbers(7, 9);
  EXPECT_THAT(news(0), ElementsAre(7, 8, 9));
  report_numbers(1, 2);
  EXPECT_THAT(news(0), ElementsAre(1, 2));
}

TEST_F(TissuePublishing, NothingComesOfNothing) {
  EXPECT_THAT(news(0), IsEmpty());
  report({});
  EXPECT_THAT(news(0), IsEmpty());
  TissuePublisher none({}, 1);
  none.look(cell_, robots_);
  none.publish_events(0, events_);
  none.publish_shapes(0, kNow, shapes_);
  EXPECT_THAT(events_.take(), IsEmpty());
  EXPECT_THAT(shapes_.steps, IsEmpty());
}

TEST_F(TissuePublishing, ShapesGoAsOftenAsTheyAreWantedAndOnlyNewOnes) {
  report_numbers(1, 1);
  sut_.publish_shapes(0, kNow, shapes_);
  EXPECT_THAT(shapes_.steps, IsEmpty()) << "there is no view yet";
  EXPECT_EQ(asked_, 1);
  view_ = std::make_shared<TissueView>();
  view_->step = 10;
  sut_.publish_shapes(0, kNow + Nanoseconds(20'000'000), shapes_);
  EXPECT_THAT(shapes_.steps, ElementsAre(10));
  view_ = std::make_shared<TissueView>();
  view_->step = 11;
  sut_.publish_shapes(0, kNow + Nanoseconds(500'000'000), shapes_);
  EXPECT_THAT(shapes_.steps, ElementsAre(10)) << "not due";
  EXPECT_EQ(asked_, 2) << "what is not due is not asked for";
  sut_.publish_shapes(0, kNow + Nanoseconds(520'000'000), shapes_);
  sut_.publish_shapes(0, kNow + Nanoseconds(5'000'000'000), shapes_);
  EXPECT_THAT(shapes_.steps, ElementsAre(10, 11)) << "and nothing twice";
  shapes_.period = Nanoseconds(0);
  sut_.publish_shapes(1, kNow, shapes_);
  EXPECT_THAT(shapes_.steps, ElementsAre(10, 11));
}

TEST_F(TissuePublishing, ForcesActAtTheToolCentrePointOfTheInstrument) {
  robots_[1].id = "GRASPER";
  robots_[1].X_WT.translation() = Eigen::Vector3d(1, 2, 3);
  report_numbers(1, 1);
  view_ = std::make_shared<TissueView>();
  view_->step = 1;
  sut_.publish_shapes(0, kNow, shapes_);
  ASSERT_EQ(shapes_.forces.size(), 1U);
  EXPECT_EQ(shapes_.forces[0].robot, "GRASPER");
  EXPECT_EQ(shapes_.forces[0].at, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(shapes_.forces[0].force_W, Eigen::Vector3d(3, 0, -4));
}

TEST(TissueSentence, SaysWhoDidWhatToWhatAndWhere) {
  TissueLimit beyond = TissueLimit::contact_force;
  const auto said = [&](TissueEventKind kind, std::string_view part, double value, std::string robot = "ARM") {
    TissueEvent event = tissue_event(1, kind, part);
    event.value = value;
    event.limit = beyond;
    return sentence({event, std::move(robot), "liver"});
  };
  const std::string at = " at (125.0, -500.0, 1000.0) mm";
  using enum TissueEventKind;
  EXPECT_EQ(said(grip, "", 3), "ARM grips liver" + at);
  EXPECT_EQ(said(release, "", 1), "ARM releases liver" + at);
  EXPECT_EQ(said(slip, "", 1.5), "ARM slips off liver at 1.50 N" + at);
  EXPECT_EQ(said(clip, "cystic_artery", 0.02), "ARM puts a clip on cystic_artery of liver" + at);
  EXPECT_EQ(said(cut, "", 2e-6), "ARM cuts liver, 2.0 mm2" + at);
  EXPECT_EQ(said(coagulate, "", 0), "ARM begins to coagulate liver" + at);
  EXPECT_EQ(said(coagulate, "", 0.015), "ARM has coagulated 1.5 % of liver" + at);
  EXPECT_EQ(said(tear, "", 0, ""), "liver tears" + at);
  EXPECT_EQ(said(bleed, "cystic_artery", 12.5, ""), "cystic_artery of liver bleeds, 12.5 ml/min" + at);
  EXPECT_EQ(said(bleed_end, "cystic_artery", 0, ""), "cystic_artery of liver bleeds no more" + at);
  EXPECT_EQ(said(limit, "", 8.5), "ARM on liver: 8.5 N is beyond the limit CONTACT_FORCE" + at);
  EXPECT_EQ(said(limit, "", 8.5, ""), "liver: 8.5 N is beyond the limit CONTACT_FORCE" + at);
  beyond = TissueLimit::node_speed;
  EXPECT_EQ(said(limit, "", 0.25, ""), "liver: 250 mm/s is beyond the limit NODE_SPEED" + at);
  beyond = TissueLimit::penetration;
  EXPECT_EQ(said(limit, "", 0.002), "ARM on liver: 2 mm is beyond the limit PENETRATION" + at);
  beyond = TissueLimit::strain;
  EXPECT_EQ(said(limit, "", 0.75, ""), "liver: 0.75 is beyond the limit STRAIN" + at);
}

}  // namespace
}  // namespace cellmirror::app
