// The gateway as the server of the monitor page sees it. Implemented in app/. Called by the threads of the server,
// several at once.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "ipc/web/page_files.hpp"
#include "ipc/web/web_site.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/picture_request.hpp"
#include "rt_core/ports/playback.hpp"
#include "rt_core/ports/scene_stream.hpp"

namespace cellmirror::web {

struct CommandReply {
  bool done = false;
  std::string text;  // empty, or why it was refused, with the remedy
};

// Who sent a command, for the log of commands.
struct CommandOrigin {
  std::uint64_t session = 0;  // number of the connection since the start of the server
  std::string peer;           // as of peer_of()
};

class LiveData;

class Backend : public Site {
 public:
  [[nodiscard]] std::span<const PageFile> files() const override { return page_files(); }
  // Those below, by their paths.
  [[nodiscard]] MakeDocument document(std::string_view path, std::string_view query) override;
  [[nodiscard]] Backend* gateway() override { return this; }

  // The time of what it shows: that of a recording, where one is played.
  [[nodiscard]] virtual const Clock& cell_clock() const { return clock(); }
  // Of that recording; null: real robots. Outlives the server.
  [[nodiscard]] virtual PlaybackPort* playback() { return nullptr; }
  // JSON documents, each made when called. The live one has the keys of `status --json` for the same things
  // (docs/monitor-page.md).
  [[nodiscard]] virtual std::string status_json() = 0;
  [[nodiscard]] virtual std::string tree_json() = 0;         // the tree of the cell with the level shown
  [[nodiscard]] virtual std::string commands_json() = 0;     // as `cellmirror commands --json`; never changes
  [[nodiscard]] virtual std::string names_json() = 0;        // for completion: robots, frames, cameras, sensors, files
  [[nodiscard]] virtual std::string command_log_json() = 0;  // the newest entries of the log of commands
  [[nodiscard]] virtual std::string alarms_json() = 0;       // alarms that are open, and the newest of the others
  [[nodiscard]] virtual std::string metrics_text() = 0;      // Prometheus text format
  // Executes a SCRIPT command of `origin`; `reply` is called once, from another thread, or at once if it is refused.
  virtual void execute(std::string_view command, const CommandOrigin& origin,
                       std::function<void(const CommandReply&)> reply) = 0;
  // A page is being opened and will request pictures soon. Does not wait.
  virtual void expect_pictures() = 0;
  // Starts a stream. Refused, with the reason, if there are too many or pictures are switched off. Errors of rendering
  // (no renderer, a camera that was removed) are reported by the stream's problem().
  virtual Result<std::unique_ptr<PictureStream>> open_pictures(const PictureRequest& request) = 0;
  // One picture; takes some tenths of a second after those requested before. Neither this nor the next one waits:
  // `reply` is called once, from another thread, or at once if it is refused; it may outlive the server.
  virtual void ask_picture(const PictureRequest& request, ImageFormat format, PictureReply reply) = 0;
  // For clients that draw the cell themselves: poses as a stream, and the geometry that they belong to. Neither waits;
  // `reply` as that of ask_picture().
  virtual Result<std::unique_ptr<SceneStream>> open_scene() = 0;
  virtual void ask_geometry(GeometryReply reply) = 0;
  // x, y: pixels in a picture of that request. None: nothing is there.
  virtual void ask_pick(const PictureRequest& request, int x, int y, PickReply reply) = 0;
  // For clients of the Foxglove protocol; null: there are none. Outlives the server.
  [[nodiscard]] virtual LiveData* live_data() { return nullptr; }
};

}  // namespace cellmirror::web
