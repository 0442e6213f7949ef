// Names and points as people read them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace cellmirror::app {

// One for each of `paths`: its first and last part where no other path has the same two ("Mantec_1.J_4" for
// "Mantec_1.J_1.J_2.J_3.J_4"), else the whole path; made printable. Commands take such names as well.
[[nodiscard]] std::vector<std::string> short_names(const std::vector<std::string>& paths);

// "1.250 0.000 0.400": to the millimetre, without the sign of a zero.
[[nodiscard]] std::string point_text(const Eigen::Vector3d& p);

}  // namespace cellmirror::app
