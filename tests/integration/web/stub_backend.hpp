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
  explicit StubStream(std::atomic<int>& open) : open_(open) { ++open_; }
  ~StubStream() override { --open_; }
  void change(const PictureWish& /*wish*/) override {}
  [[nodiscard]] std::shared_ptr<const EncodedImage> newest(std::uint64_t after) const override {
    auto picture = std::make_shared<EncodedImage>();
    picture->width = 640;
    picture->height = 480;
    picture->bytes.assign(30'000, std::uint8_t{0x55});
    picture->posture_time = SystemClock().now();
    picture->sequence = after + 1;
    return picture;
  }

 private:
  std::atomic<int>& open_;
};

class StubBackend final : public Backend {
 public:
  [[nodiscard]] std::string live_json() override { return R"({"time_s":1})"; }
  [[nodiscard]] std::string status_json() override {
    if (status_throws) throw std::runtime_error("on purpose");
    return R"({"version":"test"})";
  }
  [[nodiscard]] std::string tree_json() override { return "{}"; }
  [[nodiscard]] std::string commands_json() override { return "{}"; }
  [[nodiscard]] std::string names_json() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // a slow one
    return "{}";
  }
  [[nodiscard]] std::string metrics_text() override { return "up 1\n"; }
  void execute(std::string_view command, std::function<void(const CommandReply&)> reply) override {
    const std::scoped_lock lock(mutex);
    commands.emplace_back(command);
    if (command == "LATER") {
      held.push_back(std::move(reply));
    } else {
      reply({command != "BAD", command == "BAD" ? "there is no such command" : ""});
    }
  }
  void expect_pictures() override { ++expected; }
  Result<std::unique_ptr<PictureStream>> open_pictures(const PictureWish& /*wish*/) override {
    return std::make_unique<StubStream>(open_streams);
  }
  Result<EncodedImage> picture(const PictureWish& wish, ImageFormat format) override {
    return EncodedImage{format, wish.width, wish.height, {1, 2, 3}, {}, 1};
  }
  Result<std::optional<PickedObject>> pick(const PictureWish& /*wish*/, int x, int /*y*/) override {
    if (x == 0) return std::nullopt;
    return PickedObject{"Robot.J_1", "ROBOT"};
  }

  std::atomic<int> open_streams{0};
  std::atomic<bool> status_throws{false};
  std::atomic<int> expected{0};  // times that somebody opened the page
  std::mutex mutex;
  std::vector<std::string> commands;
  std::vector<std::function<void(const CommandReply&)>> held;
};

}  // namespace cellmirror::web
