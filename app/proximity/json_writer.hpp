// JSON of frames, piece by piece: a frame has few values, a run may have millions of frames.
#pragma once

#include <Eigen/Core>
#include <string>

namespace cellmirror::app {

// A text of any bytes as a JSON string; what is no UTF-8 is replaced.
[[nodiscard]] std::string json_text(const std::string& text);

// The shortest digits that give the same double again; null for what is not finite, which JSON cannot hold.
[[nodiscard]] std::string json_number(double value);
[[nodiscard]] std::string json_point(const Eigen::Vector3d& p);

}  // namespace cellmirror::app
