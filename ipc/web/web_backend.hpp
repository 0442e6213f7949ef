// What the monitor page's server needs to know of the gateway, and nothing else. Implemented in app/. Calls come from
// the server's threads, several at once.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/picture_request.hpp"

namespace cellmirror::web {

struct CommandReply {
  bool done = false;
  std::string text;  // empty, or why it was refused and what to do
};

class Backend {
 public:
  virtual ~Backend() = default;
  // The time of everything that the server does; outlives it.
  [[nodiscard]] virtual const Clock& clock() const = 0;
  // JSON documents, made anew. What the page shows a few times a second: small, the same keys as `status --json` where
  // they are the same thing (docs/monitor-page.md).
  [[nodiscard]] virtual std::string live_json() = 0;
  [[nodiscard]] virtual std::string status_json() = 0;
  [[nodiscard]] virtual std::string tree_json() = 0;      // the tree of the cell, what is shown at which level
  [[nodiscard]] virtual std::string commands_json() = 0;  // as `cellmirror commands --json`; never changes
  [[nodiscard]] virtual std::string names_json() = 0;     // for completion: robots, frames, cameras, sensors, files
  [[nodiscard]] virtual std::string metrics_text() = 0;   // Prometheus text format
  // Executes a SCRIPT command; `reply` is called once, from another thread, or at once where there is no room.
  virtual void execute(std::string_view command, std::function<void(const CommandReply&)> reply) = 0;
  // Somebody opens the page and will want pictures in a moment. Does not wait.
  virtual void expect_pictures() = 0;
  // Starts a stream. Refused where there are too many or pictures are switched off; says why. What turns out only when
  // it is drawn (no renderer, a camera that is gone) is the stream's problem().
  virtual Result<std::unique_ptr<PictureStream>> open_pictures(const PictureRequest& wish) = 0;
  // One picture: a few tenths of a second, and those before it. Neither this nor the next one waits: `reply` is called
  // once, from another thread, or at once where it is refused; it may outlive the server.
  virtual void ask_picture(const PictureRequest& wish, ImageFormat format, PictureReply reply) = 0;
  // x, y: pixels in a picture of that wish. None: nothing is there.
  virtual void ask_pick(const PictureRequest& wish, int x, int y, PickReply reply) = 0;
};

}  // namespace cellmirror::web
