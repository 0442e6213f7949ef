// Messages of clients over /live (docs/monitor-page.md). Pure: text in, values out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "ipc/web/web_backend.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::web {

inline constexpr int kSmallestPictureEdge = 16;  // pixels
inline constexpr int kLargestPictureWidth = 1920;
inline constexpr int kLargestPictureHeight = 1200;
inline constexpr double kFewestPicturesPerSecond = 0.01;
inline constexpr double kMostPicturesPerSecond = 60;
inline constexpr std::size_t kMaxCommandBytes = 8000;

struct HelloMessage {
  std::string token;  // may be empty
};
struct PictureMessage {
  PictureRequest request;
};
struct NoPictureMessage {};
struct ShownMessage {
  std::uint32_t sequence = 0;
};
struct SceneMessage {};
struct NoSceneMessage {};
struct PosedMessage {
  std::uint32_t sequence = 0;
};
struct CommandMessage {
  std::int64_t id = 0;
  std::string text;
};
struct PickMessage {
  std::int64_t id = 0;
  int x = 0;
  int y = 0;
};
// Of a recording that is played.
struct PlaybackMessage {
  std::optional<bool> play;
  std::optional<double> speed;
  std::optional<double> seek_s;  // after the beginning of what is played
};
using ClientMessage = std::variant<HelloMessage, PictureMessage, NoPictureMessage, ShownMessage, SceneMessage,
                                   NoSceneMessage, PosedMessage, CommandMessage, PickMessage, PlaybackMessage>;

struct BadMessage {
  std::int64_t id = 0;  // of the message, where it has one
  std::string why;
};

// Never throws; its cost is bounded by the length of the text. Unknown members are ignored, so that a newer page works
// with an older gateway.
[[nodiscard]] std::expected<ClientMessage, BadMessage> read_client_message(std::string_view text);

// Refused if sizes, rate, quality or the free view are out of bounds, or more than one of view, camera and free
// view is given.
[[nodiscard]] Result<void> check_picture_request(const PictureRequest& request);

// "view=3&width=640&height=480" of /snapshot.png and /snapshot.jpg.
[[nodiscard]] Result<PictureRequest> read_picture_query(std::string_view query);

}  // namespace cellmirror::web
