// Manual 1.2.5, and of 1.2.6 what concerns deformable objects and the instruments that act on them.
#include <cstddef>
#include <cstdint>

#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

// Of the switch "on | off".
bool is_on(const ParsedCommand& command, std::size_t slot) {
  constexpr std::size_t kOn = 0;
  return command.choice(slot) == kOn;
}

Outcome set_attributes(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::tissue_attributes;
  return Outcome::with_remark(host.tissue.set_attributes(command.text(slot::kObject), kAllTissueAttributes,
                                                         static_cast<std::uint16_t>(command.integer(slot::kFlags))));
}

Outcome set_attribute(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::tissue_attribute;
  const auto bit = static_cast<std::uint16_t>(1U << command.choice(slot::kToken));
  const std::uint16_t value = is_on(command, slot::kOn) ? bit : std::uint16_t{0};
  return Outcome::with_remark(host.tissue.set_attributes(command.text(slot::kObject), bit, value));
}

Outcome set_cylinders(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::effector_cylinders;
  return Outcome::with_remark(host.tissue.set_cylinders(
      command.text(slot::kGeometry), {.flags = static_cast<std::uint32_t>(command.integer(slot::kFlags)),
                                      .shaft_diameter_m = command.number(slot::kShaftDiameter),
                                      .effector_radius_m = command.number(slot::kEffectorRadius),
                                      .effector_length_m = command.number(slot::kEffectorLength),
                                      .fourth = command.number(slot::kFourth)}));
}

Outcome set_connections(const ParsedCommand& command, CommandHost& host) {
  return Outcome::with_remark(host.tissue.set_connections(command.text(kOnlySlot)));
}

// The choices are 0 and 1, in this order.
Outcome show_network(const ParsedCommand& command, CommandHost& host) {
  return Outcome::with_remark(host.tissue.set_network_shown(command.choice(kOnlySlot) == 1));
}

Outcome reset_model(const ParsedCommand& /*command*/, CommandHost& host) {
  return Outcome::with_remark(host.tissue.reset_model());
}

Outcome set_limit(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::tissue_limit;
  return Outcome::with_remark(host.tissue.set_limit(static_cast<TissueLimit>(command.choice(slot::kToken)),
                                                    static_cast<std::uint8_t>(command.integer(slot::kFlags)),
                                                    command.number(slot::kValue)));
}

template <TissueEffect kEffect>
Outcome set_effect(const ParsedCommand& command, CommandHost& host) {
  return Outcome::with_remark(host.tissue.set_effect(kEffect, is_on(command, kOnlySlot)));
}

Outcome reset_pool(const ParsedCommand& /*command*/, CommandHost& host) {
  return Outcome::with_remark(host.tissue.reset_pool());
}

Outcome clean_lens(const ParsedCommand& /*command*/, CommandHost& host) {
  return Outcome::with_remark(host.tissue.clean_lens());
}

Outcome set_calculating(const ParsedCommand& command, CommandHost& host) {
  return Outcome::with_remark(host.tissue.set_calculating(is_on(command, kOnlySlot)));
}

// SCRIPT counts joints from 1. The numbers of tests and instruments are the manual's, and so are those of the enums.
Outcome set_trigger(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::instrument;
  return Outcome::with_remark(
      host.tissue.set_trigger({.joint = static_cast<std::size_t>(command.integer(slot::kJoint) - 1),
                               .test = static_cast<InstrumentTest>(command.choice(slot::kTest)),
                               .value_1 = command.number(slot::kFirstValue),
                               .value_2 = command.number(slot::kSecondValue),
                               .kind = static_cast<InstrumentKind>(command.choice(slot::kKind))}));
}

Outcome set_clip(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::clip;
  const Pose X_TC = pose_from_xyz_rpy(vector_at(command, slot::kTranslation), vector_at(command, slot::kRotation));
  return Outcome::with_remark(host.tissue.set_clip(command.text(slot::kFile), X_TC));
}

constexpr Registration kHandlers[] = {
    {FormId::eladyn_geo_def_flags, set_attributes},
    {FormId::eladyn_geo_def_token, set_attribute},
    {FormId::eladyn_hyper_name, set_connections},
    {FormId::eladyn_show_def, show_network},
    {FormId::eladyn_model_reset, reset_model},
    {FormId::eladyn_plaus_param, set_limit},
    {FormId::effects_pulse, set_effect<TissueEffect::pulse>},
    {FormId::effects_bleeding, set_effect<TissueEffect::bleeding>},
    {FormId::effects_pool_ripples, set_effect<TissueEffect::pool_ripples>},
    {FormId::effects_reset_pool, reset_pool},
    {FormId::effects_clean_endoscopic_lense, clean_lens},
    {FormId::effects_suction, set_effect<TissueEffect::suction>},
    {FormId::effects_irrigation, set_effect<TissueEffect::irrigation>},
    {FormId::eladyn_calc, set_calculating},
    {FormId::rob_ela_interact, set_trigger},
    {FormId::ela_clip_def, set_clip},
    {FormId::eladyn_geo_def_cylinders, set_cylinders},
};

}  // namespace

std::span<const Registration> elastodynamic_handlers() { return kHandlers; }

}  // namespace cellmirror::script
