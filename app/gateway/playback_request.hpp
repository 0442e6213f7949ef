// The request {"request":"playback", ...} of the control socket.
#pragma once

#include "ipc/control/control_request.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/playback.hpp"

namespace cellmirror::app {

// play: a boolean; speed; seek_s: seconds after the beginning of what is played, which `now` has.
[[nodiscard]] Result<PlaybackRequest> playback_request(const ControlRequest& request, const PlaybackState& now);

}  // namespace cellmirror::app
