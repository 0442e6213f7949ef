// What a new cell is made from, as the command line or the answers of a person say it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cellmirror::app {

struct NewCellRequest {
  std::filesystem::path folder;  // to be made; its last part is the name of the cell
  std::filesystem::path urdf;    // of the robot
  std::string base;              // link that stands at `xyz_m`; empty: the root link
  std::array<double, 3> xyz_m{};
  std::vector<std::filesystem::path> eds;  // EDS or DCF: one for all nodes, or one for each
  std::vector<std::uint8_t> nodes;         // CANopen node ids, 1 to 127, in the order of the joints
  std::filesystem::path dbc;
  std::optional<std::string> topic;  // of the robot's joint states; none: nobody said
  std::string channel = "socketcan:can0";
};

}  // namespace cellmirror::app
