// One recording: what is taken, what finds no room, rings and their bounds.
#include "app/recorder/recording.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "app/recorder/recording_hub.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "ipc/record/reader.hpp"

namespace cellmirror::app {
namespace {

constexpr Nanoseconds kSecond{1'000'000'000};

TopicPtr topic(std::string name, Importance importance = Importance::state) {
  return std::make_shared<const Topic>(Topic{std::move(name), "json", "one", "jsonschema", "{}", importance});
}

// Read by the writer's thread while the test moves it.
class TestClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() const CELL_RT override { return Timestamp{now_.load()}; }
  void advance(Nanoseconds by) { now_ += by.count(); }

 private:
  std::atomic<std::int64_t> now_{SystemClock().now().ns};
};

class RecordingTest : public testing::Test {
 protected:
  RecordingTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "recording.XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~RecordingTest() override { std::filesystem::remove_all(folder_); }

  std::unique_ptr<Recording> start(RecordingOptions options) {
    auto made = Recording::start(std::move(options), clock_);
    EXPECT_TRUE(made) << made.error().text();
    return made ? *std::move(made) : nullptr;
  }
  RecordingOptions to_file() {
    RecordingOptions options;
    options.file = folder_ / "a.mcap";
    return options;
  }
  static void put(Recording& to, const TopicPtr& of, std::string_view text) { to.put(of, 10, 9, mcap::view_of(text)); }

  // Within a while, since the writer has a thread of its own.
  template <class Condition>
  static bool soon(const Condition& condition) {
    for (int i = 0; i < 500; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  static void end(Recording& recording) {
    recording.end();
    EXPECT_TRUE(soon([&] { return recording.ended(); }));
  }
  std::vector<std::string> files() const {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) out.push_back(entry.path().filename());
    std::ranges::sort(out);
    return out;
  }

  std::filesystem::path folder_;
  TestClock clock_;
};

TEST_F(RecordingTest, WhatIsPutIsInTheFile) {
  RecordingOptions options = to_file();
  options.about = {{"cell", "demo"}};
  std::ofstream(folder_ / "cell.toml") << "name";
  options.cell = cell_files(folder_, {folder_ / "cell.toml"});
  const auto recording = start(options);
  const TopicPtr a = topic("/a");
  put(*recording, a, "one");
  put(*recording, topic("/b"), "two");
  put(*recording, a, "three");
  end(*recording);
  EXPECT_EQ(recording->report().messages, 3U);
  const auto source = mcap::FileSource::open(folder_ / "a.mcap");
  ASSERT_TRUE(source);
  auto reader = mcap::Reader::open(**source);
  ASSERT_TRUE(reader && reader->indexed());
  std::vector<std::string> found;
  ASSERT_TRUE(reader->read({}, [&](const mcap::Message& message, const mcap::Channel& channel) {
    found.push_back(channel.topic + " " + std::to_string(message.sequence) + " " +
                    std::string(reinterpret_cast<const char*>(message.data.data()), message.data.size()));
    return true;
  }));
  EXPECT_EQ(found, (std::vector<std::string>{"/a 1 one", "/b 1 two", "/a 2 three"}));
  EXPECT_EQ(reader->metadata(kGatewayName)->values.at("cell"), "demo");
  EXPECT_EQ(reader->attachment("cell.toml"), "name");
}

TEST_F(RecordingTest, OnlyTheTopicsThatAreWanted) {
  RecordingOptions options = to_file();
  options.topics = {"/a", "/own/*"};
  const auto recording = start(options);
  EXPECT_TRUE(recording->wants(*topic("/own/x")));
  EXPECT_FALSE(recording->wants(*topic("/ab")));
  put(*recording, topic("/b"), "x");
  put(*recording, topic("/own/x"), "x");
  end(*recording);
  EXPECT_EQ(recording->report().messages, 1U);
}

// The writer takes what waits every 50 ms; what is put at once has to fit.
TEST_F(RecordingTest, WithoutRoomWhatIsLessImportantIsLeftOutFirstAndCounted) {
  RecordingOptions options = to_file();
  options.buffer_bytes = 0;
  const auto recording = start(options);
  put(*recording, topic("/event", Importance::event), "x");
  end(*recording);
  EXPECT_EQ(recording->report().dropped, 1U);
  EXPECT_EQ(recording->report().topics.front().dropped, 1U);
  const auto source = mcap::FileSource::open(folder_ / "a.mcap");
  const auto reader = mcap::Reader::open(**source);
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->metadata(kDropsName)->values.at("/event"), "1");
}

TEST_F(RecordingTest, TheBoundsOfImportanceAreInOrder) {
  RecordingOptions options = to_file();
  options.buffer_bytes = 1000;
  const auto recording = start(options);
  const std::string large(600, 'x');
  // Beyond half of it, beyond three quarters of it, within all of it.
  put(*recording, topic("/bulk", Importance::bulk), large);
  put(*recording, topic("/state", Importance::state), std::string(800, 'x'));
  put(*recording, topic("/event", Importance::event), std::string(800, 'x'));
  end(*recording);
  const RecordingReport report = recording->report();
  ASSERT_EQ(report.topics.size(), 3U);
  EXPECT_EQ(report.topics[0].dropped, 1U);
  EXPECT_EQ(report.topics[1].dropped, 1U);
  EXPECT_EQ(report.topics[2].dropped, 0U);
}

TEST_F(RecordingTest, MissedMessagesShowInTheSequence) {
  const auto recording = start(to_file());
  const TopicPtr a = topic("/a");
  put(*recording, a, "x");
  recording->count_missed(a, 5);
  put(*recording, a, "x");
  end(*recording);
  EXPECT_EQ(recording->report().dropped, 5U);
  const auto source = mcap::FileSource::open(folder_ / "a.mcap");
  auto reader = mcap::Reader::open(**source);
  std::uint32_t last = 0;
  ASSERT_TRUE(reader->read({}, [&](const mcap::Message& message, const mcap::Channel&) {
    last = message.sequence;
    return true;
  }));
  EXPECT_EQ(last, 7U);
}

TEST_F(RecordingTest, ItEndsAfterItsLengthAndWhereNobodyRenewsIt) {
  RecordingOptions options = to_file();
  options.length = kSecond;
  const auto recording = start(options);
  clock_.advance(kSecond);
  EXPECT_TRUE(soon([&] { return recording->ended(); }));
  EXPECT_EQ(recording->report().why, "");
  options = to_file();
  options.file = folder_ / "b.mcap";
  options.lease = 2 * kSecond;
  const auto leased = start(options);
  clock_.advance(kSecond);
  leased->renew();
  clock_.advance(kSecond);
  put(*leased, topic("/a"), "x");
  EXPECT_TRUE(soon([&] { return leased->report().bytes > 0; }));
  EXPECT_FALSE(leased->ended());
  clock_.advance(2 * kSecond);
  EXPECT_TRUE(soon([&] { return leased->ended(); }));
  EXPECT_NE(leased->report().why.find("gone"), std::string::npos);
}

TEST_F(RecordingTest, ARemovedFileEndsIt) {
  const auto recording = start(to_file());
  std::filesystem::remove(folder_ / "a.mcap");
  clock_.advance(2 * kSecond);
  EXPECT_TRUE(soon([&] { return recording->ended(); }));
  EXPECT_NE(recording->report().why.find("was removed"), std::string::npos);
}

class RingTest : public RecordingTest {
 protected:
  RecordingOptions ring() {
    RecordingOptions options;
    options.ring = RecordingRing{.folder = folder_,
                                 .name = "box",
                                 .file_length = 10 * kSecond,
                                 .length = 30 * kSecond,
                                 .most_bytes = 1'000'000,
                                 .most_kept = 5,
                                 .keep_after = 2 * kSecond};
    return options;
  }
  // One file of the ring; waits until the next one has begun.
  void pass_a_file(Recording& recording) {
    put(recording, topic_, std::string(100, 'x'));
    const std::uint64_t begun = recording.report().files;
    clock_.advance(10 * kSecond);
    EXPECT_TRUE(soon([&] { return recording.report().files > begun; }));
  }
  TopicPtr topic_ = topic("/a");
};

TEST_F(RingTest, HasItsNumberOfFiles) {
  const auto recording = start(ring());
  for (int i = 0; i < 6; ++i) pass_a_file(*recording);
  EXPECT_EQ(files().size(), 4U);  // three, and the one that is written
  end(*recording);
}

TEST_F(RingTest, HasItsBytes) {
  RecordingOptions options = ring();
  options.ring->most_bytes = 1;
  const auto recording = start(options);
  for (int i = 0; i < 3; ++i) pass_a_file(*recording);
  EXPECT_EQ(files().size(), 1U);
  end(*recording);
}

TEST_F(RingTest, KeepsItsFilesAWhileAfterARequest) {
  const auto recording = start(ring());
  pass_a_file(*recording);
  ASSERT_TRUE(recording->keep());
  put(*recording, topic_, "after");
  clock_.advance(3 * kSecond);
  EXPECT_TRUE(soon([&] { return recording->report().kept == 2; }));
  for (int i = 0; i < 5; ++i) pass_a_file(*recording);
  const std::vector<std::string> left = files();
  EXPECT_EQ(std::ranges::count_if(left, [](const std::string& name) { return name.starts_with("box-kept-"); }), 2);
  end(*recording);
}

TEST_F(RingTest, TakesOverTheFilesOfARunBefore) {
  end(*start(ring()));
  clock_.advance(kSecond);
  const auto recording = start(ring());
  for (int i = 0; i < 5; ++i) pass_a_file(*recording);
  EXPECT_EQ(files().size(), 4U);
  end(*recording);
}

TEST_F(RingTest, AHubSwitchesItAndNeverTwoFilesAtATime) {
  RecordingHub hub(clock_);
  EXPECT_FALSE(hub.switch_ring(true));
  EXPECT_FALSE(hub.keep_ring());
  hub.set_ring_options(ring());
  ASSERT_TRUE(hub.switch_ring(true));
  EXPECT_TRUE(hub.keep_ring());
  ASSERT_TRUE(hub.start_file(to_file()));
  RecordingOptions other = to_file();
  other.file = folder_ / "b.mcap";
  EXPECT_FALSE(hub.start_file(other));
  EXPECT_DOUBLE_EQ(hub.rate_hz(), 100.0);
  hub.put(topic_, 1, mcap::view_of("x"));
  EXPECT_EQ(hub.reports().size(), 2U);
  for (const RecordingReport& report : hub.reports()) EXPECT_EQ(report.messages, 1U);
  hub.end_file();
  EXPECT_TRUE(soon([&] { return hub.file_report()->ended; }));
  ASSERT_TRUE(hub.start_file(other));
  ASSERT_TRUE(hub.switch_ring(false));
  hub.close();
  EXPECT_DOUBLE_EQ(hub.rate_hz(), 0.0);
}

}  // namespace
}  // namespace cellmirror::app
