#include "app/report/status_haptics.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "app/report/status_values.hpp"
#include "app/snapshot/haptic_names.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

json counted_percentiles_us(const HistogramSnapshot& snapshot) {
  json out = percentiles_us(snapshot);
  out["count"] = snapshot.count();
  return out;
}

json memory_json(const HapticSnapshot& haptic) {
  if (!haptic.key) return nullptr;
  return {{"key", *haptic.key}, {"bytes", haptic.bytes}, {"attached", haptic.attached}, {"renewed", haptic.renewed}};
}

json device_json(const HapticSnapshot& haptic, const HapticState& state, Timestamp now) {
  return {{"process", state.device_writer},    {"gone", haptic.device_gone},
          {"sequence", state.device_sequence}, {"age_s", age_json(now, state.device_time)},
          {"buttons", state.buttons},          {"samples", state.samples},
          {"skipped", state.skipped},          {"torn", state.torn}};
}

json force_json(const HapticState& state, std::size_t joints) {
  const auto end = state.joint_torques.begin() + static_cast<std::ptrdiff_t>(joints);
  return {{"world_n", vector_json(state.force_W)},
          {"end_effector_n", vector_json(state.force_E)},
          {"axis_torque_nm", state.axis_torque},
          {"joint_efforts", std::vector<double>(state.joint_torques.begin(), end)},
          {"contacts", state.contacts},
          {"saturated", state.saturated}};
}

json model_json(const HapticState& state, const haptics::ContactModel& model, Timestamp now) {
  return {{"age_s", age_json(now, state.model_time)},
          {"constraints", model.count},
          {"certain", model.certain},
          {"reach_m", model.reach},
          {"awaited", state.awaits_surroundings},
          {"appeared", state.appeared}};
}

json settings_json(const haptics::HapticSettings& s) {
  return {{"drive", s.drive == haptics::Drive::pose ? "pose" : "joints"},
          {"workspace_scale", s.workspace_scale},
          {"force_scale", s.force_scale},
          {"stiffness_n_m", s.stiffness},
          {"damping_n_s_m", s.damping},
          {"static_friction", s.static_friction},
          {"dynamic_friction", s.dynamic_friction},
          {"max_force_n", s.max_force},
          {"max_slew_n_s", s.max_slew},
          {"max_speed_m_s", s.max_speed},
          {"engage_time_s", seconds(s.engage_time)},
          {"profile", s.profile == haptics::HapticProfile::strict ? "strict" : "desktop"},
          {"re_engage", s.re_engage},
          {"stale_after_s", seconds(s.stale_after)},
          {"model_stale_after_s", seconds(s.model_stale_after)},
          {"allowed_missed_periods", s.allowed_missed_periods},
          {"passivity_control", s.passivity_control}};
}

json haptic_json(const HapticSnapshot& haptic, const engine::TickState& tick, const ContactReport& contacts,
                 Timestamp now) {
  const HapticState& state = tick.haptics[haptic.channel];
  return {{"robot", haptic.robot},
          {"online", haptic.online},
          {"phase", word(state.phase)},
          {"fault", word(state.fault)},
          {"fault_note", explanation(state.fault)},
          {"remedy", remedy(state.fault)},
          {"faults", state.faults},
          {"resets", state.resets},
          {"re_engagements", state.re_engagements},
          {"awaits", word(state.awaited)},
          {"awaits_note", explanation(state.awaited)},
          {"memory", memory_json(haptic)},
          {"device", device_json(haptic, state, now)},
          {"device_position_m", vector_json(state.x_device)},
          {"proxy_position_m", vector_json(state.x_proxy)},
          {"force", force_json(state, tick.robots[haptic.slot].joint_count)},
          {"tissue_force_n", vector_json(state.tissue_force_W)},
          {"tissue_age_s", age_json(now, state.tissue_time)},
          {"tissue",
           {{"contacts", state.tissue_contacts},
            {"held", state.tissue_held},
            {"late", state.tissue_late},
            {"refused", state.tissue_refused}}},
          {"energy_j", state.energy},
          {"passivity_damping_n_s_m", state.passivity_damping},
          {"contact_model", model_json(state, contacts.newest[haptic.channel], now)},
          {"latency_us", counted_percentiles_us(haptic.meter->latency.snapshot())},
          {"settings", settings_json(haptic.settings)}};
}

json tcp_force_json(const CellState& cell_state, Timestamp now) {
  if (!cell_state.tcp_force) return nullptr;
  const TcpForceReport report = cell_state.tcp_force->report();
  const auto& v = report.newest.values;
  return {{"key", cell_state.tcp_force->key()},
          {"robot", std::string(report.newest.robot.view())},
          {"force_n", {v[0], v[1], v[2]}},
          {"torque_nm", v[3]},
          {"valid", (report.newest.flags & kTcpForceValid) != 0},
          {"test", (report.newest.flags & kTcpForceTest) != 0},
          {"beyond_limit", (report.newest.flags & kTcpForceBeyondLimit) != 0},
          {"times_beyond", report.times_beyond},
          {"max_force_n", cell_state.forces.limits.max_force},
          {"max_torque_nm", cell_state.forces.limits.max_torque},
          {"written", report.newest.sequence},
          {"age_s", age_json(now, report.newest.time)}};
}

json robot_forces_json(const CellState& cell_state) {
  json buffers = json::array();
  for (const RobotForceSnapshot& buffer : cell_state.robot_forces) {
    buffers.push_back({{"robot", buffer.robot},
                       {"key", buffer.key},
                       {"bytes", buffer.bytes},
                       {"attached", buffer.attached},
                       {"renewed", buffer.renewed}});
  }
  return buffers;
}

}  // namespace

json haptics_json(const CellState& cell_state, const engine::TickState& tick, const ContactReport& contacts,
                  Timestamp now) {
  json devices = json::array();
  for (const HapticSnapshot& haptic : cell_state.haptics) devices.push_back(haptic_json(haptic, tick, contacts, now));
  return {{"devices", std::move(devices)},
          {"contact_models",
           {{"rate_hz", contacts.rate_hz},
            {"skipped", contacts.skipped},
            {"compute_us", counted_percentiles_us(contacts.compute)},
            {"visible_after_us", counted_percentiles_us(contacts.visible_after)},
            {"adopting_us", counted_percentiles_us(contacts.adopting)}}},
          {"tcp_force", tcp_force_json(cell_state, now)},
          {"robot_forces", robot_forces_json(cell_state)}};
}

}  // namespace cellmirror::app
