// The section `haptics` of the status document.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/gateway/contact_worker.hpp"
#include "app/gateway/picture.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/tick_state.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json haptics_json(const OwnerPicture& picture, const engine::TickState& tick,
                                          const ContactReport& contacts, Timestamp now);

}  // namespace cellmirror::app
