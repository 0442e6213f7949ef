// Ultrasonic sensors (manual 1.2.1) and our own command for collision tests.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

// The choices of both switches are 0 and 1, in this order.
Outcome set_sensor_active(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.sensing.set_sensor_active(command.text(slots::sensor_active::kSensor),
                                                    command.choice(slots::sensor_active::kOn) == 1));
}

Outcome set_send_mode(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.sensing.set_range_send_mode(static_cast<RangeSendMode>(command.choice(kOnlySlot))));
}

Outcome set_sensor_range(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.sensing.set_sensor_range(command.text(slots::sensor_range::kSensor),
                                                   command.number(slots::sensor_range::kRange)));
}

Outcome set_collision_active(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.sensing.set_collision_active(command.choice(kOnlySlot) == 1));
}

Outcome set_collision_warning(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.sensing.set_collision_warning(command.number(kOnlySlot)));
}

Outcome set_collision_pair(const ParsedCommand& command, CommandHost& host) {
  const auto treatment = static_cast<PairTreatment>(command.choice(slots::collision_pair::kTreatment));
  return Outcome::of(host.sensing.set_collision_pair(command.text(slots::collision_pair::kA),
                                                     command.text(slots::collision_pair::kB), treatment));
}

constexpr Registration kHandlers[] = {
    {FormId::set_usspar_active, set_sensor_active},       {FormId::set_usspar_sendmode, set_send_mode},
    {FormId::set_usspar_range, set_sensor_range},         {FormId::set_collpar_active, set_collision_active},
    {FormId::set_collpar_warning, set_collision_warning}, {FormId::set_collpar_pair, set_collision_pair},
};

}  // namespace

std::span<const Registration> sensing_handlers() { return kHandlers; }

}  // namespace cellmirror::script
