// Manual 1.2.7, and of ours what concerns voxel volumes.
#include <cstddef>
#include <optional>
#include <string_view>

#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

// The last argument, ours: empty where it was not given.
std::string_view volume_of(const ParsedCommand& command, const Slot& slot) {
  return command.given(slot) ? command.text(slot) : std::string_view();
}

// VV_SET_LUT_PAR has no MEDICAL_LUT among its choices, which is the first table.
VolumeTable other_table(std::size_t choice) { return static_cast<VolumeTable>(choice + 1); }

Outcome set_plane_mode(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::volume_plane;
  const auto mode =
      command.given(slot::kMode) ? static_cast<VolumePlaneMode>(command.choice(slot::kMode)) : VolumePlaneMode::active;
  return Outcome::with_remark(
      host.volumes.set_plane_mode(command.choice(slot::kPlane), mode, volume_of(command, slot::kVolume)));
}

Outcome set_plane_position(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::volume_plane_position;
  return Outcome::with_remark(host.volumes.set_plane_position(command.choice(slot::kPlane),
                                                              {.elevation_rad = command.number(slot::kElevation),
                                                               .azimuth_rad = command.number(slot::kAzimuth),
                                                               .distance_m = command.number(slot::kDistance)},
                                                              volume_of(command, slot::kVolume)));
}

Outcome set_table(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::volume_table;
  return Outcome::with_remark(host.volumes.set_table(static_cast<VolumeTable>(command.choice(slot::kTable)),
                                                     volume_of(command, slot::kVolume)));
}

Outcome set_medical_table(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::medical_table;
  return Outcome::with_remark(host.volumes.set_medical_table({.air = command.number(slot::kAir),
                                                              .fat = command.number(slot::kFat),
                                                              .tissue = command.number(slot::kTissue),
                                                              .bone = command.number(slot::kBone)},
                                                             volume_of(command, slot::kVolume)));
}

Outcome set_table_parameters(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::volume_table_parameters;
  return Outcome::with_remark(host.volumes.set_table_parameters(other_table(command.choice(slot::kTable)),
                                                                {.opacity = command.number(slot::kOpacity),
                                                                 .gain = command.number(slot::kGain),
                                                                 .level = command.number(slot::kLevel),
                                                                 .window = command.number(slot::kWindow)},
                                                                volume_of(command, slot::kVolume)));
}

Outcome set_surface(const ParsedCommand& command, CommandHost& host) {
  namespace slot = slots::volume_surface;
  constexpr std::size_t kOn = 0;
  const auto value = command.given(slot::kValue) ? std::optional(command.number(slot::kValue)) : std::nullopt;
  return Outcome::with_remark(
      host.volumes.set_surface(command.choice(slot::kOn) == kOn, value, volume_of(command, slot::kVolume)));
}

Outcome reload_tables(const ParsedCommand& command, CommandHost& host) {
  return Outcome::with_remark(host.volumes.reload_tables(volume_of(command, slots::volume_reload::kVolume)));
}

constexpr Registration kHandlers[] = {
    {FormId::vv_clip, set_plane_mode},
    {FormId::vv_clip_pos, set_plane_position},
    {FormId::vv_set_lut, set_table},
    {FormId::vv_set_lut_par_medical, set_medical_table},
    {FormId::vv_set_lut_par, set_table_parameters},
    {FormId::vv_reload_luts, reload_tables},
    {FormId::vv_iso, set_surface},
};

}  // namespace

std::span<const Registration> volume_handlers() { return kHandlers; }

}  // namespace cellmirror::script
