#include "app/report/playback_document.hpp"

#include "rt_core/base/utc_text.hpp"

namespace cellmirror::app {

void add_playback(JsonWriter& out, const PlaybackState& state) {
  const auto since_begin_s = [&](std::int64_t ns) { return 1e-9 * static_cast<double>(ns - state.from_ns); };
  out.begin_object()
      .member("file", state.file)
      .member("state", word(state.status))
      .member("speed", state.speed)
      .member("from", utc_text_ms(state.from_ns))
      .member("to", utc_text_ms(state.to_ns))
      .member("now", utc_text_ms(state.now_ns))
      .member("now_ns", state.now_ns)
      .member("position_s", since_begin_s(state.now_ns))
      .member("length_s", since_begin_s(state.to_ns))
      .member("seeks", state.seeks)
      .member("gaps", state.gaps)
      .member("note", state.note)
      .end_object();
}

std::string playback_document(const PlaybackState& state) {
  JsonWriter out;
  add_playback(out, state);
  return out.take();
}

}  // namespace cellmirror::app
