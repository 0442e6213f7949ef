// Deformable objects on their way into recordings: when they move, with their shapes where a reader needs them.
#include "app/recorder/tissue_recorder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <string>
#include <thread>

#include "app/recording/recorded_cell.hpp"
#include "app/recording/ros2_schema.hpp"
#include "ipc/record/reader.hpp"
#include "tests/unit/recorder/tissue_parts.hpp"

namespace cellmirror::app {
namespace {

class TissueRecorderTest : public testing::Test {
 protected:
  TissueRecorderTest() : folder_(*TemporaryFolder::make()) { view_->surfaces = {test::square("liver.mpo", {0, 0, 0})}; }

  void record(const std::string& file, double rate_hz = 10, std::vector<std::string> topics = {}) {
    RecordingOptions options;
    options.file = folder_.path() / file;
    options.topics = std::move(topics);
    options.tissue_rate_hz = rate_hz;
    ASSERT_TRUE(hub_.start_file(std::move(options)));
  }
  // The next view, some time later.
  void look(double after_s = 0.1) {
    now_ = now_ + Nanoseconds(static_cast<std::int64_t>(1e9 * after_s));
    ++view_->step;
    sut_.look(now_);
  }
  void move() {
    view_ = std::make_shared<TissueView>(*view_);
    view_->surfaces[0].vertices[0].x() -= 0.01F;
  }
  void end() {
    hub_.end_file();
    while (!hub_.file_report()->ended) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  // "s" for each message with a shape, "p" for one with places alone, by topic.
  std::map<std::string, std::string> recorded(const std::string& file) {
    end();
    const auto source = mcap::FileSource::open(folder_.path() / file);
    EXPECT_TRUE(source);
    auto reader = mcap::Reader::open(**source);
    EXPECT_TRUE(reader);
    std::map<std::string, std::string> out;
    EXPECT_TRUE(reader->read({}, [&](const mcap::Message& message, const mcap::Channel& channel) {
      if (channel.encoding == "cdr") {
        const mcap::Schema& schema = *reader->catalogue().schema_of(channel);
        const auto parsed = Ros2Schema::parse(schema.name, schema.data);
        EXPECT_TRUE(parsed && parsed->flatten(message.data));
        out[channel.topic] += "m";
      } else {
        const auto head = read_tissue_head(message.data);
        EXPECT_TRUE(head);
        out[channel.topic] += head->has_shape ? "s" : "p";
      }
      return true;
    }));
    return out;
  }

  TemporaryFolder folder_;
  SystemClock clock_;
  RecordingHub hub_{clock_};
  Board<TissueReport> reports_;
  std::shared_ptr<TissueView> view_ = std::make_shared<TissueView>();
  int views_asked_ = 0;
  Timestamp now_ = clock_.now();
  TissueRecorder sut_{{&reports_,
                       [this] {
                         ++views_asked_;
                         return view_;
                       }},
                      hub_};
};

TEST_F(TissueRecorderTest, PlacesFollowAShapeAndWhatStandsStillIsNotRepeated) {
  record("a.mcap");
  look();
  move();
  look();
  look();
  move();
  look();
  const auto topics = recorded("a.mcap");
  EXPECT_EQ(topics.at("/cellmirror/tissue/liver"), "spp");
  EXPECT_EQ(topics.at("/cellmirror/tissue_effects"), "s");
  EXPECT_EQ(topics.at("/cellmirror/tissue_markers"), "m") << "at most twice a second";
}

TEST_F(TissueRecorderTest, AShapeIsWrittenAgainAfterACutAndFromTimeToTime) {
  record("a.mcap");
  look();
  test::cut(view_->surfaces[0]);
  look();
  move();
  look();
  look(5);
  EXPECT_EQ(recorded("a.mcap").at("/cellmirror/tissue/liver"), "ssps");
}

TEST_F(TissueRecorderTest, EachFileBeginsWithShapes) {
  record("a.mcap");
  look();
  end();
  record("b.mcap");
  look();
  EXPECT_EQ(recorded("b.mcap").at("/cellmirror/tissue/liver"), "s");
}

TEST_F(TissueRecorderTest, NotMoreOftenThanWanted) {
  record("a.mcap", 2);
  for (int i = 0; i < 10; ++i) {
    move();
    look(0.05);
  }
  EXPECT_EQ(recorded("a.mcap").at("/cellmirror/tissue/liver"), "s");
}

TEST_F(TissueRecorderTest, WithoutARateNobodyAsksForShapes) {
  record("a.mcap", 0);
  look();
  EXPECT_EQ(views_asked_, 0);
  EXPECT_TRUE(recorded("a.mcap").empty());
}

TEST_F(TissueRecorderTest, RecordsEventsOnceAndWithNames) {
  CellState cell;
  cell.robots.emplace_back();
  cell.robots[0].id = "LAP";
  cell.robots[0].slot = 3;
  const auto report = [&](std::uint64_t first, std::uint64_t last) {
    auto made = std::make_shared<TissueReport>();
    made->state.objects.emplace_back();
    made->state.objects[0].name = "liver";
    for (std::uint64_t number = first; number <= last; ++number) {
      TissueEvent event;
      event.number = number;
      event.kind = number % 2 == 0 ? TissueEventKind::release : TissueEventKind::grip;
      event.time = now_;
      event.instrument = 3;
      event.object = 0;
      event.value = 4.5;
      made->state.events.push_back(event);
    }
    reports_.publish(std::move(made));
  };
  const auto look_at_cell = [&] {
    now_ = now_ + Nanoseconds(20'000'000);
    sut_.look(now_, &cell);
  };
  // A file that begins with shapes does not lose the events between its first two looks.
  for (const double rate_hz : {0.0, 10.0}) {
    SCOPED_TRACE(rate_hz);
    const std::string file = rate_hz > 0 ? "shapes.mcap" : "events.mcap";
    sut_.forget();
    record(file, rate_hz);
    report(1, 2);
    look_at_cell();  // these events are older than the recording
    report(1, 4);
    look_at_cell();
    look_at_cell();
    report(3, 5);
    look_at_cell();
    end();
    const auto source = mcap::FileSource::open(folder_.path() / file);
    ASSERT_TRUE(source);
    auto reader = mcap::Reader::open(**source);
    ASSERT_TRUE(reader);
    std::vector<std::string> texts;
    ASSERT_TRUE(reader->read({.topics = {"/cellmirror/tissue_events"}}, [&](const mcap::Message& message, const auto&) {
      texts.emplace_back(reinterpret_cast<const char*>(message.data.data()), message.data.size());
      return true;
    }));
    ASSERT_EQ(texts.size(), 3U);
    EXPECT_NE(texts[0].find(R"("number":3)"), std::string::npos) << texts[0];
    EXPECT_NE(texts[0].find(R"("event":"grip","robot":"LAP","object":"liver")"), std::string::npos) << texts[0];
    EXPECT_NE(texts[1].find(R"("event":"release")"), std::string::npos) << texts[1];
    EXPECT_NE(texts[1].find(R"("value":4.5)"), std::string::npos) << texts[1];
    EXPECT_NE(texts[2].find(R"("number":5)"), std::string::npos) << texts[2];
  }
}

TEST_F(TissueRecorderTest, WhatCannotBeRecordedIsCounted) {
  record("a.mcap");
  view_->surfaces[0].normals.clear();
  look();
  end();
  const auto report = *hub_.file_report();
  const auto topic = std::ranges::find(report.topics, "/cellmirror/tissue/liver", &TopicReport::topic);
  ASSERT_NE(topic, report.topics.end());
  EXPECT_EQ(topic->dropped, 1U);
}

}  // namespace
}  // namespace cellmirror::app
