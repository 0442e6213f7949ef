#include "app/report/live_tissue.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "app/snapshot/tissue_names.hpp"
#include "rt_core/base/microseconds.hpp"

namespace cellmirror::app {

namespace {

// Keep the document small.
constexpr std::size_t kMostRows = 50;
constexpr std::size_t kMostEvents = 12;

void add_objects(JsonWriter& out, const TissueState& state) {
  out.key("objects").begin_array();
  for (std::size_t i = 0; i < std::min(kMostRows, state.objects.size()); ++i) {
    const TissueObjectState& object = state.objects[i];
    out.begin_object()
        .member("name", object.name)
        .member("nodes", object.nodes)
        .member("elements", object.elements)
        .member("contacts", object.contacts)
        .member("parts", object.parts)
        .member("coagulated_share", object.coagulated_share)
        .member("frozen", !has(object.attributes, TissueAttribute::calculate))
        .end_object();
  }
  out.end_array();
}

void add_instruments(JsonWriter& out, const TissueState& state, const CellState& cell) {
  out.key("instruments").begin_array();
  for (const TissueInstrumentState& instrument : state.instruments) {
    out.begin_object()
        .member("robot", robot_name(cell, instrument.slot))
        .member("kind", word(instrument.kind))
        .member("acting", instrument.acting)
        .member("contacts", instrument.contacts)
        .member("held", instrument.held)
        .member("force_n", instrument.force_W.norm())
        .end_object();
  }
  out.end_array();
}

void add_vessels(JsonWriter& out, const TissueState& state) {
  out.key("vessels").begin_array();
  for (std::size_t i = 0; i < std::min(kMostRows, state.vessels.size()); ++i) {
    const TissueVesselState& vessel = state.vessels[i];
    out.begin_object()
        .member("object", vessel.object)
        .member("name", vessel.name)
        .member("kind", vessel_word(vessel))
        .member("clips", vessel.clips)
        .member("severed", vessel.severed)
        .member("bleeding_ml_min", vessel.bleeding_ml_min)
        .end_object();
  }
  out.end_array();
}

void add_events(JsonWriter& out, const TissueState& state, const CellState& cell, Timestamp now) {
  out.key("events").begin_array();
  const std::size_t first = state.events.size() - std::min(state.events.size(), kMostEvents);
  for (std::size_t i = first; i < state.events.size(); ++i) {
    const TissueEvent& event = state.events[i];
    const bool limit = event.kind == TissueEventKind::limit;
    out.begin_object()
        .member("number", event.number)
        .member("kind", word(event.kind))
        .member("robot", robot_name(cell, event.instrument))
        .member("object", object_name(state, event.object))
        .member("part", part_of(event))
        .member("limit", limit ? word(event.limit) : std::string_view())
        .member("at_m", event.at)
        .member("value", event.value)
        .member("age_s", event.time.known() ? std::optional(seconds(now - event.time)) : std::nullopt)
        .end_object();
  }
  out.end_array();
}

}  // namespace

void add_tissue(JsonWriter& out, const TissueReport* report, const CellState& cell, Timestamp now) {
  out.key("tissue");
  if (report == nullptr) {
    out.null();
    return;
  }
  const TissueState& state = report->state;
  out.begin_object()
      .member("calculating", state.calculating)
      .member("network_shown", cell.tissue != nullptr && cell.tissue->network_shown)
      .member("rate_hz", report->rate_hz)
      .member("step_p50_us", microseconds(report->compute.percentile(50)))
      .member("step_p99_us", microseconds(report->compute.percentile(99)))
      .member("late_steps", report->late_steps);
  add_objects(out, state);
  add_instruments(out, state, cell);
  add_vessels(out, state);
  add_events(out, state, cell, now);
  out.key("effects").begin_object();
  for (std::size_t effect = 0; effect < kTissueEffects; ++effect)
    out.member(kTissueEffectWords.at(effect), state.effects.at(effect));
  out.end_object()
      .member("bleeding_ml_min", state.bleeding_ml_min)
      .member("blood_loss_ml", state.blood_loss_ml)
      .member("excesses", std::accumulate(state.excesses.begin(), state.excesses.end(), std::uint64_t{0}))
      .member("connections", state.connections)
      .member("connections_torn", state.connections_torn)
      .member("pool_level_m", state.pool_present ? std::optional(state.pool_level_m) : std::nullopt)
      .member("smoke", state.smoke)
      .member("lens_fog", state.lens_fog)
      .end_object();
}

}  // namespace cellmirror::app
