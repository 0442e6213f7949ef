// A recording in a file is played: states at their times, seeks to and fro, gaps, the end. The wall clock is the
// test's.
#include "app/playback/player.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/playback/played_recording.hpp"
#include "app/recording/recorded_cell.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "app/recording_layout/tissue_messages.hpp"
#include "ipc/record/byte_stream.hpp"
#include "ipc/record/writer.hpp"
#include "tests/unit/engine/commands.hpp"
#include "tests/unit/recorder/tissue_parts.hpp"

namespace cellmirror::app {
namespace {

constexpr Nanoseconds kPeriod{1'000'000};
constexpr std::int64_t kUtc = 1'700'000'000'000'000'000;
constexpr std::size_t kSlotOfCell = 3;  // another one than in the recording

// True as soon as `condition` is, with patience for a busy machine.
bool eventually(const std::function<bool()>& condition) {
  for (int i = 0; i < 5000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

class PlayerTest : public testing::Test {
 protected:
  PlayerTest() : file_(scratch_->path() / "a.mcap") {
    send_robot(*engine_, 0, engine::robot_of(3, -2, 2));
    engine_->send(engine::SetMode{.slot = 0, .mode = engine::RobotMode::mirrored});
    tick(3);
    auto cell = std::make_shared<CompiledCell>();
    CompiledRobot robot;
    robot.id = "ARM";
    robot.slot = kSlotOfCell;
    robot.joint_names = {"J1", "J2", "J3"};
    cell->robots.push_back(robot);
    auto cell_state = std::make_shared<CellState>();
    cell_state->cell = cell;
    board_.publish(cell_state);
  }

  void tick(int times) {
    for (int i = 0; i < times; ++i) {
      now_ = now_ + kPeriod;
      const JointSample sample = engine::sample_of_curve(now_, cycle_ + 1);
      engine_->inlet(0).push(sample);
      engine::run_cycle(*engine_, now_, cycle_, 0, kPeriod);
      published_[now_] = sample.position[0];
    }
  }

  // One message of what was recorded since the last one; `lost`: it is left out, and its number with it.
  void put(bool lost = false) {
    std::vector<std::byte> data{std::byte{engine::kInputsVersion}};
    const auto names = names_record({{0, {"ARM", {"J1", "J2", "J3"}}}});
    const auto length = static_cast<std::uint32_t>(names.size());
    data.push_back(static_cast<std::byte>(engine::InputRecord::robots));
    const auto bytes = std::as_bytes(std::span(&length, 1));
    data.insert(data.end(), bytes.begin(), bytes.end());
    data.insert(data.end(), names.begin(), names.end());
    engine_->inputs().drain(data);
    const auto utc = static_cast<std::uint64_t>(now_.ns + kUtc);
    if (!lost) {
      ASSERT_TRUE(writer_->put(
          mcap::Message{.channel = 1, .sequence = sequence_, .log_time = utc, .publish_time = utc, .data = data}));
    }
    ++sequence_;
  }

  // So many seconds with a message each tenth, from a start state on.
  void record(double seconds) {
    engine_->inputs().request_start();
    for (int i = 0; i < std::lround(10 * seconds); ++i) {
      tick(100);
      put();
    }
  }

  void open() {
    ASSERT_TRUE(writer_->finish());
    auto opened = PlayedRecording::open({.file = file_, .playing = false}, wall_);
    ASSERT_TRUE(opened) << opened.error().text();
    recording_ = *std::move(opened);
    ticks_ = &recording_->make_publication(16, board_).subscribe("test");
    const auto started = recording_->start();
    ASSERT_TRUE(started) << started.error().text();
    ASSERT_TRUE(arrived());
  }

  bool arrived() {
    return eventually([this] { return recording_->control().state().status != PlaybackStatus::seeking; });
  }
  void apply(const PlaybackRequest& request) { ASSERT_TRUE(recording_->control().apply(request)); }
  // Seconds after the beginning.
  void seek(double to) {
    apply({.play = {}, .speed = {}, .seek_ns = recording_->control().state().from_ns + std::llround(1e9 * to)});
    ASSERT_TRUE(arrived());
    ASSERT_TRUE(eventually([&] { return std::abs(behind_begin(ticks_->newest().time) - to) < 0.0011; })) << to;
  }
  [[nodiscard]] double behind_begin(Timestamp t) const { return seconds(t - recording_->control().range().from); }
  void expect_as_recorded() {
    const engine::TickState& state = ticks_->newest();
    EXPECT_EQ(state.robots[kSlotOfCell].joints[0].position, published_.at(state.time));
  }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<engine::Engine> engine_ =
      std::make_unique<engine::Engine>(watchdog_, engine::EngineCapacity{.robots = 2});
  Timestamp now_{1'000'000'000};
  std::uint64_t cycle_ = 0;
  std::uint32_t sequence_ = 0;
  std::map<Timestamp, double> published_;

  Result<TemporaryFolder> scratch_ = TemporaryFolder::make();
  std::filesystem::path file_;
  std::unique_ptr<mcap::FileSink> sink_ = *mcap::FileSink::create(file_);
  std::unique_ptr<mcap::Writer> writer_ = [this] {
    auto made = std::make_unique<mcap::Writer>(*sink_, mcap::WriterOptions{.chunk_bytes = 2000});
    EXPECT_TRUE(made->begin());
    EXPECT_TRUE(made->put(mcap::Channel{.id = 1,
                                        .schema = 0,
                                        .topic = std::string(kInputsTopic),
                                        .encoding = std::string(kInputsEncoding),
                                        .metadata = {}}));
    EXPECT_TRUE(made->put(mcap::Channel{.id = 2,
                                        .schema = 0,
                                        .topic = "/cellmirror/tissue/liver",
                                        .encoding = std::string(kTissueEncoding),
                                        .metadata = {}}));
    return made;
  }();

  PlaybackClock wall_;  // its time is set by one thread and read by another
  Board<CellState> board_;
  std::unique_ptr<PlayedRecording> recording_;
  engine::TickReader* ticks_ = nullptr;
};

TEST_F(PlayerTest, EachSeekGivesTheStateOfThatTimeToTheBit) {
  record(13);  // a start state at its beginning only: seeks look further back than that
  open();
  for (const double to : {12.5, 0.3, 6.0, 0.3, 12.5, 0.0}) {
    seek(to);
    expect_as_recorded();
  }
  EXPECT_EQ(recording_->control().state().status, PlaybackStatus::paused);
}

TEST_F(PlayerTest, DeformableObjectsAreAsTheyWereAtEachSeek) {
  engine_->inputs().request_start();
  TissueSurface liver = test::square("liver.mpo", {0, 0, 0});
  std::vector<std::byte> bytes;
  constexpr float kRise = 0.01F;  // in a tenth of a second
  for (int i = 0; i < 200; ++i) {
    tick(100);
    put();
    const bool is_cut = i >= 100;
    if (i == 100) test::cut(liver);
    for (Eigen::Vector3f& vertex : liver.vertices) vertex.z() += kRise;
    ASSERT_TRUE(encode_surface({.step = cycle_, .time = now_, .revision = is_cut ? 2U : 1U, .has_shape = i % 50 == 0},
                               liver, bytes));
    const auto utc = static_cast<std::uint64_t>(now_.ns + kUtc);
    ASSERT_TRUE(writer_->put(
        mcap::Message{.channel = 2, .sequence = sequence_, .log_time = utc, .publish_time = utc, .data = bytes}));
  }
  open();
  const PlayedTissue& tissue = std::as_const(*recording_).run().tissue();
  for (const double to : {19.45, 0.45, 12.25, 4.05, 19.45}) {
    seek(to);
    const auto view = tissue.view();
    ASSERT_TRUE(view && view->surfaces.size() == 1) << to;
    const TissueSurface& shown = view->surfaces[0];
    EXPECT_EQ(shown.topology->triangles.size(), to > 10.05 ? 1U : 2U) << to;
    // It was written behind the ticks of each tenth of a second.
    EXPECT_NEAR(static_cast<double>(shown.vertices[0].z()), 0.1 * to, 0.0061) << to;
  }
  EXPECT_EQ(tissue.refused(), 0U);
}

TEST_F(PlayerTest, PlaysAsTheWallClockGoesAndEnds) {
  record(2);
  open();
  apply({.play = true, .speed = 2.0, .seek_ns = {}});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_LT(behind_begin(ticks_->newest().time), 0.01) << "the wall clock stands still";
  wall_.set(wall_.now() + Nanoseconds(250'000'000));
  EXPECT_TRUE(eventually([this] { return behind_begin(ticks_->newest().time) >= 0.498; }));
  EXPECT_LT(behind_begin(ticks_->newest().time), 0.51);
  expect_as_recorded();
  wall_.set(wall_.now() + Nanoseconds(5'000'000'000));
  EXPECT_TRUE(eventually([this] { return recording_->control().state().status == PlaybackStatus::ended; }));
  EXPECT_TRUE(eventually([this] { return ticks_->newest().time == recording_->control().range().to; }));
  expect_as_recorded();
}

TEST_F(PlayerTest, JumpsOverAGapAndSaysSo) {
  record(1);
  tick(400);
  put(true);
  record(1);
  open();
  seek(0.9);
  apply({.play = true, .speed = {}, .seek_ns = {}});
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  wall_.set(wall_.now() + Nanoseconds(150'000'000));
  ASSERT_TRUE(eventually([this] { return recording_->control().state().gaps == 1; }));
  EXPECT_TRUE(recording_->control().state().note.contains("nothing was recorded"));
  EXPECT_TRUE(eventually([this] { return behind_begin(ticks_->newest().time) > 1.39; }));
  expect_as_recorded();
  apply({.play = false, .speed = {}, .seek_ns = {}});
  // Into the gap: what comes next.
  apply({.play = {}, .speed = {}, .seek_ns = recording_->control().state().from_ns + 1'200'000'000});
  EXPECT_TRUE(arrived());
  EXPECT_GT(1e-9 * static_cast<double>(recording_->control().state().now_ns - recording_->control().state().from_ns),
            1.39);
}

TEST_F(PlayerTest, ARecordingWithoutAStartStateIsRefused) {
  engine_->inputs().request_start();
  tick(10);
  put(true);
  tick(100);
  put();
  ASSERT_TRUE(writer_->finish());
  const auto opened = PlayedRecording::open({.file = file_}, wall_);
  ASSERT_FALSE(opened);
  EXPECT_TRUE(opened.error().what.contains("start state")) << opened.error().text();
}

}  // namespace
}  // namespace cellmirror::app
