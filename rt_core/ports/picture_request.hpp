// Which rendered image is wanted, and how it is delivered: between the renderer and its clients. Plain data and one
// interface.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/view.hpp"

namespace cellmirror {

// At most one of view, camera and free view; none of them: the display as SCRIPT has set it.
struct PictureRequest {
  std::optional<int> view;  // 0 to 6
  std::optional<std::string> camera;
  std::optional<View> free_view;
  int width = 640;  // pixels
  int height = 480;
  double rate_hz = 20;  // at most
  int quality = 80;     // of the JPEG, 1 to 100
};

// A stream of pictures for one client. Any thread.
class PictureStream {
 public:
  virtual ~PictureStream() = default;  // ends the stream
  virtual void change(const PictureRequest& request) = 0;
  // The newest picture, unless its sequence is `has`; null: there is none yet. Never waits.
  [[nodiscard]] virtual std::shared_ptr<const EncodedImage> newest(std::uint64_t has) const = 0;
  // Why there is no picture of the latest request; empty: nothing is wrong. Never waits.
  [[nodiscard]] virtual std::string problem() const = 0;
};

// The object that a pixel of a picture shows.
struct PickedObject {
  std::string path;   // dotted
  std::string robot;  // it belongs to; may be empty
};

using PictureReply = std::function<void(Result<EncodedImage>)>;
using PickReply = std::function<void(Result<std::optional<PickedObject>>)>;

}  // namespace cellmirror
