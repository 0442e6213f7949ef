// The cell for clients that draw it themselves: the message of poses byte by byte, and the service where there is no
// cell.
#include "app/render/scene_service.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cstring>
#include <future>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/render/scene_message.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/rt/watchdog.hpp"

namespace cellmirror::app {
namespace {

std::uint32_t word(const std::string& bytes, std::size_t index) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + 4 * index, 4);
  return value;
}

float number(const std::string& bytes, std::size_t index) { return std::bit_cast<float>(word(bytes, index)); }

TEST(SceneMessage, HasCountsThenNumbersThenStates) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Scene scene;
  scene.bodies.resize(2);
  scene.bodies[0].X_WG.translation() = Eigen::Vector3d(1, 2, nan);
  scene.bodies[1].mark = Mark::touching;
  scene.bodies[1].mode = DrawMode::wireframe;
  scene.lines.push_back({.from = {1, 0, 0}, .to = {0, 1, 0}, .rgba = {1, 0, 0.5F, 1}, .dashed = true, .on_top = true});
  scene.cones.push_back({Pose::Identity(), 0.5, 2, {0, 0, 1, 0.2F}});
  const std::vector<scene::CameraNow> cameras(1);
  const std::string bytes = scene_poses(scene, cameras);
  ASSERT_EQ(bytes.size(), 4U * (6 + 2 * 7 + 9 + 10 + 9) + 2);
  for (const auto& [index, count] : {std::pair(0U, 2U), {1U, 1U}, {2U, 0U}, {3U, 1U}, {4U, 0U}, {5U, 1U}})
    EXPECT_EQ(word(bytes, index), count) << index;
  EXPECT_EQ(number(bytes, 6), 1.0F);
  EXPECT_EQ(number(bytes, 7), 2.0F);
  EXPECT_EQ(number(bytes, 8), 0.0F) << "not a number";
  EXPECT_EQ(number(bytes, 12), 1.0F) << "w of the quaternion";
  const std::size_t line = 6 + 2 * 7;
  EXPECT_EQ(word(bytes, line + 7), 0xFF8000FFU);
  EXPECT_EQ(word(bytes, line + 8), 3U);
  EXPECT_EQ(number(bytes, line + 9 + 7), 0.5F) << "half angle of the cone";
  EXPECT_EQ(bytes[bytes.size() - 2], '\x00');
  EXPECT_EQ(bytes[bytes.size() - 1], '\x22');
}

TEST(SceneMessage, IsBounded) {
  Scene scene;
  scene.lines.resize(2 * kMostMarks);
  scene.labels.resize(2 * kMostLabels);
  scene.traces.resize(2);
  for (SceneTrace& trace : scene.traces) trace.points.assign(kMostTracePoints, Eigen::Vector3f::Ones());
  EXPECT_EQ(word(scene_poses(scene, {}), 1), kMostMarks);
  const auto marks = nlohmann::json::parse(scene_marks(scene, CompiledCell(), {}));
  EXPECT_EQ(marks["is"], "marks");
  EXPECT_EQ(marks["labels"].size(), kMostLabels);
  ASSERT_EQ(marks["traces"].size(), 1U) << "the second has no room left";
  EXPECT_EQ(marks["traces"][0]["points_m"].size(), 3 * kMostTracePoints);
}

class SceneServiceTest : public testing::Test {
 protected:
  using Geometry = Result<std::shared_ptr<const SceneGeometry>>;

  SystemClock clock_;
  Watchdog watchdog_{std::chrono::seconds(10), {}};
  engine::Engine engine_{watchdog_};
  engine::TickReader& ticks_ = engine_.subscribe("test");
  Board<CellState> pictures_;
  ProximityBoard proximity_;
  Board<RangeReadings> ranges_;
  Board<ForceState> forces_;
  Board<TraceState> traces_;
  SceneSource::Boards boards_{ticks_, pictures_, proximity_, ranges_, forces_, traces_, clock_};
};

TEST_F(SceneServiceTest, SaysThatThereIsNoCellYet) {
  SceneService sut(60, boards_);
  std::promise<Geometry> answer;
  sut.ask_geometry([&](const Geometry& geometry) { answer.set_value(geometry); });
  const Geometry geometry = answer.get_future().get();
  ASSERT_FALSE(geometry);
  EXPECT_NE(geometry.error().text().find("not there yet"), std::string::npos);
  const auto stream = sut.open();
  ASSERT_TRUE(stream);
  EXPECT_EQ((*stream)->newest(0), nullptr);
}

TEST_F(SceneServiceTest, BoundsItsStreamsWhichMayOutliveIt) {
  std::vector<std::unique_ptr<SceneStream>> streams;
  {
    SceneService sut(60, boards_);
    for (std::size_t i = 0; i < SceneService::kMaxStreams; ++i) {
      auto stream = sut.open();
      ASSERT_TRUE(stream);
      streams.push_back(std::move(*stream));
    }
    EXPECT_FALSE(sut.open());
    streams.pop_back();
    auto again = sut.open();
    ASSERT_TRUE(again);
    streams.push_back(std::move(*again));
  }
  for (const auto& stream : streams) EXPECT_EQ(stream->newest(0), nullptr);
}

TEST_F(SceneServiceTest, AnswersEverybodyOnceAlsoAtItsEnd) {
  std::atomic<int> answered{0};
  constexpr int kAsked = 200;
  {
    SceneService sut(60, boards_);
    for (int i = 0; i < kAsked; ++i) sut.ask_geometry([&](const Geometry&) { ++answered; });
  }
  EXPECT_EQ(answered, kAsked);
}

}  // namespace
}  // namespace cellmirror::app
