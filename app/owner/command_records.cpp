#include "app/owner/command_records.hpp"

#include <utility>

namespace cellmirror::app {

namespace {

const char* word(script::CommandSource::Kind kind) {
  switch (kind) {
    case script::CommandSource::Kind::message:
      return "message";
    case script::CommandSource::Kind::page:
      return "page";
    case script::CommandSource::Kind::mqtt:
      return "mqtt";
    case script::CommandSource::Kind::file:
      return "file";
    case script::CommandSource::Kind::program:
      return "program";
  }
  return "message";
}

}  // namespace

CommandRecord command_record_of(script::CommandTrace trace) {
  return {.wall_ns = to_wall_clock_ns(trace.began),
          .took_s = seconds(trace.ended - trace.began),
          .source = word(trace.source.kind),
          .process = trace.source.process,
          .user = trace.source.user,
          .session = trace.source.session,
          .peer = std::move(trace.source.peer),
          .place = std::move(trace.source.place),
          .run = trace.run,
          .command = std::move(trace.text),
          .done = trace.done,
          .answer = std::move(trace.answer)};
}

CommandRecord refused_command(const script::CommandSource& source, std::string command, std::string why,
                              Timestamp now) {
  script::CommandTrace trace{.source = source, .text = std::move(command), .began = now, .ended = now};
  trace.answer = std::move(why);
  return command_record_of(std::move(trace));
}

}  // namespace cellmirror::app
