// Messages of the server over /live (docs/monitor-page.md). Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/web/web_backend.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::web {

struct Welcome {
  std::string version;
  std::string cell;
  std::string instance;
  std::string run;  // changes with a restart
  bool may_command = false;
  bool read_only = false;
};

[[nodiscard]] std::string welcome_message(const Welcome& welcome);
[[nodiscard]] std::string reply_message(std::int64_t id, const CommandReply& reply);
[[nodiscard]] std::string picked_message(std::int64_t id, const std::optional<PickedObject>& picked);
[[nodiscard]] std::string refused_message(std::int64_t id, std::string_view why);
// `live`: the object of the backend; the member "is" is put before its others.
[[nodiscard]] std::string live_message(std::string_view live);

// {"done": true, "text": "..."}
[[nodiscard]] std::string command_answer(const CommandReply& reply);

inline constexpr std::size_t kPictureHeaderBytes = 32;
// Precedes the bytes of a picture: "CMP1", u32 sequence, u16 width, u16 height, u32 0, f64 age of the posture in s,
// f64 0; little-endian.
[[nodiscard]] std::string picture_header(std::uint32_t sequence, const EncodedImage& picture, Timestamp now);

inline constexpr std::size_t kPosesHeaderBytes = 24;
// Precedes SceneUpdate::poses: "CMS1", u32 sequence, u64 hash of the geometry, f64 age of the posture in s.
[[nodiscard]] std::string poses_header(std::uint32_t sequence, const SceneUpdate& update, Timestamp now);

}  // namespace cellmirror::web
