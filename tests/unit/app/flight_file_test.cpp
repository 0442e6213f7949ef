#include "app/io/flight_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cellmirror::app {
namespace {

class FlightFile : public testing::Test {
 protected:
  FlightFile() : folder_(std::filesystem::temp_directory_path() / ("cellmirror-flight-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~FlightFile() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::vector<nlohmann::json> lines() const {
    std::vector<nlohmann::json> out;
    std::ifstream in(folder_ / "f.jsonl");
    for (std::string line; std::getline(in, line);) out.push_back(nlohmann::json::parse(line));
    return out;
  }

  std::filesystem::path folder_;
};

TEST_F(FlightFile, HoldsAHeaderThenTicksThenRobotsAsOneJsonDocumentALine) {
  engine::FlightTick tick;
  tick.tick = 7;
  tick.time = Timestamp{1'000'000};
  tick.wakeup_latency_ns = 12'345;
  engine::FlightRobot robot;
  robot.tick = 7;
  robot.slot = 1;
  robot.joint_count = 2;
  robot.position = {0.25F, -1.5F};
  robot.event = engine::FlightEvent::setpoint;
  ASSERT_TRUE(write_flight_file(folder_ / "f.jsonl", {"request", "a \"cell\"", "default", 1000, {"A", "B\xff"}}, {tick},
                                {robot}));
  const auto read = lines();
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[0]["kind"], "header");
  EXPECT_EQ(read[0]["cell"], "a \"cell\"");
  EXPECT_DOUBLE_EQ(read[1]["wakeup_latency_us"].get<double>(), 12.345);
  EXPECT_EQ(read[2]["event"], "setpoint");
  EXPECT_DOUBLE_EQ(read[2]["position"][1].get<double>(), -1.5);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "f.jsonl.part"));
}

TEST_F(FlightFile, FailsWithTheReasonWhereTheFolderIsMissing) {
  const auto result = write_flight_file(folder_ / "missing" / "f.jsonl", {}, {}, {});
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().what.find("No such file"), std::string::npos);
}

}  // namespace
}  // namespace cellmirror::app
