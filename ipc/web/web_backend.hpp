// What the monitor page's server needs to know of the gateway, and nothing else. Implemented in app/. Calls come from
// the server's threads, several at once.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/view.hpp"

namespace cellmirror::web {

// What a client wants to see. One of: the display as SCRIPT has set it (nothing given), a view, a camera, its own free
// view.
struct PictureWish {
  std::optional<int> view;  // 0 to 6
  std::optional<std::string> camera;
  std::optional<View> free_view;
  int width = 640;
  int height = 480;
  double rate_hz = 20;  // at most
  int quality = 80;     // of the JPEG
};

// A stream of pictures for one client. Any thread.
class PictureStream {
 public:
  virtual ~PictureStream() = default;  // ends the stream
  virtual void change(const PictureWish& wish) = 0;
  // The newest picture, if it is another one than that with the sequence `has`; null: there is none yet. Never waits.
  [[nodiscard]] virtual std::shared_ptr<const EncodedImage> newest(std::uint64_t has) const = 0;
  // Why no picture comes of what was wished last; empty: nothing is wrong. Never waits.
  [[nodiscard]] virtual std::string problem() const = 0;
};

struct PickedObject {
  std::string path;   // dotted
  std::string robot;  // it belongs to; may be empty
};

struct CommandReply {
  bool done = false;
  std::string text;  // empty, or why it was refused and what to do
};

using PictureReply = std::function<void(Result<EncodedImage>)>;
using PickReply = std::function<void(Result<std::optional<PickedObject>>)>;

class Backend {
 public:
  virtual ~Backend() = default;
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
  virtual Result<std::unique_ptr<PictureStream>> open_pictures(const PictureWish& wish) = 0;
  // One picture: a few tenths of a second, and those before it. Neither this nor the next one waits: `reply` is called
  // once, from another thread, or at once where it is refused; it may outlive the server.
  virtual void ask_picture(const PictureWish& wish, ImageFormat format, PictureReply reply) = 0;
  // x, y: pixels in a picture of that wish. None: nothing is there.
  virtual void ask_pick(const PictureWish& wish, int x, int y, PickReply reply) = 0;
};

}  // namespace cellmirror::web
