// How the playing of a recording stands, for status, the page and the control socket.
#pragma once

#include <string>

#include "rt_core/base/json_writer.hpp"
#include "rt_core/ports/playback.hpp"

namespace cellmirror::app {

// One object (docs/recording.md), without the marks: several times a second.
void add_playback(JsonWriter& out, const PlaybackState& state);
// With them.
[[nodiscard]] std::string playback_document(const PlaybackState& state);

}  // namespace cellmirror::app
