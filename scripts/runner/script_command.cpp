#include "scripts/runner/script_command.hpp"

#include <fmt/format.h>

namespace cellmirror::script {

std::string CommandSource::text() const {
  switch (kind) {
    case Kind::message:
      return process > 0 ? fmt::format("message from process {}", process) : "message";
    case Kind::page:
      return "monitor page";
    case Kind::mqtt:
      return "MQTT";
    case Kind::file:
    case Kind::program:
      return place;
  }
  return place;
}

void CommandReply::end() {
  if (wanted()) (*this)(fail("the gateway ends"));
}

}  // namespace cellmirror::script
