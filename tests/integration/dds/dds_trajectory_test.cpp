// A controller's endpoint, commanded and read by Cyclone DDS.
#include <gtest/gtest.h>

#include <mutex>
#include <vector>

#include "cyclone_peer.hpp"
#include "drivers/dds/trajectory_endpoint.hpp"
#include "own_network.hpp"
#include "waiting.hpp"

namespace cellmirror::dds::test {
namespace {

class CollectedTrajectories final : public TrajectorySink {
 public:
  void command(JointTrajectory&& trajectory) override {
    const std::scoped_lock lock(mutex_);
    commands_.push_back(std::move(trajectory));
  }
  void refused(TrajectoryRefusal refusal, const std::string& /*why*/) override {
    const std::scoped_lock lock(mutex_);
    refusals_.push_back(refusal);
  }
  void goal(TrajectoryGoal&& /*goal*/, JointTrajectory&& /*trajectory*/) override {}
  void cancel(const GoalId& /*goal*/) override {}
  [[nodiscard]] std::vector<JointTrajectory> commands() {
    const std::scoped_lock lock(mutex_);
    return commands_;
  }
  [[nodiscard]] std::vector<TrajectoryRefusal> refusals() {
    const std::scoped_lock lock(mutex_);
    return refusals_;
  }

 private:
  std::mutex mutex_;
  std::vector<JointTrajectory> commands_;
  std::vector<TrajectoryRefusal> refusals_;
};

class DdsTrajectoryTest : public testing::Test {
 protected:
  void SetUp() override {
    ControllerConfig config;
    config.robot = "arm";
    config.name = "arm_controller";
    config.domain = domain_;
    config.joints = {{.joint = 0, .ros_name = "a"}, {.joint = 1, .ros_name = "b"}};
    auto made = make_trajectory_endpoint(config);
    ASSERT_TRUE(made.has_value()) << made.error().text();
    sut_ = std::move(*made);
    const auto opened = sut_->open(sink_);
    ASSERT_TRUE(opened.has_value()) << opened.error().text();
  }
  void TearDown() override { sut_->close(); }

  int domain_ = test_domain(5);
  CollectedTrajectories sink_;
  std::unique_ptr<TrajectoryEndpoint> sut_;
};

TEST_F(DdsTrajectoryTest, TakesWhatCycloneDdsPublishes) {
  CyclonePeer peer(domain_);
  const dds_entity_t writer = peer.trajectory_writer("rt/arm_controller/joint_trajectory");
  ASSERT_TRUE(eventually([&] { return CyclonePeer::matched_readers(writer) == 1; }));
  PlainTrajectory message{.sec = 5, .nanosec = 6, .joints = {"b", "a"}, .points = {}};
  message.points = {{{1, 2}, {}, {}, 0, 0}, {{3, 4}, {5, 6}, {7, 8}, 1, 500'000'000}};
  ASSERT_TRUE(CyclonePeer::write(writer, message));
  ASSERT_TRUE(eventually([&] { return sink_.commands().size() == 1; }));
  const JointTrajectory taken = sink_.commands().front();
  EXPECT_EQ(taken.start_wall_ns, 5'000'000'006);
  EXPECT_EQ(taken.joints, message.joints);
  ASSERT_EQ(taken.points.size(), 2U);
  EXPECT_EQ(taken.points[1].positions, message.points[1].positions);
  EXPECT_EQ(taken.points[1].velocities, message.points[1].velocities);
  EXPECT_EQ(taken.points[1].accelerations, message.points[1].accelerations);
  EXPECT_EQ(taken.points[1].time_from_start, Nanoseconds(1'500'000'000));
  EXPECT_EQ(sut_->status().publishers, 1);
  EXPECT_EQ(sut_->status().messages, 1U);
}

TEST_F(DdsTrajectoryTest, RefusesAHundredThousandPoints) {
  CyclonePeer peer(domain_);
  const dds_entity_t writer = peer.trajectory_writer("rt/arm_controller/joint_trajectory");
  ASSERT_TRUE(eventually([&] { return CyclonePeer::matched_readers(writer) == 1; }));
  PlainTrajectory message{.sec = 0, .nanosec = 0, .joints = {"a", "b"}, .points = {}};
  message.points.resize(100'000, {{1, 2}, {}, {}, 0, 0});
  CyclonePeer::write(writer, message);
  ASSERT_TRUE(eventually([&] { return !sink_.refusals().empty(); }));
  EXPECT_EQ(sink_.refusals().front(), TrajectoryRefusal::too_many_points);
  EXPECT_TRUE(sink_.commands().empty());
}

TEST_F(DdsTrajectoryTest, CycloneDdsReadsItsState) {
  CyclonePeer peer(domain_);
  const dds_entity_t reader = peer.controller_state_reader("rt/arm_controller/controller_state");
  ASSERT_TRUE(eventually([&] { return sut_->status().state_readers == 1; }));
  ControllerState state;
  state.time = SystemClock().now();
  state.reference = {{1, 2, 3}, {4, 5, 6}};
  state.feedback = {{0.5, 2, 0}, {4.25, 5, 0}};
  std::vector<PlainControllerState> read;
  ASSERT_TRUE(eventually([&] {
    sut_->publish(state);
    read = CyclonePeer::take_controller_states(reader);
    return !read.empty();
  }));
  EXPECT_EQ(read[0].joints, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(read[0].reference, (std::vector<double>{1, 4}));
  EXPECT_EQ(read[0].feedback, (std::vector<double>{0.5, 4.25}));
  EXPECT_EQ(read[0].error, (std::vector<double>{0.5, -0.25}));
  EXPECT_EQ(read[0].speed, 1);
}

}  // namespace
}  // namespace cellmirror::dds::test
