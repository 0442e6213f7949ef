// What the monitor page is sent several times a second: the keys that docs/monitor-page.md names, whatever the cell is
// in.
#include "app/report/live_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/unit/app/live_sources.hpp"

namespace cellmirror::app {
namespace {

using nlohmann::json;
using testing::ElementsAre;

constexpr Timestamp kNow{10'000'000'000};

// The small cell, whose one robot is simulated, and nothing else known.
class LiveDocument : public testing::Test {
 protected:
  LiveDocument() {
    gateway_.small.cell.robots.front().min_range = {};
    gateway_.small.cell.robots.front().max_range = {};
    gateway_.robots[0].joints[0].name = "J_1";
    gateway_.robots[0].joints[0].position = 0.25;
    gateway_.small.display.cameras.emplace_back().name = "CAM";
  }

  [[nodiscard]] json document() {
    LiveSources sources = gateway_.sources(kNow);
    sources.picture_updates = 100;
    sources.proximity = proximity_;
    sources.ranges = ranges_;
    sources.forces = forces_;
    sources.queues = queues_;
    return json::parse(live_document(sources, window_, 7));
  }

  SmallGateway gateway_;
  std::shared_ptr<ProximityState> proximity_;
  std::shared_ptr<RangeReadings> ranges_;
  std::shared_ptr<ForceState> forces_;
  std::vector<engine::QueueStatus> queues_;
  LoopWindow window_;
};

TEST_F(LiveDocument, HasEveryDocumentedKeyWhereNothingIsKnown) {
  const json sut = document();
  for (const char* key : {"time_s",
                          "uptime_s",
                          "cell",
                          "instance",
                          "revision",
                          "tree_revision",
                          "loop",
                          "robots",
                          "touching",
                          "touching_count",
                          "near",
                          "near_count",
                          "warning_distance_m",
                          "collision_age_s",
                          "ranges",
                          "light_barriers",
                          "forces",
                          "programs",
                          "deadlock",
                          "queues",
                          "messages",
                          "bell",
                          "display",
                          "cameras",
                          "tissue",
                          "volumes"})
    EXPECT_TRUE(sut.contains(key)) << key;
  EXPECT_EQ(sut["cell"], "small");
  EXPECT_EQ(sut["uptime_s"], 12.5);
  EXPECT_EQ(sut["tree_revision"], 7);
  EXPECT_THAT(sut["cameras"], ElementsAre("CAM"));
  for (const char* key : {"near", "ranges", "forces", "programs", "queues", "messages"})
    EXPECT_EQ(sut[key], json::array()) << key;
  for (const char* key : {"touching", "collision_age_s", "tissue"}) EXPECT_TRUE(sut[key].is_null()) << key;
  EXPECT_EQ(sut["deadlock"], "");
}

TEST_F(LiveDocument, ASimulatedRobotHasNoAge) {
  gateway_.picture.active_robot = "ARM";
  gateway_.tick.robots[0].motion.moving = true;
  const json sut = document()["robots"][0];
  EXPECT_EQ(sut["id"], "ARM");
  EXPECT_EQ(sut["mode"], "simulated");
  EXPECT_EQ(sut["state"], "off");
  EXPECT_TRUE(sut["age_s"].is_null());
  EXPECT_EQ(sut["active"], true);
  EXPECT_EQ(sut["moving"], true);
  EXPECT_EQ(sut["joints"][0]["position"], 0.25);
  EXPECT_EQ(sut["joints"][0]["unit"], "rad");
}

TEST_F(LiveDocument, AMirroredRobotTellsItsStateAndAge) {
  gateway_.robots[0].online = true;
  gateway_.robots[0].state = DataState::stale;
  gateway_.tick.robots[0].receive_time = kNow - Nanoseconds(1'500'000'000);
  json sut = document()["robots"][0];
  EXPECT_EQ(sut["mode"], "mirrored");
  EXPECT_EQ(sut["state"], "stale");
  EXPECT_DOUBLE_EQ(sut["age_s"], 1.5);
  gateway_.tick.robots[0].receive_time = {};  // online, but nothing has come yet
  sut = document()["robots"][0];
  EXPECT_TRUE(sut["age_s"].is_null());
}

TEST_F(LiveDocument, AnImplausibleRobotTellsWhichJointWhyAndByWhichBound) {
  gateway_.robots[0].online = true;
  gateway_.robots[0].state = gateway_.robots[0].joints[0].state = DataState::implausible;
  engine::RobotTickState& tick = gateway_.tick.robots[0];
  const auto condition = [&](Implausibility why, double value, double bound) {
    tick.newest_implausible = {.why = why, .joint = 0, .value = value, .bound = bound, .receive_time = kNow};
    return document()["robots"][0]["condition"];
  };
  EXPECT_EQ(condition(Implausibility::position, 51471.0, 3.3), "implausible: J_1 is at 51471 rad, beyond 3.3 rad");
  EXPECT_EQ(condition(Implausibility::velocity, -12.0, 3.0), "implausible: J_1 moves at -12 rad/s, beyond 3 rad/s");
  EXPECT_EQ(condition(Implausibility::acceleration, 40.0, 30.0),
            "implausible: J_1 accelerates by 40 rad/s2, beyond 30 rad/s2");
  EXPECT_EQ(condition(Implausibility::frozen, 2.5, 2.0), "implausible: J_1 is the same to the last bit for 2.5 s");
  EXPECT_EQ(document()["robots"][0]["state"], "implausible");
  gateway_.robots[0].joints[0].state = DataState::fresh;
  EXPECT_EQ(document()["robots"][0]["condition"], "");
}

TEST_F(LiveDocument, AJointHasLimitsWhereItsRangeIsOne) {
  CompiledRobot& robot = gateway_.small.cell.robots.front();
  json sut = document()["robots"][0]["joints"][0];
  EXPECT_TRUE(sut["lower"].is_null());
  robot.min_range[0] = -1;
  robot.max_range[0] = 2;
  sut = document()["robots"][0]["joints"][0];
  EXPECT_EQ(sut["lower"], -1.0);
  EXPECT_EQ(sut["upper"], 2.0);
  gateway_.robots[0].joints[0].kind = JointKind::continuous;
  EXPECT_TRUE(document()["robots"][0]["joints"][0]["lower"].is_null());
  gateway_.robots[0].joints[0].kind = JointKind::prismatic;
  EXPECT_EQ(document()["robots"][0]["joints"][0]["unit"], "m");
}

TEST_F(LiveDocument, WhatJsonCannotHoldIsNullOrReplaced) {
  gateway_.robots[0].joints[0].position = std::numeric_limits<double>::quiet_NaN();
  gateway_.robots[0].joints[0].velocity = -std::numeric_limits<double>::infinity();
  gateway_.robots[0].joints[0].name = "a\"\\\n\x01\xFF";
  gateway_.small.display.messages.push_back({"\xC3\x28 </script>", kNow - Nanoseconds(2'000'000'000), 3, true});
  const json sut = document();
  EXPECT_TRUE(sut["robots"][0]["joints"][0]["position"].is_null());
  EXPECT_TRUE(sut["robots"][0]["joints"][0]["velocity"].is_null());
  EXPECT_EQ(sut["robots"][0]["joints"][0]["name"].get<std::string>().substr(0, 4), "a\"\\\n");
  EXPECT_EQ(sut["messages"][0]["number"], 3);
  EXPECT_EQ(sut["messages"][0]["bell"], true);
  EXPECT_EQ(sut["messages"][0]["age_s"], 2.0);
}

TEST_F(LiveDocument, PairsAreBoundedAndCounted) {
  proximity_ = std::make_shared<ProximityState>();
  proximity_->names = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"Arm.J_1", "Table"});
  proximity_->pairs = 200;
  proximity_->touching.resize(70);
  proximity_->near.resize(60);
  proximity_->near[0].b = 1;
  proximity_->near[0].distance_m = 0.25;
  proximity_->near[0].time_to_contact_s = 1.5;
  proximity_->near[1].b = 99;  // a name that is not there
  for (std::size_t i = 0; i < 55; ++i) proximity_->near[i].within_warning = true;
  const json sut = document();
  EXPECT_EQ(sut["touching"].size(), 50U);
  EXPECT_EQ(sut["touching_count"], 70);
  EXPECT_EQ(sut["near"].size(), 50U);
  EXPECT_EQ(sut["near_count"], 60);
  EXPECT_EQ(sut["within_warning_count"], 55) << "also those that are left out";
  EXPECT_EQ(sut["warning_distance_m"], 0.05);
  EXPECT_EQ(sut["near"][0]["a"], "Arm.J_1");
  EXPECT_EQ(sut["near"][0]["b"], "Table");
  EXPECT_EQ(sut["near"][0]["a_short"], "Arm.J_1") << "none is known";
  EXPECT_EQ(sut["near"][1]["b_short"], "");
  EXPECT_EQ(sut["near"][0]["distance_m"], 0.25);
  EXPECT_EQ(sut["near"][0]["time_to_contact_s"], 1.5);
  EXPECT_EQ(sut["near"][1]["b"], "");
  EXPECT_TRUE(sut["near"][1]["time_to_contact_s"].is_null());
  proximity_->short_names =
      std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"Arm", "Table.top"});
  EXPECT_EQ(document()["near"][0]["b_short"], "Table.top");
  EXPECT_EQ(document()["touching"][0]["a_short"], "Arm");
}

TEST_F(LiveDocument, NobodyKnowsWhatTouchesWhereNothingIsTested) {
  proximity_ = std::make_shared<ProximityState>();
  proximity_->posture_time = kNow - Nanoseconds(1'500'000'000);
  proximity_->pairs = 3;
  proximity_->near.resize(1);
  json sut = document();
  EXPECT_EQ(sut["touching"], json::array());
  EXPECT_EQ(sut["collision_age_s"], 1.5);
  collision::Settings off;
  off.active = false;
  off.warning_distance_m = 0.25;
  gateway_.picture.collision = std::make_shared<const collision::Settings>(off);
  sut = document();
  EXPECT_TRUE(sut["touching"].is_null());
  EXPECT_TRUE(sut["collision_age_s"].is_null());
  EXPECT_EQ(sut["near"], json::array());
  EXPECT_EQ(sut["near_count"], 0);
  EXPECT_EQ(sut["warning_distance_m"], 0.25);
  gateway_.picture.collision = std::make_shared<const collision::Settings>();
  proximity_->pairs = 0;
  EXPECT_TRUE(document()["touching"].is_null());
}

TEST_F(LiveDocument, RangesAndForcesTellWhatIsNotKnown) {
  ranges_ = std::make_shared<RangeReadings>();
  ranges_->readings.resize(2);
  ranges_->readings[0].id = "USS";
  ranges_->readings[0].range_m = 1.5;
  ranges_->readings[1].distance_m = 0.5;
  ranges_->readings[1].object = "Table";
  ranges_->readings[1].short_object = "T";
  ranges_->readings[1].in_blind_zone = true;
  ranges_->readings[1].doubtful = true;
  ranges_->barriers.resize(1);
  ranges_->barriers[0].name = "gate";
  ranges_->barriers[0].interrupted = true;
  ranges_->barriers[0].interruptions = 2;
  ranges_->barriers[0].object = "Table";
  forces_ = std::make_shared<ForceState>();
  forces_->robots.resize(2);
  forces_->robots[0].id = "ARM";
  forces_->robots[0].tcp_known = true;
  forces_->robots[0].tcp_T.force = {1, 2, 3};
  forces_->robots[0].joints.resize(2);
  forces_->robots[0].joints[1].kind = JointKind::prismatic;
  forces_->robots[0].joints[1].max_effort = 80;
  const json sut = document();
  EXPECT_TRUE(sut["ranges"][0]["distance_m"].is_null());
  EXPECT_EQ(sut["ranges"][0]["range_m"], 1.5);
  EXPECT_EQ(sut["ranges"][0]["object_short"], "");
  EXPECT_EQ(sut["ranges"][1]["object_short"], "T");
  EXPECT_EQ(sut["ranges"][1]["distance_m"], 0.5);
  for (const char* key : {"in_blind_zone", "doubtful"}) {
    EXPECT_EQ(sut["ranges"][0][key], false) << key;
    EXPECT_EQ(sut["ranges"][1][key], true) << key;
  }
  EXPECT_EQ(sut["light_barriers"][0]["name"], "gate");
  EXPECT_EQ(sut["light_barriers"][0]["interrupted"], true);
  EXPECT_EQ(sut["light_barriers"][0]["interruptions"], 2);
  EXPECT_EQ(sut["light_barriers"][0]["object_short"], "Table");
  EXPECT_THAT(sut["forces"][0]["tcp_force_n"], ElementsAre(1.0, 2.0, 3.0));
  EXPECT_TRUE(sut["forces"][1]["tcp_force_n"].is_null());
  EXPECT_EQ(sut["forces"][0]["joints"][0]["unit"], "Nm");
  EXPECT_TRUE(sut["forces"][0]["joints"][0]["max_effort"].is_null());
  EXPECT_EQ(sut["forces"][0]["joints"][1]["unit"], "N");
  EXPECT_EQ(sut["forces"][0]["joints"][1]["max_effort"], 80.0);
}

TEST_F(LiveDocument, ProgramsAreBounded) {
  gateway_.picture.programs.programs.resize(60);
  program::ProgramStatus& status = gateway_.picture.programs.programs.front();
  status.robot = "ARM";
  status.name = "weld";
  status.direction = program::Direction::backward;
  status.expected_s = 4.5;
  const json sut = document()["programs"];
  EXPECT_EQ(sut.size(), 50U);
  EXPECT_EQ(sut[0]["program"], "weld");
  EXPECT_EQ(sut[0]["state"], "loaded");
  EXPECT_EQ(sut[0]["direction"], "backward");
  EXPECT_EQ(sut[0]["expected_s"], 4.5);
  EXPECT_TRUE(sut[1]["expected_s"].is_null());
}

TEST_F(LiveDocument, ViewsAreWhereTheyAreNowUnderTheNamesOfTheLayout) {
  DisplayView& shown = gateway_.small.display.views[2];
  ViewSequence sequence;
  sequence.from.viewpoint = {0, 0, 0};
  sequence.to.viewpoint = {8, 0, 0};
  sequence.first_step = 75;
  sequence.steps = 100;
  shown.view = sequence.to;
  shown.sequence = sequence;
  gateway_.small.display.layout.views[2].name = "gate";
  gateway_.small.display.layout.displays[3] = {"yard", {{.view = 5}, {.view = 2}}};
  gateway_.small.display.display = 4;
  const json sut = document()["display"];
  EXPECT_EQ(sut["display"], 4);
  EXPECT_EQ(sut["views"].size(), kViews);
  EXPECT_EQ(sut["views"][2]["name"], "gate");
  EXPECT_THAT(sut["views"][2]["viewpoint_m"], ElementsAre(2.0, 0.0, 0.0)) << "a quarter of the way";
  EXPECT_EQ(sut["views"][2]["moving"], true);
  EXPECT_EQ(sut["views"][3]["moving"], false);
  EXPECT_EQ(sut["displays"].size(), kDisplays);
  EXPECT_EQ(sut["displays"][3], (json{{"id", 4}, {"name", "yard"}, {"views", {5, 2}}}));
  EXPECT_EQ(sut["displays"][1]["views"], json({1, 2}));
  EXPECT_EQ(sut["modes"].size(), kDisplayModes + 1);
}

TEST_F(LiveDocument, CamerasAreNamedAsTheDisplayNamesThem) {
  gateway_.small.display.cameras[0].name = "Left.CAM";
  gateway_.small.display.cameras.emplace_back().name = "Right.CAM";
  EXPECT_THAT(document()["cameras"], ElementsAre("Left.CAM", "Right.CAM"));
}

TEST_F(LiveDocument, QueuesTellTheirDrops) {
  queues_ = {{"commands", 64, 12, 1000, 3}};
  EXPECT_EQ(document()["queues"][0],
            (json{{"name", "commands"}, {"dropped", 3}, {"high_water", 12}, {"capacity", 64}}));
}

TEST_F(LiveDocument, TheLoopsFiguresAreThoseSinceTheDocumentBefore) {
  for (int i = 0; i < 50; ++i) gateway_.loop.wakeup_latency().record(Nanoseconds(2'000'000));
  json sut = document()["loop"];
  EXPECT_EQ(sut["rate_hz"], 1000.0);
  EXPECT_NEAR(sut["latency_p99_us"], 2000, 200);
  EXPECT_EQ(sut["compute_p99_us"], 0.0);
  for (int i = 0; i < 50; ++i) gateway_.loop.wakeup_latency().record(Nanoseconds(20'000));
  EXPECT_NEAR(document()["loop"]["latency_p99_us"], 20, 2);
  EXPECT_EQ(document()["loop"]["latency_p99_us"], 0.0);
}

TEST(TreeRevision, GoesUpWhereTheTreeLooksOtherwiseAndOnlyThen) {
  TreeRevision sut;
  scene::SmallCell small;
  const auto first = std::make_shared<const CompiledCell>(small.cell);
  const std::uint64_t before = sut.of(first);
  EXPECT_EQ(sut.of(first), before);
  small.cell.revision = 2;  // something else about the cell has changed
  EXPECT_EQ(sut.of(std::make_shared<const CompiledCell>(small.cell)), before);
  small.cell.visible[scene::SmallCell::table] = 0;
  EXPECT_EQ(sut.of(std::make_shared<const CompiledCell>(small.cell)), before + 1);
  small.cell.paths = std::make_shared<std::vector<std::string>>(small.paths);
  EXPECT_EQ(sut.of(std::make_shared<const CompiledCell>(small.cell)), before + 2);
}

}  // namespace
}  // namespace cellmirror::app
