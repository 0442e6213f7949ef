// How the playing of a recording stands, for status, the page and the control socket.
#pragma once

#include <string>

#include "rt_core/base/json_writer.hpp"
#include "rt_core/ports/playback.hpp"

namespace cellmirror::app {

// One object (docs/recording.md).
void add_playback(JsonWriter& out, const PlaybackState& state);
[[nodiscard]] std::string playback_document(const PlaybackState& state);

}  // namespace cellmirror::app
