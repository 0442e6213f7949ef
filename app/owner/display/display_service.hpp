// Keeps what SCRIPT has set of the picture, views and cameras (manual 1.2.1, 1.2.3, 1.2.6) and publishes it as
// an immutable DisplayState. Draws nothing. Belongs to the thread that owns the cell. docs/script.md, "The picture",
// says what the commands mean.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/home.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/cell/view.hpp"
#include "scripts/commands/display_host.hpp"
#include "scripts/lang/names.hpp"

namespace cellmirror::app {

// Floor, shadows, textures, antialiasing and the visibility test are on.
[[nodiscard]] DisplayModes initial_modes();
// Before any command: views that show the whole extent as the layout has them, and what the cell file says of them.
// Settings that do not fit are left out and told to the log.
[[nodiscard]] DisplayState initial_display(const CompiledCell& cell, const Extent& extent,
                                           std::span<const ViewSetting> settings, DisplayLayout layout = {});

class DisplayService final : public DisplayHost {
 public:
  static constexpr std::size_t kKeptMessages = 8;
  static constexpr Nanoseconds kMessageTime{5'000'000'000};  // "for about 5 seconds", manual 1.2.6
  static constexpr double kNominalRate = 20;                 // updates of the picture a second, where nobody counts

  // All of it outlives the service.
  struct Parts {
    Cell& cell;
    const NameDirectory& names;  // knows the active robot
    const KismetHome& home;
    const Clock& clock;
    std::function<std::span<const JointValues>()> positions;  // of the robots, by slot
    std::function<std::uint64_t()> picture_updates;           // so far; empty: by the clock, at the nominal rate
    std::function<void()> bell;                               // with a message while BEEP is on; empty: none
    std::function<bool(std::size_t slot)> is_online;          // the robot is mirrored now; empty: none ever is
    std::function<void(const ShownText& message)> message_shown = {};  // with every message; the state keeps the newest
  };

  DisplayService(Parts parts, std::span<const ViewSetting> settings, DisplayLayout layout = {});

  Result<void> set_display(int display, bool full_screen) override;
  Result<void> set_view(int view, const ViewChange& change, const ViewPace& pace) override;
  Result<void> connect_view(int view, std::string_view camera) override;
  Result<void> load_views(std::string_view file) override;
  Result<void> save_views(std::string_view file) override;
  Result<void> set_mode(DisplayMode mode, bool on) override;
  Result<void> set_legend(bool on) override;
  Result<std::string> set_draw_mode(std::string_view node, bool branch, DrawMode mode) override;
  Result<void> set_tag_length(double length_m) override;
  Result<void> set_camera(std::string_view camera, double focal_distance_m, double fovy_rad) override;
  Result<void> track(std::string_view camera, std::optional<std::string_view> frame) override;
  Result<void> show_pyramid(std::string_view camera, bool on) override;
  Result<void> set_camera_online(std::string_view camera, bool on) override;
  Result<void> set_arc(bool on) override;
  Result<void> show_message(std::string_view text) override;

  // Ends what has come to its end (sequences, messages), and lets go of cameras, frames and robots that the cell does
  // not have any more. Often.
  void follow();
  // A view is on its way: WAIT waits.
  [[nodiscard]] bool busy() const;
  // The same object as long as nothing changes.
  [[nodiscard]] std::shared_ptr<const DisplayState> state();
  // R_WS of the screen, x to the right, y up, z out of it towards the viewer: of the current view as it is now, on its
  // sequence or at its camera.
  [[nodiscard]] Eigen::Matrix3d screen_axes();

 private:
  DisplayView& view(int id) { return state_.views[static_cast<std::size_t>(id)]; }
  [[nodiscard]] std::uint64_t updates() const;
  [[nodiscard]] View view_now(int id);
  [[nodiscard]] bool has_ended(const ViewSequence& sequence) const;
  void follow_cell();
  void changed();
  // What the state calls the camera: its bare name, or its path where others have the same name.
  [[nodiscard]] Result<std::string> camera_name(std::string_view camera) const;
  // It is the current camera from now on.
  [[nodiscard]] Result<CameraSetting*> select_camera(std::string_view camera);
  void follow_carriers();
  void follow_targets();
  [[nodiscard]] bool is_elsewhere(NodeId camera, NodeId target) const;
  Result<void> set_planes_at_camera(int id, const ViewChange& change);
  [[nodiscard]] bool has_own_geometry(NodeId node) const;

  Parts parts_;
  DisplayState state_;
  std::shared_ptr<const DisplayState> shared_;  // null: something has changed since
  std::uint64_t cell_revision_ = 0;             // that state_.cameras is of
  std::vector<std::string> camera_paths_;       // of state_.cameras: their names there may change
  std::uint64_t messages_shown_ = 0;
  CellPoses poses_;
};

}  // namespace cellmirror::app
