// What sensors and collision tests find, as Cyclone DDS sees it.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "cyclone_peer.hpp"
#include "drivers/dds/dds_output.hpp"
#include "own_network.hpp"
#include "waiting.hpp"

namespace cellmirror::dds::test {
namespace {

RangeReading reading(const std::string& id, std::optional<double> distance, Timestamp time) {
  RangeReading made;
  made.id = id;
  made.path = "cell." + id;
  made.posture_time = time;
  made.distance_m = distance;
  made.range_m = 3;
  made.blind_zone_m = 0.25;
  made.half_angle_rad = 0.125;
  made.X_WS.translation() = Eigen::Vector3d(1, 2, 3);
  return made;
}

ProximityState touching_state(Timestamp time) {
  ProximityState state;
  state.posture_time = state.finished = time;
  state.sequence = 1;
  state.pairs = 3;
  state.warning_distance_m = 0.05;
  state.names = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"w.A", "w.B", "w.C"});
  state.touching.resize(1);
  state.touching[0].b = 1;
  state.touching[0].point_m = {1, 2, 3};
  state.near.push_back({0, 1, 0, {1, 2, 3}, {1, 2, 3}, true, false, {}, {}});
  state.near.push_back({0, 2, 0.5, {0, 0, 0}, {0.5, 0, 0}, false, false, {}, {}});
  return state;
}

class DdsFindingsTest : public testing::Test {
 protected:
  void SetUp() override {
    auto made = make_dds_output(config_);
    ASSERT_TRUE(made) << made.error().text();
    sut_ = std::move(*made);
  }
  std::uint64_t counter(const std::string& name) const {
    const auto counters = sut_->counters();
    const auto found = std::find_if(counters.begin(), counters.end(), [&](const auto& c) { return c.first == name; });
    EXPECT_NE(found, counters.end()) << name;
    return found == counters.end() ? 0 : found->second;
  }

  DdsOutputConfig config_{.enabled = true, .domain = test_domain(2)};
  CyclonePeer peer_{test_domain(2)};
  std::unique_ptr<DdsOutput> sut_;
  SystemClock clock_;
};

TEST_F(DdsFindingsTest, RangesAreReadByBothTypesOfRos2AndHaveTheirFrames) {
  const dds_entity_t newer = peer_.range_reader("rt/cellmirror/range/USS_1", false);
  const dds_entity_t humble = peer_.range_reader("rt/cellmirror/range/USS_2", true);
  const dds_entity_t tf = peer_.tf_reader(config_.tf_topic);
  std::vector<PlainRange> ranges[2];
  std::vector<PlainTransform> transforms;
  Timestamp time;
  ASSERT_TRUE(eventually([&] {
    // The writers are made at the first reading, so the first messages may find no reader yet.
    time = clock_.now();
    sut_->publish_ranges(std::vector{reading("USS_1", 0.5, time), reading("USS_2", {}, time)},
                         RangeSendMode::one_message_a_sensor);
    for (auto& range : CyclonePeer::take_ranges(newer, false)) ranges[0].push_back(range);
    for (auto& range : CyclonePeer::take_ranges(humble, true)) ranges[1].push_back(range);
    for (auto& transform : CyclonePeer::take_transforms(tf)) transforms.push_back(transform);
    return !ranges[0].empty() && !ranges[1].empty() && !transforms.empty();
  }));
  const PlainRange& seen = ranges[0].back();
  EXPECT_EQ(seen.frame_id, "cell.USS_1/beam");
  EXPECT_EQ(seen.radiation_type, 0);
  EXPECT_EQ(seen.field_of_view, 0.25F);
  EXPECT_EQ(seen.min_range, 0.25F);
  EXPECT_EQ(seen.max_range, 3.0F);
  EXPECT_EQ(seen.range, 0.5F);
  EXPECT_EQ(seen.variance, 0.0F);
  EXPECT_GT(seen.sec, 1'600'000'000);
  EXPECT_EQ(ranges[1].back().range, std::numeric_limits<float>::infinity());
  EXPECT_EQ(ranges[1].back().frame_id, "cell.USS_2/beam");
  EXPECT_FALSE(ranges[1].back().variance);
  EXPECT_EQ(transforms[0].parent, "world");
  EXPECT_EQ(transforms[0].child, "cell.USS_1/beam");
  EXPECT_EQ(transforms[0].translation[2], 3.0);
  EXPECT_GE(counter("ranges_sent"), 2U);
  EXPECT_EQ(counter("ranges_readers"), 2U);
}

// Every robot that is told of has a topic of its own.
TEST_F(DdsFindingsTest, ForcesAtTcpsAreWrenches) {
  const dds_entity_t wrench = peer_.wrench_reader("rt/cellmirror/tcp_wrench/TOOL_1");
  ForceState state;
  state.robots.resize(2);
  state.robots[0].id = "ARM";  // nothing tells of its TCP
  state.robots[1].id = "TOOL_1";
  state.robots[1].tcp_known = true;
  state.robots[1].tcp_T = {{1, -2, 3}, {0, 0, 0.5}};
  std::vector<PlainWrench> seen;
  ASSERT_TRUE(eventually([&] {
    // The writer is made at the first force.
    state.posture_time = clock_.now();
    sut_->publish_forces(state);
    for (auto& one : CyclonePeer::take_wrenches(wrench)) seen.push_back(one);
    return !seen.empty();
  }));
  EXPECT_EQ(seen[0].frame_id, "TOOL_1/tcp");
  EXPECT_EQ(seen[0].force, (std::array<double, 3>{1, -2, 3}));
  EXPECT_EQ(seen[0].torque, (std::array<double, 3>{0, 0, 0.5}));
  EXPECT_GE(counter("wrenches_sent"), 1U);
  EXPECT_EQ(counter("wrenches_readers"), 1U);
}

TEST_F(DdsFindingsTest, WhatIsNotFiniteIsRefusedAndCounted) {
  const Timestamp time = clock_.now();
  sut_->publish_ranges(
      std::vector{reading("USS_1", std::numeric_limits<double>::quiet_NaN(), time), reading("USS_2", 1.0, time)},
      RangeSendMode::one_message_for_all);
  EXPECT_EQ(counter("ranges_refused"), 1U);
  EXPECT_EQ(counter("ranges_sent"), 1U);
}

TEST_F(DdsFindingsTest, DiagnosticsAndMarkersTellWhatTouches) {
  const dds_entity_t diagnostics = peer_.diagnostics_reader(config_.diagnostics_topic);
  const dds_entity_t markers = peer_.marker_reader(config_.markers_topic);
  ASSERT_TRUE(eventually([&] {
    return counter("diagnostics_readers") == 1 && counter("markers_readers") == 1 &&
           CyclonePeer::matched_writers(diagnostics) == 1 && CyclonePeer::matched_writers(markers) == 1;
  }));
  const Timestamp begin = clock_.now();
  sut_->publish_proximity(touching_state(begin));
  sut_->publish_ranges(std::vector{reading("USS_1", 0.5, clock_.now())}, RangeSendMode::one_message_a_sensor);
  std::vector<PlainStatus> statuses;
  std::map<std::string, PlainMarker> shown;
  ASSERT_TRUE(eventually([&] {
    for (auto& status : CyclonePeer::take_diagnostics(diagnostics)) statuses.push_back(status);
    for (auto& marker : CyclonePeer::take_markers(markers)) shown[marker.ns] = marker;
    return !statuses.empty() && shown.size() == 4;
  }));
  EXPECT_EQ(statuses[0].level, 2) << "ERROR";
  EXPECT_EQ(statuses[0].name, "cellmirror: collisions");
  EXPECT_EQ(statuses[0].message, "1 pair touches");
  EXPECT_TRUE(std::any_of(statuses[0].values.begin(), statuses[0].values.end(),
                          [](const auto& value) { return value.first == "w.A - w.B"; }));
  EXPECT_EQ(shown["contacts"].type, 7);
  EXPECT_EQ(shown["contacts"].points, (std::vector<std::array<double, 3>>{{1, 2, 3}}));
  EXPECT_EQ(shown["distances"].type, 5);
  EXPECT_EQ(shown["distances"].points.size(), 2U);
  EXPECT_EQ(shown["distances"].colours, 2U);
  EXPECT_EQ(shown["cones"].type, 11);
  EXPECT_EQ(shown["cones"].points.size(), 24U);
  for (const auto& [ns, marker] : shown) {
    EXPECT_EQ(marker.frame_id, "world") << ns;
    EXPECT_GT(marker.lifetime_sec, 0) << ns;
    EXPECT_TRUE(marker.rest_is_empty) << ns;
  }

  // The next markers are due a tenth of a second later.
  ProximityState apart = touching_state(clock_.now());
  apart.touching.clear();
  apart.near.erase(apart.near.begin());
  ASSERT_TRUE(eventually([&] {
    apart.posture_time = clock_.now();
    sut_->publish_proximity(apart);
    for (auto& marker : CyclonePeer::take_markers(markers)) shown[marker.ns] = marker;
    for (auto& status : CyclonePeer::take_diagnostics(diagnostics)) statuses.push_back(status);
    return shown["contacts"].action == 2 && statuses.back().level == 0;
  })) << "contacts are deleted, the status is OK again";
  EXPECT_LE(static_cast<double>(statuses.size()), 2 + seconds(clock_.now() - begin))
      << "a status a second, and when the level changes";
}

TEST_F(DdsFindingsTest, ManySensorsAndPairsArePublishedWithoutWaiting) {
  const dds_entity_t markers = peer_.marker_reader(config_.markers_topic);
  ASSERT_TRUE(
      eventually([&] { return counter("markers_readers") == 1 && CyclonePeer::matched_writers(markers) == 1; }));
  ProximityState state = touching_state(clock_.now());
  state.near.resize(1000, state.near.back());
  state.touching.resize(1000, state.touching.front());
  std::vector<RangeReading> readings;
  for (int i = 0; i < 64; ++i) readings.push_back(reading("USS_" + std::to_string(i), 1.0, clock_.now()));
  sut_->publish_ranges(readings, RangeSendMode::one_message_a_sensor);
  sut_->publish_proximity(state);
  std::map<std::string, PlainMarker> shown;
  EXPECT_TRUE(eventually([&] {
    for (auto& marker : CyclonePeer::take_markers(markers)) shown[marker.ns] = marker;
    return shown.size() == 4;
  }));
  EXPECT_EQ(shown["cones"].points.size(), 64U * 24U);
  std::vector<double> took_s;
  for (int i = 0; i < 50; ++i) {
    const Timestamp before = clock_.now();
    sut_->publish_ranges(readings, RangeSendMode::one_message_a_sensor);
    sut_->publish_proximity(state);
    took_s.push_back(seconds(clock_.now() - before));
  }
  std::ranges::nth_element(took_s, took_s.begin() + 25);  // the machine may stand still in some of them
  EXPECT_LT(took_s[25], 2.0) << "publishing waited: 64 writers, each of which may wait 0.1 s by DDS's default";
  EXPECT_EQ(counter("ranges_sent"), 51U * 64U);
}

// The topic is made with the first shapes; the next ones are wanted while it has readers.
TEST_F(DdsFindingsTest, DeformableObjectsAreTrianglesAndForcesOnThemArrows) {
  TissueView view;
  view.surfaces.resize(1);
  auto topology = std::make_shared<TissueTopology>();
  for (std::uint32_t i = 0; i < 9'000; ++i) {
    topology->triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    const auto at = static_cast<float>(i);
    view.surfaces[0].vertices.insert(view.surfaces[0].vertices.end(), {{at, 0, 0}, {at, 1, 0}, {at, 0, 0.5F}});
  }
  view.surfaces[0].topology = topology;
  const std::vector<TissueForceArrow> forces = {{"GRASPER", {1, 2, 3}, {0, 0, 5}}};
  EXPECT_EQ(sut_->tissue_period(), Nanoseconds(500'000'000)) << "wanted before anybody can read it";
  sut_->publish_tissue_shapes(clock_.now(), view, forces);
  EXPECT_EQ(sut_->tissue_period(), Nanoseconds(0)) << "nobody reads it";
  const dds_entity_t tissue = peer_.marker_reader(config_.tissue_topic);
  ASSERT_TRUE(eventually([&] { return sut_->tissue_period() == Nanoseconds(500'000'000); }));
  std::map<std::string, PlainMarker> shown;
  ASSERT_TRUE(eventually([&] {
    sut_->publish_tissue_shapes(clock_.now(), view, forces);
    for (auto& marker : CyclonePeer::take_markers(tissue)) shown[marker.ns] = marker;
    return shown.size() == 2;
  }));
  EXPECT_EQ(shown["tissue"].type, 11);
  ASSERT_EQ(shown["tissue"].points.size(), 27'000U);
  EXPECT_EQ(shown["tissue"].points.back(), (std::array<double, 3>{8999, 0, 0.5}));
  EXPECT_EQ(shown["tissue_forces"].type, 0);
  EXPECT_EQ(shown["tissue_forces"].points, (std::vector<std::array<double, 3>>{{1, 2, 3}, {1, 2, 3.1}}));
  for (const auto& [ns, marker] : shown) {
    EXPECT_EQ(marker.frame_id, "world") << ns;
    EXPECT_GT(marker.lifetime_sec, 0) << ns;
    EXPECT_TRUE(marker.rest_is_empty) << ns;
  }
  EXPECT_GE(counter("tissue_sent"), 2U);
  EXPECT_EQ(counter("tissue_readers"), 1U);
}

TEST_F(DdsFindingsTest, TopicsMayBeSwitchedOff) {
  config_.range_topic_prefix = config_.diagnostics_topic = config_.markers_topic = config_.tissue_topic = "";
  const auto quiet = make_dds_output(config_);
  ASSERT_TRUE(quiet) << quiet.error().text();
  (*quiet)->publish_ranges(std::vector{reading("USS_1", 1.0, clock_.now())}, RangeSendMode::one_message_a_sensor);
  (*quiet)->publish_proximity(touching_state(clock_.now()));
  EXPECT_EQ((*quiet)->tissue_period(), Nanoseconds(0));
  (*quiet)->publish_tissue_shapes(clock_.now(), TissueView{}, {});
  for (const auto& [name, value] : (*quiet)->counters()) {
    if (name == "ranges_sent" || name == "ranges_refused") {
      EXPECT_EQ(value, 0U) << name;
    }
    EXPECT_FALSE(name.starts_with("markers") || name.starts_with("diagnostics") || name.starts_with("tissue")) << name;
  }
}

}  // namespace
}  // namespace cellmirror::dds::test
