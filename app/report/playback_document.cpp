#include "app/report/playback_document.hpp"

#include "rt_core/base/utc_text.hpp"

namespace cellmirror::app {

namespace {

double since_begin_s(const PlaybackState& state, std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns - state.from_ns);
}

void add_members(JsonWriter& out, const PlaybackState& state) {
  out.member("file", state.file)
      .member("state", word(state.status))
      .member("speed", state.speed)
      .member("from", utc_text_ms(state.from_ns))
      .member("to", utc_text_ms(state.to_ns))
      .member("now", utc_text_ms(state.now_ns))
      .member("now_ns", state.now_ns)
      .member("position_s", since_begin_s(state, state.now_ns))
      .member("length_s", since_begin_s(state, state.to_ns))
      .member("seeks", state.seeks)
      .member("gaps", state.gaps)
      .member("note", state.note)
      .member("mark_count", state.marks ? state.marks->size() : 0);
}

}  // namespace

void add_playback(JsonWriter& out, const PlaybackState& state) {
  out.begin_object();
  add_members(out, state);
  out.end_object();
}

std::string playback_document(const PlaybackState& state) {
  JsonWriter out;
  out.begin_object();
  add_members(out, state);
  out.key("marks").begin_array();
  for (const PlaybackMark& mark : state.marks ? *state.marks : PlaybackMarks()) {
    out.begin_object()
        .member("position_s", since_begin_s(state, mark.time_ns))
        .member("time", utc_text_ms(mark.time_ns))
        .member("kind", word(mark.kind))
        .member("text", std::string_view(mark.text))
        .end_object();
  }
  out.end_array().end_object();
  return out.take();
}

}  // namespace cellmirror::app
