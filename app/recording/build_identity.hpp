// Which program computes here, and with which instructions: another one may give other last bits.
#pragma once

#include <string>
#include <string_view>

namespace cellmirror::app {

// The build id of the running program (GNU note), in hexadecimal; empty where the linker has written none.
[[nodiscard]] std::string build_identity();
// The set of instructions that kernels of the tick are chosen for on this processor: "avx2" or "baseline".
[[nodiscard]] std::string_view compute_target();

}  // namespace cellmirror::app
