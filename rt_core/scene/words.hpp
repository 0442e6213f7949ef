// Quantities as labels say them.
#pragma once

#include <string>
#include <string_view>

#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror::scene {

// "34 mm" below a metre, else "1.23 m".
[[nodiscard]] std::string distance_text(double distance_m);
// "0.3 s", "12 s", "4 min", "3 h".
[[nodiscard]] std::string age_text(double age_s);
// "stale", "lost", "invalid", "implausible", "two senders", "no data"; empty for fresh.
[[nodiscard]] std::string_view state_text(DataState state);
// With the unit of the size: 0.2 and "N" gives "0.2 N", 5000 "5 kN".
[[nodiscard]] std::string quantity_text(double value, std::string_view unit);

}  // namespace cellmirror::scene
