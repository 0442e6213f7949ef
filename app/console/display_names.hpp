// Names and points as people read them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace cellmirror::app {

// Printable, and of a length that a line has room for.
[[nodiscard]] std::vector<std::string> display_names(std::vector<std::string> names);

// One for each of `paths`, which may repeat: as rt_core/cell/short_names.hpp has them, where these are all that is
// known of the cell; printable.
[[nodiscard]] std::vector<std::string> short_names(const std::vector<std::string>& paths);

// "1.250 0.000 0.400": to the millimetre, without the sign of a zero.
[[nodiscard]] std::string point_text(const Eigen::Vector3d& p);

}  // namespace cellmirror::app
