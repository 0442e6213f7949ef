// The gateway as the monitor page's server sees it.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "app/live/live_gateway.hpp"
#include "app/owner/cell_owner.hpp"
#include "app/render/render_service.hpp"
#include "app/render/scene_service.hpp"
#include "app/report/live_document.hpp"
#include "app/report/status_alarms.hpp"
#include "app/report/status_commands.hpp"
#include "app/snapshot/cell_state.hpp"
#include "ipc/web/web_backend.hpp"
#include "ipc/web/web_server.hpp"

namespace cellmirror::app {

class WebBackend final : public web::Backend {
 public:
  // None of what is pointed to is owned; all of it outlives the backend.
  struct Parts {
    const Clock* clock = nullptr;       // of the server
    const Clock* cell_clock = nullptr;  // of what it shows
    PlaybackPort* playback = nullptr;   // null: real robots
    const KismetHome* home = nullptr;
    LiveTopics* topics = nullptr;
    double loop_rate_hz = 0;
    const Board<CellState>* board = nullptr;
    CellOwner* owner = nullptr;
    RenderService* renderer = nullptr;  // null: no pictures
    SceneService* scene = nullptr;
    std::function<std::string()> status;  // as `cellmirror status --json`
    std::function<web::Health()> health;
    std::function<void(const std::function<void(const LiveSources&)>&)> at;  // hands in everything as of now
    std::function<web::ServerStatus()> server_status;
    std::function<CommandLogReport()> command_log;
    std::function<AlarmReport()> alarms;
    // With each command that is refused before it reaches the owner.
    std::function<void(std::string_view command, const script::CommandSource& source, const std::string& why)> refused;
  };

  explicit WebBackend(Parts parts);

  [[nodiscard]] const Clock& clock() const override { return *parts_.clock; }
  [[nodiscard]] const Clock& cell_clock() const override { return *parts_.cell_clock; }
  [[nodiscard]] PlaybackPort* playback() override { return parts_.playback; }
  [[nodiscard]] std::string live_json() override;
  [[nodiscard]] std::string status_json() override { return parts_.status(); }
  [[nodiscard]] std::string tree_json() override;
  [[nodiscard]] std::string commands_json() override;
  [[nodiscard]] std::string names_json() override;
  [[nodiscard]] std::string command_log_json() override { return command_log_document(parts_.command_log()); }
  [[nodiscard]] std::string alarms_json() override {
    return alarms_document(parts_.alarms(), parts_.cell_clock->now());
  }
  [[nodiscard]] std::string metrics_text() override;
  [[nodiscard]] web::Health health() override { return parts_.health(); }
  void execute(std::string_view command, const web::CommandOrigin& origin,
               std::function<void(const web::CommandReply&)> reply) override;
  void expect_pictures() override;
  Result<std::unique_ptr<PictureStream>> open_pictures(const PictureRequest& request) override;
  void ask_picture(const PictureRequest& request, ImageFormat format, PictureReply reply) override;
  Result<std::unique_ptr<SceneStream>> open_scene() override { return parts_.scene->open(); }
  void ask_geometry(GeometryReply reply) override { parts_.scene->ask_geometry(std::move(reply)); }
  void ask_pick(const PictureRequest& request, int x, int y, PickReply reply) override;
  [[nodiscard]] web::LiveData* live_data() override { return &live_; }

 private:
  static constexpr std::uint64_t kMostCommandsWaiting = 512;  // for their acknowledgement

  Parts parts_;
  // Replies outlive the backend: the owner, which ends after it, answers what it still has.
  std::shared_ptr<std::atomic<std::uint64_t>> commands_waiting_ = std::make_shared<std::atomic<std::uint64_t>>(0);
  TreeRevision tree_revision_;
  std::mutex mutex_;  // of the window
  LoopWindow window_;
  LiveGateway live_;
};

}  // namespace cellmirror::app
