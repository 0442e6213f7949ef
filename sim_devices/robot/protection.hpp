// `sim_robot dbc --e2e`: which messages carry a counter and a CRC.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/e2e_config.hpp"

namespace cellmirror::sim {

// "MESSAGE:profile=p01,data_id=0x123"; the keys are those of [[stream.e2e]], numbers of a list are divided by '+'.
[[nodiscard]] Result<E2eConfig> parse_protection(std::string_view text);

}  // namespace cellmirror::sim
