// The question for a picture over the control socket (docs/messages.md), and its answer: both sides.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/control/control_request.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/picture_request.hpp"

namespace cellmirror::app {

struct SnapshotRequest {
  std::optional<int> view;
  std::optional<std::string> camera;
  std::optional<int> width;  // else as the cell file says
  std::optional<int> height;
  int quality = 90;
  ImageFormat format = ImageFormat::png;
};

// {"request": "snapshot", "view": 0 to 6 or "camera": NAME, "width", "height", "quality", "format": "png" or "jpeg"}
[[nodiscard]] ControlRequest question(const SnapshotRequest& wanted);
// Refused: a member that is unknown or no number. What the numbers may be is the studio's to check.
[[nodiscard]] Result<SnapshotRequest> snapshot_request(const ControlRequest& request);
[[nodiscard]] PictureRequest wish_of(const SnapshotRequest& wanted, int width, int height);

struct SnapshotAnswer {
  ImageFormat format = ImageFormat::png;
  int width = 0;
  int height = 0;
  std::uint64_t sequence = 0;
  double posture_age_s = 0;
  std::vector<std::uint8_t> bytes;
};

// {"format", "width", "height", "sequence", "posture_age_s", "data": the file in base64}
[[nodiscard]] std::string answer_text(const EncodedImage& picture, double posture_age_s);
[[nodiscard]] Result<SnapshotAnswer> snapshot_answer(std::string_view text);

}  // namespace cellmirror::app
