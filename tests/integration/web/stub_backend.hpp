// A gateway for tests of the server: it makes pictures as fast as they are asked for, and does as it is told.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ipc/web/web_backend.hpp"

namespace cellmirror::web {

class StubStream final : public PictureStream {
 public:
  StubStream(std::atomic<int>& open, const std::atomic<bool>& fails) : open_(open), fails_(fails) { ++open_; }
  ~StubStream() override { --open_; }
  void change(const PictureRequest& /*wish*/) override {}
  [[nodiscard]] std::string problem() const override { return fails_ ? "there is no camera C" : ""; }
  [[nodiscard]] std::shared_ptr<const EncodedImage> newest(std::uint64_t has) const override {
    if (fails_) return nullptr;
    auto picture = std::make_shared<EncodedImage>();
    picture->width = 640;
    picture->height = 480;
    picture->bytes.assign(30'000, std::uint8_t{0x55});
    picture->posture_time = SystemClock().now();
    picture->sequence = has + 1;
    return picture;
  }

 private:
  std::atomic<int>& open_;
  const std::atomic<bool>& fails_;
};

class StubScene final : public SceneStream {
 public:
  StubScene(std::atomic<int>& open, Timestamp posture) : open_(open), posture_(posture) { ++open_; }
  ~StubScene() override { --open_; }
  [[nodiscard]] std::shared_ptr<const SceneUpdate> newest(std::uint64_t has) const override {
    auto update = std::make_shared<SceneUpdate>();
    update->sequence = has + 1;
    update->posture_time = posture_;
    update->geometry_hash = 0xABCD;
    update->poses.assign(20'000, 'p');
    update->marks_sequence = 1;
    update->marks = std::make_shared<const std::string>(R"({"is":"marks"})");
    update->tissue_number = 7;
    update->tissue_shape = std::make_shared<const std::string>("CMT1" + std::string(5'000, 't'));
    update->tissue_motion = std::make_shared<const std::string>("CMM1" + std::string(10'000, 'm'));
    return update;
  }

 private:
  std::atomic<int>& open_;
  Timestamp posture_;
};

class StubBackend : public Backend {
 public:
  [[nodiscard]] const Clock& clock() const override { return clock_; }
  [[nodiscard]] std::string live_json() override {
    ++lives;
    return R"({"time_s":1})";
  }
  [[nodiscard]] std::string status_json() override {
    if (status_throws) throw std::runtime_error("on purpose");
    return R"({"version":"test"})";
  }
  [[nodiscard]] std::string tree_json() override { return "{}"; }
  [[nodiscard]] std::string commands_json() override { return "{}"; }
  [[nodiscard]] std::string names_json() override {
    ++names;
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // a slow one
    return "{}";
  }
  [[nodiscard]] std::string command_log_json() override { return "{}"; }
  [[nodiscard]] std::string alarms_json() override { return "{}"; }
  [[nodiscard]] std::string metrics_text() override { return "up 1\n"; }
  [[nodiscard]] Health health() override { return {healthy, healthy ? "ok" : "the loop stands still"}; }
  void execute(std::string_view command, const CommandOrigin& /*origin*/,
               std::function<void(const CommandReply&)> reply) override {
    const std::scoped_lock lock(mutex);
    commands.emplace_back(command);
    if (command == "LATER") {
      held.push_back(std::move(reply));
    } else {
      reply({command != "BAD", command == "BAD" ? "there is no such command" : ""});
    }
  }
  void expect_pictures() override { ++expected; }
  Result<std::unique_ptr<PictureStream>> open_pictures(const PictureRequest& /*wish*/) override {
    return std::make_unique<StubStream>(open_streams, pictures_fail);
  }
  void ask_picture(const PictureRequest& wish, ImageFormat format, PictureReply reply) override {
    const auto give = [reply = std::move(reply),
                       picture = EncodedImage{format, wish.width, wish.height, {1, 2, 3}, {}, 1}] { reply(picture); };
    const std::scoped_lock lock(mutex);
    pictures.push_back(give);
    if (!keep_waiting) give();
  }
  Result<std::unique_ptr<SceneStream>> open_scene() override {
    return std::make_unique<StubScene>(open_scenes, SystemClock().now());
  }
  void ask_geometry(GeometryReply reply) override {
    const auto give = [reply = std::move(reply)] {
      reply(std::make_shared<const SceneGeometry>(SceneGeometry{std::string(1 << 20, 'g'), 0xABCD}));
    };
    const std::scoped_lock lock(mutex);
    geometries.push_back(give);
    if (!keep_waiting) give();
  }
  void ask_pick(const PictureRequest& /*wish*/, int x, int /*y*/, PickReply reply) override {
    const auto give = [x, reply = std::move(reply)] {
      reply(x == 0 ? std::nullopt : std::optional(PickedObject{"Robot.J_1", "ROBOT"}));
    };
    const std::scoped_lock lock(mutex);
    picks.push_back(give);
    if (!keep_waiting) give();
  }

  std::atomic<int> lives{0};  // documents that were made
  std::atomic<int> names{0};
  std::atomic<int> open_streams{0};
  std::atomic<int> open_scenes{0};
  std::atomic<bool> pictures_fail{false};
  std::atomic<bool> status_throws{false};
  std::atomic<bool> healthy{true};
  std::atomic<int> expected{0};           // times that somebody opened the page
  std::atomic<bool> keep_waiting{false};  // whoever asks for a picture or a pick
  std::mutex mutex;
  std::vector<std::function<void()>> pictures;  // that were asked for; each call answers once more
  std::vector<std::function<void()>> picks;
  std::vector<std::function<void()>> geometries;
  std::vector<std::string> commands;
  std::vector<std::function<void(const CommandReply&)>> held;

 private:
  SystemClock clock_;
};

}  // namespace cellmirror::web
