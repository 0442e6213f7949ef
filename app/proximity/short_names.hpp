// Names of bodies for people: "Mantec_1.J_4" for "Mantec_1.J_1.J_2.J_3.J_4" where only one body can be meant. Commands
// take such names as well.
#pragma once

#include <string>
#include <vector>

namespace cellmirror::app {

// One for each of `paths`: its first and last part where no other path has the same two, else the whole path; made
// printable.
[[nodiscard]] std::vector<std::string> short_names(const std::vector<std::string>& paths);

}  // namespace cellmirror::app
