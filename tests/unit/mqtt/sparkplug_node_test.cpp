#include "drivers/mqtt/sparkplug_node.hpp"

#include <gtest/gtest.h>

namespace cellmirror::mqtt {
namespace {

// By hand from section 6.4 of the specification and the encoding of protobuf.
TEST(SparkplugPayload, HasTheBytesOfTheSpecification) {
  const std::string bytes = encode({.time_ms = 1,
                                    .seq = 0,
                                    .metrics = {{"bdSeq", SparkplugType::int64, std::int64_t{5}},
                                                {"A", SparkplugType::boolean, true},
                                                {"B", SparkplugType::text, std::string("x")},
                                                {"C", SparkplugType::float64, 1.0},
                                                {"D", SparkplugType::float64, {}}}});
  using namespace std::string_literals;
  EXPECT_EQ(bytes,
            "\x08\x01"s  // timestamp
            "\x12\x0D\x0A\x05"
            "bdSeq"
            "\x18\x01\x20\x04\x58\x05"s  // long_value
            "\x12\x09\x0A\x01"
            "A"
            "\x18\x01\x20\x0B\x70\x01"s  // boolean_value
            "\x12\x0A\x0A\x01"
            "B"
            "\x18\x01\x20\x0C\x7A\x01"
            "x"s  // string_value
            "\x12\x10\x0A\x01"
            "C"
            "\x18\x01\x20\x0A\x69\0\0\0\0\0\0\xF0\x3F"s  // double_value
            "\x12\x09\x0A\x01"
            "D"
            "\x18\x01\x20\x0A\x38\x01"s  // is_null
            "\x18\x00"s);                // seq
}

TEST(SparkplugPayload, ACommandAsksForRebirthOrNot) {
  using namespace std::string_literals;
  const auto command = [](const std::string& name, bool value) {
    return encode({.metrics = {{name, SparkplugType::boolean, value}}});
  };
  EXPECT_TRUE(asks_for_rebirth(command("Node Control/Rebirth", true)).value());
  EXPECT_FALSE(asks_for_rebirth(command("Node Control/Rebirth", false)).value());
  EXPECT_FALSE(asks_for_rebirth(command("Node Control/Reboot", true)).value());
  EXPECT_FALSE(asks_for_rebirth("\xFF\xFF\xFF"));
  EXPECT_FALSE(asks_for_rebirth(std::string(kMostSparkplugCommandBytes + 1, '\0')));
  std::string many;
  for (std::size_t i = 0; i <= kMostSparkplugMetrics; ++i) many += "\x12\x00"s;
  EXPECT_FALSE(asks_for_rebirth(many));
}

CellSummary summary_with(const std::vector<std::string>& robots) {
  CellSummary out;
  for (const std::string& id : robots) out.robots.push_back({.id = id, .mirrored = true, .state = DataState::fresh});
  return out;
}

class Node : public testing::Test {
 protected:
  std::vector<std::string> topics() {
    std::vector<std::string> out;
    while (auto next = node_.next(7)) {
      out.push_back(next->topic);
      EXPECT_EQ(next->qos, 0);
      EXPECT_FALSE(next->retain);
      // seq is the last field: 0x18 and a varint of up to two bytes.
      const std::string& payload = next->payload;
      const bool is_long = static_cast<unsigned char>(payload[payload.size() - 1]) == 1 && payload.size() > 3 &&
                           (static_cast<unsigned char>(payload[payload.size() - 2]) & 0x80U) != 0;
      const auto low = static_cast<unsigned char>(payload[payload.size() - (is_long ? 2 : 1)]);
      numbers_.push_back(is_long ? 128 + (low & 0x7FU) : low);
    }
    return out;
  }

  SparkplugNode node_{{"hall", "n1"}, {"c1", "default", "pc", "1"}};
  std::vector<unsigned> numbers_;
};

TEST_F(Node, IsBornWithItsDevicesAndThenTellsChanges) {
  node_.see(summary_with({"R1", "R2"}));
  const Outgoing will = node_.begin_session(1);
  EXPECT_EQ(will.topic, "spBv1.0/hall/NDEATH/n1");
  EXPECT_EQ(will.qos, 1);
  EXPECT_EQ(will.payload, encode({.time_ms = 1, .metrics = {{"bdSeq", SparkplugType::int64, std::int64_t{0}}}}));
  node_.bear_again();
  EXPECT_EQ(topics(), (std::vector<std::string>{"spBv1.0/hall/NBIRTH/n1", "spBv1.0/hall/DBIRTH/n1/R1",
                                                "spBv1.0/hall/DBIRTH/n1/R2"}));
  EXPECT_TRUE(topics().empty());
  node_.see(summary_with({"R1", "R2"}));
  EXPECT_TRUE(topics().empty()) << "nothing has changed";
  CellSummary changed = summary_with({"R1", "R2"});
  changed.robots[1].state = DataState::stale;
  changed.health = CellHealth::attention;
  node_.see(changed);
  EXPECT_EQ(topics(), (std::vector<std::string>{"spBv1.0/hall/NDATA/n1", "spBv1.0/hall/DDATA/n1/R2"}));
  node_.see(summary_with({"R2"}));
  EXPECT_EQ(topics(), (std::vector<std::string>{"spBv1.0/hall/NDATA/n1", "spBv1.0/hall/DDEATH/n1/R1",
                                                "spBv1.0/hall/DDATA/n1/R2"}));
  EXPECT_EQ(numbers_, (std::vector<unsigned>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST_F(Node, LeavesOutARobotWhoseIdDiffersByCaseOnlyAndSaysSo) {
  node_.see(summary_with({"ARM", "arm", "R2"}));
  static_cast<void>(node_.begin_session(1));
  node_.bear_again();
  const std::optional<Outgoing> birth = node_.next(7);
  ASSERT_TRUE(birth);
  EXPECT_NE(birth->payload.find("arm is not sent by Sparkplug: its id differs from ARM by case only; rename"),
            std::string::npos);
  EXPECT_EQ(topics(), (std::vector<std::string>{"spBv1.0/hall/DBIRTH/n1/ARM", "spBv1.0/hall/DBIRTH/n1/R2"}));
  node_.see(summary_with({"arm", "R2"}));
  EXPECT_EQ(topics(), (std::vector<std::string>{"spBv1.0/hall/NDATA/n1", "spBv1.0/hall/DDEATH/n1/ARM",
                                                "spBv1.0/hall/DBIRTH/n1/arm"}));
}

TEST_F(Node, NumbersRunTo255AndEachSessionHasTheNextOne) {
  node_.see(summary_with({"R1"}));
  static_cast<void>(node_.begin_session(1));
  node_.bear_again();
  for (unsigned i = 0; i < 600; ++i) {
    CellSummary next = summary_with({"R1"});
    next.robots[0].age_s = i;
    node_.see(next);
    static_cast<void>(topics());
  }
  for (std::size_t i = 0; i < numbers_.size(); ++i) EXPECT_EQ(numbers_[i], i % 256) << i;
  for (std::int64_t session = 1; session < 600; ++session) {
    EXPECT_EQ(node_.asked(), (session - 1) % 256);
    EXPECT_EQ(node_.begin_session(1).payload,
              encode({.time_ms = 1, .metrics = {{"bdSeq", SparkplugType::int64, session % 256}}}));
  }
}

TEST_F(Node, ANewMetricMeansANewBirth) {
  node_.see(summary_with({"R1"}));
  static_cast<void>(node_.begin_session(1));
  node_.bear_again();
  static_cast<void>(topics());
  RobotState robot;
  robot.id = "R1";
  robot.joints.resize(1);
  robot.joints[0].name = "J1";
  node_.see(robot);
  EXPECT_EQ(topics(), std::vector<std::string>{"spBv1.0/hall/DBIRTH/n1/R1"});
  robot.joints[0].position = 1;
  node_.see(robot);
  EXPECT_EQ(topics(), std::vector<std::string>{"spBv1.0/hall/DDATA/n1/R1"});
}

TEST_F(Node, AnotherConnectionBearsEverythingAgainAndForgetsWhatIsGone) {
  node_.see(summary_with({"R1", "R2"}));
  static_cast<void>(node_.begin_session(1));
  node_.bear_again();
  static_cast<void>(topics());
  node_.disconnected();
  for (int i = 0; i < 1000; ++i) node_.see(summary_with({"R" + std::to_string(i)}));
  static_cast<void>(node_.begin_session(1));
  node_.bear_again();
  EXPECT_EQ(topics(), (std::vector<std::string>{"spBv1.0/hall/NBIRTH/n1", "spBv1.0/hall/DBIRTH/n1/R999"}));
}

TEST_F(Node, AnAttemptThatNoBrokerHeardUsesNoNumber) {
  const std::string first = node_.begin_session(1).payload;
  EXPECT_EQ(node_.begin_session(1).payload, first);
  EXPECT_EQ(node_.asked(), 0);
  EXPECT_NE(node_.begin_session(1).payload, first);
  SparkplugNode later({"hall", "n1"}, {"c1", "default", "pc", "1"}, 255);
  static_cast<void>(later.begin_session(1));
  EXPECT_EQ(later.asked(), 255);
  EXPECT_EQ(later.begin_session(1).payload, first);
}

TEST_F(Node, ARobotWhoseStreamIsLostOrOfflineIsDead) {
  CellSummary summary = summary_with({"R1", "R2"});
  for (RobotSummary& robot : summary.robots) robot.mirrored = false;
  node_.see(summary);
  static_cast<void>(node_.begin_session(1));
  node_.bear_again();
  EXPECT_EQ(topics().size(), 3U) << "simulated robots are alive";
  RobotSummary& robot = summary.robots[0];
  const auto devices = [&](bool mirrored, DataState state) {
    robot.mirrored = mirrored;
    robot.state = state;
    node_.see(summary);
    std::vector<std::string> out;
    for (const std::string& topic : topics()) {
      if (topic.find("/D") != std::string::npos) out.push_back(topic.substr(13));
    }
    return out;
  };
  using Topics = std::vector<std::string>;
  EXPECT_EQ(devices(true, DataState::none), Topics{"DDEATH/n1/R1"}) << "nothing is known yet";
  EXPECT_EQ(devices(true, DataState::fresh), Topics{"DBIRTH/n1/R1"});
  EXPECT_EQ(devices(true, DataState::stale), Topics{"DDATA/n1/R1"});
  EXPECT_EQ(devices(true, DataState::lost), Topics{"DDEATH/n1/R1"});
  EXPECT_EQ(devices(true, DataState::lost), Topics{});
  EXPECT_EQ(devices(true, DataState::fresh), Topics{"DBIRTH/n1/R1"});
  EXPECT_EQ(devices(false, DataState::none), Topics{"DDEATH/n1/R1"}) << "offline";
  node_.disconnected();
  static_cast<void>(node_.begin_session(1));
  node_.bear_again();
  EXPECT_EQ(topics(), (Topics{"spBv1.0/hall/NBIRTH/n1", "spBv1.0/hall/DBIRTH/n1/R2"})) << "it has no birth";
}

TEST_F(Node, DevicesTakeTurns) {
  node_.see(summary_with({"R1", "R2"}));
  static_cast<void>(node_.begin_session(1));
  node_.bear_again();
  static_cast<void>(topics());
  std::vector<std::string> seen;
  for (int i = 0; i < 4; ++i) {
    CellSummary next = summary_with({"R1", "R2"});
    for (RobotSummary& robot : next.robots) robot.age_s = i;
    node_.see(next);
    seen.push_back(node_.next(1)->topic.substr(22));
  }
  EXPECT_EQ(seen, (std::vector<std::string>{"R1", "R2", "R1", "R2"}));
}

}  // namespace
}  // namespace cellmirror::mqtt
