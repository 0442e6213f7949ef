#include "app/workers/drive_contacts.hpp"

#include "rt_core/collision/contact_rates.hpp"

namespace cellmirror::app {

void report_contacts(const CellState& cell_state, const CompiledCell& cell, const CellPoses& poses,
                     const collision::PairTable& table, const ProximityState& found) {
  for (const RobotSnapshot& robot : cell_state.robots) {
    if (robot.contacts) robot.contacts->write(collision::robot_contacts(cell, poses, table, found, robot.slot));
  }
}

void clear_contacts(const CellState& cell_state) {
  for (const RobotSnapshot& robot : cell_state.robots) {
    if (robot.contacts) robot.contacts->write(RobotContacts{});
  }
}

}  // namespace cellmirror::app
