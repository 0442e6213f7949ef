// What becomes of readings and of what touches: messages, markers, diagnostics.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "drivers/dds/findings_markers.hpp"
#include "drivers/dds/proximity_diagnostics.hpp"
#include "drivers/dds/sensor_ranges.hpp"

namespace cellmirror::dds::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

RangeReading reading(std::optional<double> distance) {
  RangeReading made;
  made.id = "USS_1B";
  made.path = "cell.robot.USS_1B";
  made.distance_m = distance;
  made.range_m = 3;
  made.blind_zone_m = 0.25;
  made.half_angle_rad = 0.125;
  if (distance) made.point_m = {1, 2, 3};
  return made;
}

TEST(RangeTopic, IsTheIdWhereRosAllowsIt) {
  EXPECT_EQ(range_topic("rt/cellmirror/range", "USS_1B"), "rt/cellmirror/range/USS_1B");
  EXPECT_EQ(range_topic("p", "a"), "p/a");
}

TEST(RangeTopic, OtherIdsGetANumberOfTheirOwn) {
  const std::string dash = range_topic("p", "USS-1");
  const std::string slash = range_topic("p", "USS/1");
  EXPECT_TRUE(dash.starts_with("p/USS_1_")) << dash;
  EXPECT_TRUE(slash.starts_with("p/USS_1_")) << slash;
  EXPECT_NE(dash, slash);
  EXPECT_NE(dash, "p/USS_1") << "a sensor of that name may exist";
  EXPECT_TRUE(range_topic("p", "5").starts_with("p/uss_5_"));
  for (const char* id : {"5", "", "__", "_a", "a__b", "\xC3\xA9", "x y", "a_"}) {
    const std::string topic = range_topic("p", id);
    EXPECT_EQ(topic.find("__"), std::string::npos) << topic;
    EXPECT_TRUE(std::isalpha(static_cast<unsigned char>(topic.at(2)))) << topic;
    EXPECT_EQ(topic.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_", 2),
              std::string::npos)
        << topic;
  }
}

TEST(RangeMessage, TellsTheDistance) {
  Range sut;
  ASSERT_TRUE(fill_range({1, 2}, reading(0.5), sut));
  EXPECT_EQ(sut.header.stamp, (RosTime{1, 2}));
  EXPECT_EQ(sut.header.frame_id, "cell.robot.USS_1B/beam");
  EXPECT_EQ(sut.radiation_type, 0);
  EXPECT_EQ(sut.field_of_view, 0.25F);
  EXPECT_EQ(sut.min_range, 0.25F);
  EXPECT_EQ(sut.max_range, 3.0F);
  EXPECT_EQ(sut.range, 0.5F);
  EXPECT_EQ(sut.variance, 0.0F);
}

TEST(RangeMessage, NothingAndTooNearAreInfiniteAsRep117Says) {
  Range sut;
  ASSERT_TRUE(fill_range({}, reading({}), sut));
  EXPECT_EQ(sut.range, std::numeric_limits<float>::infinity());
  RangeReading near = reading(0.1);
  near.in_blind_zone = true;
  ASSERT_TRUE(fill_range({}, near, sut));
  EXPECT_EQ(sut.range, -std::numeric_limits<float>::infinity());
  RangeReading doubtful = reading({});
  doubtful.doubtful = true;
  ASSERT_TRUE(fill_range({}, doubtful, sut));
  EXPECT_TRUE(std::isnan(sut.range)) << "never free";
}

TEST(RangeMessage, RoundingDoesNotCarryAReadingBeyondTheRange) {
  RangeReading far = reading(0.3);
  far.range_m = 0.3;
  far.distance_m = std::nextafter(0.3, 1.0);
  Range sut;
  ASSERT_TRUE(fill_range({}, far, sut));
  EXPECT_LE(sut.range, sut.max_range);
}

TEST(RangeMessage, WhatIsNotFiniteIsNone) {
  Range sut;
  EXPECT_FALSE(fill_range({}, reading(kNaN), sut));
  RangeReading wrong = reading(1.0);
  wrong.half_angle_rad = kNaN;
  EXPECT_FALSE(fill_range({}, wrong, sut));
}

TEST(BeamFrame, LooksAlongItsXAxisWhereTheSensorLooksAlongZ) {
  RangeReading tilted = reading({});
  tilted.X_WS = pose_from_xyz_rpy({1, 2, 3}, {0.4, -0.7, 2.0});
  const FramePose sut = beam_frame_pose(tilted);
  EXPECT_EQ(sut.parent, "world");
  EXPECT_EQ(sut.child, "cell.robot.USS_1B/beam");
  const auto& X_WB = sut.X_PC.matrix();
  const auto& X_WS = tilted.X_WS.matrix();
  for (int row = 0; row < 3; ++row) {
    EXPECT_NEAR(X_WB(row, 3), X_WS(row, 3), 1e-12);
    EXPECT_NEAR(X_WB(row, 0), X_WS(row, 2), 1e-12) << "x is the sensor's z";
    EXPECT_NEAR(X_WB(row, 1), X_WS(row, 1), 1e-12);
    EXPECT_NEAR(X_WB(row, 2), -X_WS(row, 0), 1e-12) << "right-handed";
  }
}

ProximityState state_of(Timestamp time) {
  ProximityState state;
  state.posture_time = state.finished = time;
  state.names = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"A", "B", "C"});
  state.warning_distance_m = 0.05;
  state.pairs = 3;
  state.near.push_back({0, 2, 0.5, {0, 0, 0}, {0.5, 0, 0}, false, false, {}, {}});
  return state;
}

void add_touch(ProximityState& state) {
  TouchingPair pair;
  pair.b = 1;
  pair.depth_m = 0.01;
  pair.point_m = {1, 1, 1};
  pair.points.resize(2);
  state.touching.push_back(pair);
  state.near.insert(state.near.begin(), NearPair{0, 1, 0, {1, 1, 1}, {1, 1, 1}, true, false, {}, {}});
}

const Timestamp kNow{5'000'000'000};

std::string value(const DiagnosticStatus& status, const std::string& key) {
  for (const KeyValue& entry : status.values) {
    if (entry.key == key) return entry.value;
  }
  return "no such value";
}

TEST(CollisionStatus, SaysHowBadItIs) {
  ProximityState state = state_of(kNow);
  EXPECT_EQ(collision_status(state, kNow).level, DiagnosticLevel::ok);
  EXPECT_EQ(collision_status(state, kNow).message, "nothing within 0.050 m");
  EXPECT_EQ(value(collision_status(state, kNow), "smallest distance [m]"), "0.5000");

  state.near.front().within_warning = true;
  EXPECT_EQ(collision_status(state, kNow).level, DiagnosticLevel::warn);
  EXPECT_EQ(collision_status(state, kNow).message, "1 pair within 0.050 m");

  state.near.front().closing_speed_m_s = 0.25;
  state.near.front().time_to_contact_s = 2;
  EXPECT_EQ(value(collision_status(state, kNow), "A - C"), "0.5000 m, closing at 0.250 m/s, contact in 2.00 s");

  add_touch(state);
  const DiagnosticStatus touching = collision_status(state, kNow);
  EXPECT_EQ(touching.level, DiagnosticLevel::error);
  EXPECT_EQ(touching.message, "1 pair touches");
  EXPECT_EQ(value(touching, "touching pairs"), "1");
  EXPECT_EQ(value(touching, "pairs within warning distance"), "1") << "those that touch are counted alone";
  EXPECT_EQ(value(touching, "A - B"), "touching, depth 0.0100 m at (1.0000, 1.0000, 1.0000) m");
  EXPECT_EQ(value(touching, "smallest distance [m]"), "0.0000");

  const DiagnosticStatus old = collision_status(state, kNow + 2 * kFindingsStaleAfter);
  EXPECT_EQ(old.level, DiagnosticLevel::stale);
  EXPECT_EQ(old.message, "the last result is 1.0 s old");
}

TEST(CollisionStatus, ADoubtIsNeverOk) {
  ProximityState state = state_of(kNow);
  state.doubts = {"A and B: no way of telling"};
  EXPECT_EQ(collision_status(state, kNow).level, DiagnosticLevel::warn);
  EXPECT_EQ(value(collision_status(state, kNow), "doubt"), "A and B: no way of telling");
  state.doubts.clear();
  state.near.front().doubtful = true;
  EXPECT_EQ(collision_status(state, kNow).level, DiagnosticLevel::warn);
}

TEST(CollisionStatus, NamesABoundedNumberOfPairs) {
  ProximityState state = state_of(kNow);
  state.near.resize(1000, state.near.front());
  state.doubts.resize(1000, "d");
  EXPECT_LT(collision_status(state, kNow).values.size(), 8 + 2 * kPairsInDiagnostics);
}

TEST(CollisionStatus, ACellWithoutPairsIsOk) {
  ProximityState empty;
  empty.posture_time = kNow;
  EXPECT_EQ(collision_status(empty, kNow).level, DiagnosticLevel::ok);
}

TEST(ProximityMarkers, DrawDistancesAndContacts) {
  ProximityState state = state_of(kNow);
  add_touch(state);
  state.near.push_back({1, 2, 0.7, {kNaN, 0, 0}, {0, 0, 0}, false, false, {}, {}});
  MarkerArray sut;
  fill_proximity_markers({1, 2}, state, sut);
  ASSERT_EQ(sut.markers.size(), 2U);
  const Marker& lines = sut.markers[0];
  EXPECT_EQ(lines.header.frame_id, "world");
  EXPECT_EQ(lines.ns, "distances");
  EXPECT_EQ(lines.type, MarkerType::line_list);
  EXPECT_EQ(lines.points, (std::vector<MarkerPoint>{{0, 0, 0}, {0.5, 0, 0}})) << "neither what touches nor NaN";
  EXPECT_EQ(lines.colours.size(), 2U);
  EXPECT_GT(lines.lifetime_ns, 0);
  const Marker& contacts = sut.markers[1];
  EXPECT_EQ(contacts.ns, "contacts");
  EXPECT_EQ(contacts.type, MarkerType::sphere_list);
  EXPECT_EQ(contacts.points.size(), 2U);

  state.near.resize(2000, state.near[1]);
  state.touching.resize(2000, state.touching.front());
  fill_proximity_markers({1, 2}, state, sut);
  EXPECT_EQ(sut.markers[0].points.size(), 2 * kMaxDrawnPairs);
  EXPECT_EQ(sut.markers[1].points.size(), kMaxDrawnContacts);
}

TEST(RangeMarkers, DrawConesAsLongAsTheReading) {
  RangeReading seen = reading(2.0);
  seen.X_WS = pose_from_xyz_rpy({1, 0, 0}, {0, 0, 0});
  RangeReading blind = reading(0.1);
  blind.in_blind_zone = true;
  const std::vector<RangeReading> readings = {seen, reading({}), blind, reading(kNaN)};
  MarkerArray sut;
  fill_range_markers({1, 2}, readings, sut);
  ASSERT_EQ(sut.markers.size(), 4U);
  for (int i = 0; i < 3; ++i) {
    const Marker& cone = sut.markers[static_cast<std::size_t>(i)];
    EXPECT_EQ(cone.ns, "cones");
    EXPECT_EQ(cone.id, i);
    EXPECT_EQ(cone.type, MarkerType::triangle_list);
    ASSERT_EQ(cone.points.size() % 3, 0U);
    const MarkerPoint& apex = cone.points[0];
    const double length = i == 0 ? 2.0 : i == 1 ? 3.0 : 0.1;
    for (std::size_t p = 0; p < cone.points.size(); ++p) {
      const MarkerPoint& point = cone.points[p];
      if (p % 3 == 0) {
        EXPECT_EQ(point, apex);
      } else {
        EXPECT_NEAR(std::hypot(point[0] - apex[0], point[1] - apex[1], point[2] - apex[2]), length, 1e-12);
        EXPECT_NEAR(point[2] - apex[2], length * std::cos(0.125), 1e-12);
      }
    }
    EXPECT_EQ(apex[0], i == 0 ? 1.0 : 0.0);
  }
  EXPECT_EQ(sut.markers[3].ns, "echoes");
  EXPECT_EQ(sut.markers[3].points.size(), 2U);

  RangeReading doubtful = reading({});
  doubtful.doubtful = true;
  fill_range_markers({1, 2}, std::span(&doubtful, 1), sut);
  ASSERT_EQ(sut.markers.size(), 1U);
  EXPECT_EQ(sut.markers[0].id, 2) << "red";
}

TEST(ShownMarkersTest, RemoveWhatIsGoneOnce) {
  ShownMarkers sut;
  MarkerArray message;
  message.markers = {Marker{.ns = "a", .id = 1}, Marker{.ns = "b", .id = 2}};
  sut.update(message);
  EXPECT_EQ(message.markers.size(), 2U);
  message.markers = {Marker{.ns = "a", .id = 1}};
  sut.update(message);
  ASSERT_EQ(message.markers.size(), 2U);
  EXPECT_EQ(message.markers[1].ns, "b");
  EXPECT_EQ(message.markers[1].id, 2);
  EXPECT_EQ(message.markers[1].action, MarkerAction::remove);
  message.markers = {Marker{.ns = "a", .id = 1}};
  sut.update(message);
  EXPECT_EQ(message.markers.size(), 1U);
  message.markers.clear();
  sut.update(message);
  EXPECT_EQ(message.markers.size(), 1U);
}

}  // namespace
}  // namespace cellmirror::dds::test
