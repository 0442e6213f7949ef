// The picture thread where there is nothing to draw with: everything else goes on.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <thread>
#include <utility>

#include "app/render/render_service.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/rt/watchdog.hpp"

namespace cellmirror::app {
namespace {

class RenderServiceTest : public testing::Test {
 protected:
  RenderService::Options broken() {
    RenderService::Options options;
    options.settings.rate_hz = 60;
    options.make_renderer = [this]() -> Result<std::unique_ptr<display::Renderer>> {
      ++tries_;
      return fail("no renderer: libOSMesa.so.8 is not there", "apt-get install libosmesa6");
    };
    return options;
  }
  static Result<EncodedImage> picture_of(RenderService& renderer, const PictureRequest& request) {
    const auto answer = std::make_shared<std::promise<Result<EncodedImage>>>();
    renderer.ask_picture(request, ImageFormat::png,
                         [answer](Result<EncodedImage> taken) { answer->set_value(std::move(taken)); });
    return answer->get_future().get();
  }
  static bool picks(RenderService& renderer, int x, int y) {
    const auto answer = std::make_shared<std::promise<bool>>();
    renderer.ask_pick({}, x, y, [answer](const auto& picked) { answer->set_value(picked.has_value()); });
    return answer->get_future().get();
  }
  static bool eventually(const std::function<bool()>& condition) {
    for (int i = 0; i < 2000; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }

  SystemClock clock_;
  Watchdog watchdog_{std::chrono::seconds(10), {}};
  engine::Engine engine_{watchdog_};
  engine::TickReader& ticks_ = engine_.subscribe("test");
  Board<CellState> pictures_;
  ProximityBoard proximity_;
  Board<RangeReadings> ranges_;
  Board<ForceState> forces_;
  Board<TraceState> traces_;
  PictureCounter updates_;
  SceneSource::Boards boards_{ticks_, pictures_, proximity_, ranges_, forces_, traces_, clock_};
  std::atomic<int> tries_{0};
};

TEST_F(RenderServiceTest, BrokenRendererIsToldAndNotTriedAllTheTime) {
  RenderService sut(broken(), boards_, updates_);
  for (int i = 0; i < 3; ++i) {
    const auto picture = picture_of(sut, {});
    ASSERT_FALSE(picture);
    EXPECT_NE(picture.error().text().find("libosmesa6"), std::string::npos) << picture.error().text();
  }
  EXPECT_FALSE(picks(sut, 1, 1));
  EXPECT_EQ(tries_, 1);
  EXPECT_NE(sut.report().problem.find("libOSMesa"), std::string::npos);
  EXPECT_TRUE(sut.report().renderer.empty());
}

TEST_F(RenderServiceTest, UpdatesGoOnWithoutRendererAndWithoutPictures) {
  RenderService::Options off;
  off.headless = true;
  off.settings.rate_hz = 60;
  RenderService sut(std::move(off), boards_, updates_);
  EXPECT_TRUE(eventually([&] { return updates_.count() > 3; }));
  EXPECT_FALSE(sut.report().on);
  const auto stream = sut.open_pictures({});
  ASSERT_FALSE(stream);
  EXPECT_NE(stream.error().text().find("--headless"), std::string::npos);
}

TEST_F(RenderServiceTest, NobodyLooksNothingIsTried) {
  RenderService sut(broken(), boards_, updates_);
  EXPECT_TRUE(eventually([&] { return updates_.count() > 5; }));
  EXPECT_EQ(tries_, 0);
  const auto stream = sut.open_pictures({});
  ASSERT_TRUE(stream) << stream.error().text();
  EXPECT_TRUE(eventually([&] { return tries_ == 1; }));
  const auto told = [&] { return (*stream)->problem().find("libosmesa6") != std::string::npos; };
  EXPECT_TRUE(eventually([&] { return (*stream)->newest(0) == nullptr && told(); })) << (*stream)->problem();
  EXPECT_EQ(sut.report().streams, 1U);
}

TEST_F(RenderServiceTest, OnceSomebodyIsExpectedTheRendererIsMade) {
  RenderService sut(broken(), boards_, updates_);
  for (int i = 0; i < 100; ++i) sut.expect_pictures();
  EXPECT_TRUE(eventually([&] { return tries_ == 1; }));
  EXPECT_FALSE(picture_of(sut, {})) << "and there is room for those who want one";
  EXPECT_EQ(tries_, 1);
}

TEST_F(RenderServiceTest, WishesThatNobodyCanFulfilAreRefusedAtOnce) {
  RenderService sut(broken(), boards_, updates_);
  PictureRequest request;
  request.view = 9;
  EXPECT_FALSE(sut.open_pictures(request));
  EXPECT_FALSE(picture_of(sut, request));
  EXPECT_FALSE(picks(sut, 640, 0));
  EXPECT_FALSE(picks(sut, -1, 0));
  EXPECT_EQ(tries_, 0);
}

// Whoever waits for a picture when the gateway ends is told so.
TEST_F(RenderServiceTest, EndAnswersEverybody) {
  std::atomic<int> answers{0};
  {
    RenderService sut(broken(), boards_, updates_);
    for (int i = 0; i < 40; ++i)
      sut.ask_picture({}, ImageFormat::jpeg, [&](const Result<EncodedImage>& picture) {
        EXPECT_FALSE(picture);
        ++answers;
      });
  }
  EXPECT_EQ(answers, 40);
}

}  // namespace
}  // namespace cellmirror::app
