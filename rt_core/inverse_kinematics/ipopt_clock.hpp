// Internal to the folder.
#pragma once

namespace cellmirror::inverse_kinematics {

// Makes the linker take the clocks of ipopt_clock.cpp into the program.
void use_idle_clocks();

}  // namespace cellmirror::inverse_kinematics
