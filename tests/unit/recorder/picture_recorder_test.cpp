// Pictures of views on their way into recordings: only those that are wanted, each once.
#include "app/recorder/picture_recorder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/recorder/output_messages.hpp"
#include "app/recording/recorded_cell.hpp"
#include "app/recording/ros2_schema.hpp"
#include "config/record_settings.hpp"
#include "ipc/record/reader.hpp"

namespace cellmirror::app {
namespace {

// What the renderer would have drawn, by view.
struct Drawn {
  std::map<std::string, std::shared_ptr<const EncodedImage>> newest;
  std::vector<PictureRequest> opened;
};

class Stream final : public PictureStream {
 public:
  Stream(Drawn& drawn, std::string view) : drawn_(drawn), view_(std::move(view)) {}
  void change(const PictureRequest& request) override { drawn_.opened.push_back(request); }
  [[nodiscard]] std::shared_ptr<const EncodedImage> newest(std::uint64_t has) const override {
    const auto found = drawn_.newest.find(view_);
    return found == drawn_.newest.end() || found->second->sequence == has ? nullptr : found->second;
  }
  [[nodiscard]] std::string problem() const override { return {}; }

 private:
  Drawn& drawn_;
  std::string view_;
};

class PictureRecorderTest : public testing::Test {
 protected:
  PictureRecorderTest() : folder_(*TemporaryFolder::make()) {}

  void record(std::vector<WantedPicture> pictures, std::vector<std::string> topics = {}) {
    RecordingOptions options;
    options.file = folder_.path() / "a.mcap";
    options.pictures = std::move(pictures);
    options.topics = std::move(topics);
    ASSERT_TRUE(hub_.start_file(std::move(options)));
  }
  void draw(const std::string& view, std::uint64_t sequence) {
    auto picture = std::make_shared<EncodedImage>();
    picture->bytes = {0xFF, 0xD8, static_cast<std::uint8_t>(sequence)};
    picture->posture_time = clock_.now();
    picture->sequence = sequence;
    drawn_.newest[view] = picture;
  }
  void look() { sut_.look(now_ = now_ + Nanoseconds(200'000'000)); }
  // "TOPIC FRAME" of each message of the file.
  std::vector<std::string> recorded() {
    hub_.end_file();
    while (!hub_.file_report()->ended) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const auto source = mcap::FileSource::open(folder_.path() / "a.mcap");
    EXPECT_TRUE(source);
    auto reader = mcap::Reader::open(**source);
    EXPECT_TRUE(reader);
    std::vector<std::string> out;
    EXPECT_TRUE(reader->read({}, [&](const mcap::Message& message, const mcap::Channel& channel) {
      const mcap::Schema& schema = *reader->catalogue().schema_of(channel);
      const auto parsed = Ros2Schema::parse(schema.name, schema.data);
      EXPECT_TRUE(parsed);
      std::string frame;
      const auto values = parsed->flatten(message.data);
      EXPECT_TRUE(values);
      for (const FlatValue& value : *values)
        if (value.path == "header.frame_id" || value.path == "format") frame += " " + value.text;
      out.push_back(channel.topic + frame);
      return true;
    }));
    return out;
  }

  TemporaryFolder folder_;
  SystemClock clock_;
  RecordingHub hub_{clock_};
  Drawn drawn_;
  PictureRecorder sut_{[this](const PictureRequest& request) -> Result<std::unique_ptr<PictureStream>> {
                         drawn_.opened.push_back(request);
                         return std::make_unique<Stream>(
                             drawn_, request.view ? std::to_string(*request.view) : *request.camera);
                       },
                       hub_};
  Timestamp now_{1'000'000'000};
};

TEST_F(PictureRecorderTest, EachPictureOfAWantedViewIsThereOnce) {
  record({{"1", 2.0}, {"HALL_CAM", 0.5}});
  draw("1", 1);
  look();
  look();
  draw("1", 2);
  draw("HALL_CAM", 1);
  look();
  ASSERT_EQ(drawn_.opened.size(), 2U);
  EXPECT_EQ(drawn_.opened[0].view, 1);
  EXPECT_EQ(drawn_.opened[0].rate_hz, 2.0);
  EXPECT_EQ(drawn_.opened[1].camera, "HALL_CAM");
  EXPECT_EQ(recorded(),
            (std::vector<std::string>{"/cellmirror/pictures/view_1 1 jpeg", "/cellmirror/pictures/view_1 1 jpeg",
                                      "/cellmirror/pictures/HALL_CAM HALL_CAM jpeg"}));
}

TEST_F(PictureRecorderTest, NothingIsDrawnWhereNoRecordingWantsPictures) {
  record({});
  draw("1", 1);
  look();
  EXPECT_TRUE(drawn_.opened.empty());
  EXPECT_FALSE(hub_.wants(*OutputTopics::pictures("1")));
  EXPECT_TRUE(recorded().empty());
}

TEST_F(PictureRecorderTest, AListOfTopicsDoesNotTakeThemAway) {
  record({{"0", 1.0}}, {"/joint_states"});
  EXPECT_TRUE(hub_.wants(*OutputTopics::pictures("0")));
  EXPECT_FALSE(hub_.wants(*OutputTopics::pictures("2")));
  EXPECT_FALSE(hub_.wants(*OutputTopics::tf()));
}

TEST(RecordedPictures, AreAViewAndARate) {
  EXPECT_EQ(recorded_picture("1@0.5"), (RecordedPicture{"1", 0.5}));
  EXPECT_EQ(recorded_picture("A.CAM@2"), (RecordedPicture{"A.CAM", 2}));
  for (const char* wrong : {"", "1", "@1", "1@", "1@0", "1@11", "1@x", "1@nan", "1@-1"})
    EXPECT_FALSE(recorded_picture(wrong)) << wrong;
}

}  // namespace
}  // namespace cellmirror::app
