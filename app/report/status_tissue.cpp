#include "app/report/status_tissue.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "app/report/status_values.hpp"
#include "app/snapshot/tissue_names.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

json attribute_words(std::uint16_t attributes) {
  json words = json::array();
  for (std::size_t bit = 0; bit < kTissueAttributeWords.size(); ++bit)
    if ((attributes >> bit & 1U) != 0) words.push_back(kTissueAttributeWords.at(bit));
  return words;
}

json objects_json(const TissueState& state) {
  json out = json::array();
  for (const TissueObjectState& object : state.objects) {
    out.push_back({{"name", object.name},
                   {"nodes", object.nodes},
                   {"elements", object.elements},
                   {"elements_at_start", object.elements_at_start},
                   {"substeps", object.substeps},
                   {"added_mass_share", object.added_mass_share},
                   {"volume_m3", object.volume_m3},
                   {"contacts", object.contacts},
                   {"inverted", object.inverted},
                   {"parts", object.parts},
                   {"energy_j", object.energy_j},
                   {"coagulated_share", object.coagulated_share},
                   {"attributes", attribute_words(object.attributes)}});
  }
  return out;
}

json instruments_json(const TissueState& state, const CellState& cell) {
  json out = json::array();
  for (const TissueInstrumentState& instrument : state.instruments) {
    out.push_back({{"robot", robot_name(cell, instrument.slot)},
                   {"kind", word(instrument.kind)},
                   {"acting", instrument.acting},
                   {"contacts", instrument.contacts},
                   {"held", instrument.held},
                   {"force_n", vector_json(instrument.force_W)},
                   {"torque_nm", vector_json(instrument.torque_W)}});
  }
  return out;
}

json vessels_json(const TissueState& state) {
  json out = json::array();
  for (const TissueVesselState& vessel : state.vessels) {
    out.push_back({{"object", vessel.object},
                   {"name", vessel.name},
                   {"kind", vessel_word(vessel)},
                   {"clips", vessel.clips},
                   {"severed", vessel.severed},
                   {"bleeding_ml_min", vessel.bleeding_ml_min}});
  }
  return out;
}

json events_json(const TissueState& state, const CellState& cell, Timestamp now) {
  json counts = json::object();
  for (std::size_t kind = 0; kind < kTissueEventWords.size(); ++kind)
    counts[std::string(kTissueEventWords.at(kind))] = state.event_counts.at(kind);
  json last = json::array();
  for (const TissueEvent& event : state.events) {
    const bool limit = event.kind == TissueEventKind::limit;
    last.push_back({{"number", event.number},
                    {"kind", word(event.kind)},
                    {"robot", robot_name(cell, event.instrument)},
                    {"object", object_name(state, event.object)},
                    {"part", part_of(event)},
                    {"limit", limit ? json(word(event.limit)) : json(nullptr)},
                    {"at_m", vector_json(event.at)},
                    {"value", event.value},
                    {"age_s", age_json(now, event.time)}});
  }
  return {{"counts", std::move(counts)}, {"last", std::move(last)}};
}

json action_words(std::uint8_t actions) {
  json words = json::array();
  for (std::size_t bit = 0; bit < kTissueLimitActionWords.size(); ++bit)
    if ((actions >> bit & 1U) != 0) words.push_back(kTissueLimitActionWords.at(bit));
  return words;
}

// `settings`: as SCRIPT has set them; null: not known.
json limits_json(const TissueState& state, const TissueSettings* settings) {
  json out = json::array();
  for (std::size_t limit = 0; limit < kTissueLimits; ++limit) {
    const TissueLimitSetting set = settings != nullptr ? settings->limits.at(limit) : TissueLimitSetting{};
    out.push_back({{"limit", kTissueLimitWords.at(limit)},
                   {"value", set.actions != 0 ? json(set.value) : json(nullptr)},
                   {"actions", action_words(set.actions)},
                   {"excesses", state.excesses.at(limit)}});
  }
  return out;
}

json effects_json(const TissueState& state) {
  json out = json::object();
  for (std::size_t effect = 0; effect < kTissueEffects; ++effect)
    out[std::string(kTissueEffectWords.at(effect))] = state.effects.at(effect);
  return out;
}

}  // namespace

json tissue_json(const std::shared_ptr<const TissueReport>& report, const CellState& cell, Timestamp now) {
  if (!report) return nullptr;
  const TissueState& state = report->state;
  json pool = nullptr;
  if (state.pool_present) pool = {{"level_m", state.pool_level_m}, {"blood", state.pool_blood}};
  return {{"calculating", state.calculating},
          {"step", state.step},
          {"network_shown", cell.tissue && cell.tissue->network_shown},
          {"age_s", age_json(now, state.time)},
          {"rate_hz", report->rate_hz},
          {"late_steps", report->late_steps},
          {"step_us", percentiles_us(report->compute)},
          {"pose_to_force_us", percentiles_us(report->pose_to_force)},
          {"simd", report->simd},
          {"objects", objects_json(state)},
          {"instruments", instruments_json(state, cell)},
          {"vessels", vessels_json(state)},
          {"bleeding_ml_min", state.bleeding_ml_min},
          {"blood_loss_ml", state.blood_loss_ml},
          {"connections", state.connections},
          {"connections_torn", state.connections_torn},
          {"events", events_json(state, cell, now)},
          {"limits", limits_json(state, cell.tissue.get())},
          {"effects", effects_json(state)},
          {"pool", std::move(pool)},
          {"smoke", state.smoke},
          {"lens_fog", state.lens_fog}};
}

}  // namespace cellmirror::app
