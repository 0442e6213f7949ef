// Ipopt 3.11 reads three clocks at the beginning and the end of every small task of every iteration, two of them by the
// system call getrusage: 40 % of the time of a program with six variables, for statistics that it offers to print. They
// are ordinary functions of its shared library that it calls through the procedure linkage table, so those of the
// program itself take precedence. Where they do not, everything works, more slowly.
#include "rt_core/inverse_kinematics/ipopt_clock.hpp"

#include <IpUtils.hpp>

namespace Ipopt {

// Time stands still: Ipopt's own time limit (max_cpu_time) never ends a run. Ours is kept by the callback.
Number CpuTime() { return 0.0; }
Number SysTime() { return 0.0; }
Number WallclockTime() { return 0.0; }

}  // namespace Ipopt

namespace cellmirror::inverse_kinematics {

void use_idle_clocks() {}

}  // namespace cellmirror::inverse_kinematics
