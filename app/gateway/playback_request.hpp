// The request {"request":"playback", ...} of the control socket.
#pragma once

#include "ipc/control/control_request.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/playback.hpp"

namespace cellmirror::app {

// play: a boolean; speed; seek_s: seconds behind the begin of what is played. `now` has where that begins.
[[nodiscard]] Result<PlaybackRequest> playback_request(const ControlRequest& request, const PlaybackState& now);

}  // namespace cellmirror::app
