#include "scripts/commands/execute.hpp"

#include <fmt/format.h>

#include <array>

#include "rt_core/base/contract.hpp"
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

using Handlers = std::array<Handler, kFormCount>;

Handlers collect_handlers() {
  Handlers handlers{};
  for (const auto section : {general_handlers(), robot_parameter_handlers(), animation_handlers(), dynamics_handlers(),
                             elastodynamic_handlers(), channel_handlers(), volume_handlers(), motion_handlers(),
                             program_handlers(), sensing_handlers(), own_handlers()}) {
    for (const Registration& registration : section) {
      Handler& place = handlers[static_cast<std::size_t>(registration.id)];
      CELLMIRROR_EXPECTS(place == nullptr);
      place = registration.handler;
    }
  }
  return handlers;
}

Handler handler_of(FormId id) {
  static const Handlers handlers = collect_handlers();
  return handlers[static_cast<std::size_t>(id)];
}

}  // namespace

Outcome execute(const ParsedCommand& command, CommandHost& host) {
  const Handler handler = handler_of(command.id());
  CELLMIRROR_EXPECTS(handler != nullptr);
  // The parser returns an executable command only if the kinds of the joints were known.
  if (!command.converted()) {
    return Outcome::refused({fmt::format("{}: the joints of the robot are not known", command.form().name), {}});
  }
  return handler(command, host);
}

bool has_handler(FormId id) { return handler_of(id) != nullptr; }

}  // namespace cellmirror::script
