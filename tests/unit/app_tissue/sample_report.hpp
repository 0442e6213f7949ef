// A report with one of everything, and the cell that its numbers name.
#pragma once

#include <algorithm>
#include <memory>
#include <string_view>

#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/tissue_report.hpp"

namespace cellmirror::app::test {

inline constexpr Timestamp kNow{10'000'000'000};

inline TissueEvent tissue_event(std::uint64_t number, TissueEventKind kind, std::string_view part = {}) {
  TissueEvent event;
  event.number = number;
  event.time = kNow - Nanoseconds(2'500'000'000);
  event.kind = kind;
  event.instrument = 4;
  event.object = 0;
  event.at = {0.125, -0.5, 1};
  event.value = 0.25;
  std::ranges::copy(part, event.part.begin());
  return event;
}

inline TissueReport sample_report() {
  TissueReport report;
  TissueState& state = report.state;
  state.step = 77;
  state.time = kNow - Nanoseconds(2'000'000);
  TissueObjectState liver;
  liver.name = "liver";
  liver.nodes = 2200;
  liver.elements = 10'050;
  liver.elements_at_start = 10'000;
  liver.attributes = static_cast<std::uint16_t>(TissueAttribute::calculate) |
                     static_cast<std::uint16_t>(TissueAttribute::cut) |
                     static_cast<std::uint16_t>(TissueAttribute::wet);
  liver.substeps = 2;
  liver.added_mass_share = 0.015;
  liver.volume_m3 = 1.5e-3;
  liver.contacts = 3;
  liver.parts = 2;
  liver.coagulated_share = 0.02;
  liver.inverted = 1;
  state.objects = {liver};
  TissueInstrumentState grasper;
  grasper.slot = 4;
  grasper.kind = InstrumentKind::gripper;
  grasper.acting = true;
  grasper.held = 6;
  grasper.contacts = 2;
  grasper.force_W = {3, 0, -4};
  state.instruments = {grasper};
  state.vessels = {{"liver", "cystic_artery", 0, true, 2, 12.5}, {"liver", "portal_vein", 1, false, 0, 0}};
  state.events = {tissue_event(1, TissueEventKind::grip), tissue_event(2, TissueEventKind::clip, "cystic_artery")};
  state.event_counts = {1, 0, 0, 1, 0, 0, 0, 0, 0, 0};
  state.excesses = {0, 0, 7, 0, 0, 0};
  state.effects = {true, false, false, false, false};
  state.bleeding_ml_min = 12.5;
  state.blood_loss_ml = 3.25;
  state.smoke = 0.5;
  state.lens_fog = 0.25;
  state.connections = 4;
  state.connections_torn = 1;
  state.pool_present = true;
  state.pool_level_m = 0.002;
  state.pool_blood = 0.1;
  LatencyHistogram compute;
  compute.record(Nanoseconds(250'000));
  report.compute = compute.snapshot();
  report.rate_hz = 999;
  report.late_steps = 5;
  report.simd = "AVX2";
  return report;
}

inline CellState sample_cell() {
  CellState cell;
  RobotSnapshot arm;
  arm.id = "ARM";
  arm.slot = 0;
  RobotSnapshot grasper;
  grasper.id = "GRASPER";
  grasper.slot = 4;
  cell.robots = {arm, grasper};
  TissueSettings settings;
  settings.network_shown = true;
  settings.limits.at(2) = {.actions = 0b100001, .value = 8};
  cell.tissue = std::make_shared<const TissueSettings>(settings);
  return cell;
}

}  // namespace cellmirror::app::test
