#include "app/gateway/playback_request.hpp"

#include <fmt/format.h>

#include <cmath>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

Result<PlaybackRequest> playback_request(const ControlRequest& request, const PlaybackState& now) {
  PlaybackRequest out;
  for (const auto& [name, text] : request.arguments) {
    if (name == "play") {
      if (text != "true" && text != "false") return fail("play is neither true nor false");
      out.play = text == "true";
      continue;
    }
    const auto number = parse_number(text);
    if (name != "speed" && name != "seek_s")
      return fail(fmt::format("the member {} is not known", printable(name)), "known: play, speed, seek_s");
    if (!number || !std::isfinite(*number)) return fail(fmt::format("{} is not a number", name));
    if (name == "speed") {
      out.speed = number;
    } else {
      out.seek_ns = playback_time_ns(now, *number);
    }
  }
  return out;
}

}  // namespace cellmirror::app
