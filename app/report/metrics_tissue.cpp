#include "app/report/metrics_tissue.hpp"

#include <string_view>

#include "app/snapshot/tissue_names.hpp"

namespace cellmirror::app {

namespace {

// A sample an object.
template <class Value>
void for_objects(MetricsText& out, const TissueState& state, std::string_view name, std::string_view help,
                 Value TissueObjectState::* value) {
  out.family(name, "gauge", help);
  for (const TissueObjectState& object : state.objects)
    out.sample(static_cast<double>(object.*value), {{"object", object.name}});
}

void add_speed(MetricsText& out, const TissueReport& report) {
  out.one("cellmirror_tissue_rate_hertz", "gauge", "Steps of the simulation of tissue in the last second.",
          report.rate_hz);
  out.one("cellmirror_tissue_late_steps_total", "counter",
          "Milliseconds that were not simulated because a step took longer.", static_cast<double>(report.late_steps));
  out.latency("cellmirror_tissue_step_seconds", "How long a step of the simulation of tissue took.", report.compute);
  out.latency("cellmirror_tissue_pose_to_force_seconds",
              "From the tick that had an instrument's posture to the force of the tissue for it.",
              report.pose_to_force);
}

void add_events(MetricsText& out, const TissueState& state) {
  out.family("cellmirror_tissue_events_total", "counter",
             "What instruments did to deformable objects, or befell them.");
  for (std::size_t kind = 0; kind < kTissueEventWords.size(); ++kind)
    out.sample(static_cast<double>(state.event_counts.at(kind)), {{"kind", kTissueEventWords.at(kind)}});
  out.family("cellmirror_tissue_excesses_total", "counter", "Values beyond a limit of eladyn_plaus_param.");
  for (std::size_t limit = 0; limit < kTissueLimits; ++limit)
    out.sample(static_cast<double>(state.excesses.at(limit)), {{"limit", kTissueLimitWords.at(limit)}});
}

void add_instruments(MetricsText& out, const TissueState& state, const CellState& cell) {
  out.family("cellmirror_tissue_instrument_force_newtons", "gauge", "Force of the tissue on an instrument.");
  for (const TissueInstrumentState& instrument : state.instruments)
    out.sample(instrument.force_W.norm(), {{"robot", robot_name(cell, instrument.slot)}});
}

}  // namespace

void add_tissue_metrics(MetricsText& out, const LiveSources& sources) {
  if (!sources.tissue) return;
  const TissueState& state = sources.tissue->state;
  out.one("cellmirror_tissue_calculating", "gauge", "1: deformable objects are simulated; 0: eladyn_calc off.",
          state.calculating ? 1.0 : 0.0);
  add_speed(out, *sources.tissue);
  for_objects(out, state, "cellmirror_tissue_nodes", "Nodes of a deformable object.", &TissueObjectState::nodes);
  for_objects(out, state, "cellmirror_tissue_elements", "Elements of a deformable object.",
              &TissueObjectState::elements);
  for_objects(out, state, "cellmirror_tissue_contacts", "Contacts of a deformable object.",
              &TissueObjectState::contacts);
  for_objects(out, state, "cellmirror_tissue_parts", "Pieces of a deformable object that are not connected.",
              &TissueObjectState::parts);
  for_objects(out, state, "cellmirror_tissue_inverted", "Elements that are turned inside out.",
              &TissueObjectState::inverted);
  add_instruments(out, state, sources.cell_state);
  add_events(out, state);
  out.one("cellmirror_tissue_bleeding_milliliters_per_minute", "gauge", "What all vessels lose now.",
          state.bleeding_ml_min);
  out.one("cellmirror_tissue_blood_loss_milliliters", "gauge", "What was lost since the start or eladyn_model_reset.",
          state.blood_loss_ml);
}

}  // namespace cellmirror::app
