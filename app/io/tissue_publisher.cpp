#include "app/io/tissue_publisher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "app/snapshot/tissue_names.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/notice.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror::app {

namespace {

constexpr double kMm2PerM2 = 1e6;

// "cystic_artery of liver", "liver", "" where neither is known.
std::string target(const NamedTissueEvent& event) {
  const std::string_view part = part_of(event.event);
  if (part.empty()) return event.object;
  return event.object.empty() ? std::string(part) : fmt::format("{} of {}", part, event.object);
}

// In the units of SCRIPT.
std::string limit_value(TissueLimit limit, double value) {
  switch (limit) {
    case TissueLimit::instrument_speed:
    case TissueLimit::node_speed:
      return fmt::format("{:.4g} mm/s", mm_from_m(value));
    case TissueLimit::penetration:
      return fmt::format("{:.4g} mm", mm_from_m(value));
    case TissueLimit::contact_force:
    case TissueLimit::grip_force:
      return fmt::format("{:.4g} N", value);
    case TissueLimit::strain:
      break;
  }
  return fmt::format("{:.4g}", value);
}

std::string limit_sentence(const NamedTissueEvent& event) {
  const std::string what = target(event);
  return fmt::format("{}{}{}: {} is beyond the limit {}", event.robot,
                     event.robot.empty() || what.empty() ? "" : " on ", what,
                     limit_value(event.event.limit, event.event.value), word(event.event.limit));
}

// Without the place.
std::string deed(const NamedTissueEvent& event) {
  const std::string on = target(event);
  const std::string_view by = event.robot.empty() ? std::string_view("an instrument") : std::string_view(event.robot);
  const double value = event.event.value;
  switch (event.event.kind) {
    case TissueEventKind::grip:
      return fmt::format("{} grips {}", by, on);
    case TissueEventKind::release:
      return fmt::format("{} releases {}", by, on);
    case TissueEventKind::slip:
      return fmt::format("{} slips off {} at {:.2f} N", by, on, value);
    case TissueEventKind::clip:
      return fmt::format("{} puts a clip on {}", by, on);
    case TissueEventKind::cut:
      return fmt::format("{} cuts {}, {:.1f} mm2", by, on, value * kMm2PerM2);
    case TissueEventKind::coagulate:
      // Told when heat begins and when it ends.
      return value > 0 ? fmt::format("{} has coagulated {:.1f} % of {}", by, value * 100.0, on)
                       : fmt::format("{} begins to coagulate {}", by, on);
    case TissueEventKind::tear:
      return fmt::format("{} tears", on);
    case TissueEventKind::bleed:
      return fmt::format("{} bleeds, {:.1f} ml/min", on, value);
    case TissueEventKind::bleed_end:
      return fmt::format("{} bleeds no more", on);
    case TissueEventKind::limit:
      return limit_sentence(event);
  }
  return std::string(word(event.event.kind));
}

// What harms is a warning. Limited in rate by kind of event.
void log_event(const NamedTissueEvent& event) {
  const TissueEventKind kind = event.event.kind;
  const bool harm = kind == TissueEventKind::tear || kind == TissueEventKind::bleed || kind == TissueEventKind::limit;
  const std::string of_kind = fmt::format("tissue.{}", word(kind));
  if (harm) return log_text(LogLevel::warning, of_kind, sentence(event));
  log_notice(of_kind, sentence(event));
}

}  // namespace

std::string sentence(const NamedTissueEvent& event) {
  const Eigen::Vector3d& at = event.event.at;
  return fmt::format("{} at ({:.1f}, {:.1f}, {:.1f}) mm", deed(event), mm_from_m(at.x()), mm_from_m(at.y()),
                     mm_from_m(at.z()));
}

TissuePublisher::TissuePublisher(TissueSources sources, std::size_t outputs)
    : sources_(std::move(sources)), readers_(outputs) {}

void TissuePublisher::look(const CellState& cell, std::span<const RobotState> robots) {
  std::shared_ptr<const TissueReport> report = sources_.newest_report();
  if (!report || report == report_) return;
  report_ = std::move(report);
  find_forces(cell, robots);
  const std::uint64_t newest = report_->state.events.empty() ? 0 : report_->state.events.back().number;
  if (newest == newest_event_) return;
  // Numbers that begin again are those of a new simulation.
  if (newest < newest_event_) {
    last_logged_ = 0;
    for (Reader& reader : readers_) reader.last_event = 0;
  }
  newest_event_ = newest;
  name_events(cell);
  for (const NamedTissueEvent& event : events_after(last_logged_)) log_event(event);
  last_logged_ = newest;
}

void TissuePublisher::name_events(const CellState& cell) {
  events_.clear();
  for (const TissueEvent& event : report_->state.events) {
    events_.push_back({event, robot_name(cell, event.instrument), object_name(report_->state, event.object)});
  }
}

void TissuePublisher::find_forces(const CellState& cell, std::span<const RobotState> robots) {
  forces_.clear();
  for (const TissueInstrumentState& instrument : report_->state.instruments) {
    for (std::size_t i = 0; i < robots.size() && i < cell.robots.size(); ++i) {
      if (instrument.slot < 0 || cell.robots[i].slot != static_cast<std::size_t>(instrument.slot)) continue;
      forces_.push_back({robots[i].id, robots[i].X_WT.translation(), instrument.force_W});
    }
  }
}

std::span<const NamedTissueEvent> TissuePublisher::events_after(std::uint64_t number) const {
  const auto first =
      std::ranges::find_if(events_, [&](const NamedTissueEvent& one) { return one.event.number > number; });
  return std::span(events_).subspan(static_cast<std::size_t>(first - events_.begin()));
}

void TissuePublisher::publish_events(std::size_t output, TissueEventOutput& to) {
  const std::span<const NamedTissueEvent> news = events_after(readers_.at(output).last_event);
  if (news.empty()) return;
  to.publish_tissue_events(news);
  readers_.at(output).last_event = news.back().event.number;
}

void TissuePublisher::publish_shapes(std::size_t output, Timestamp now, TissueShapeOutput& to) {
  const Nanoseconds period = to.tissue_period();
  Reader& reader = readers_.at(output);
  const bool waits_for_report = sources_.report != nullptr && !report_;
  if (!sources_.view || waits_for_report || period <= Nanoseconds(0) || now < reader.shapes_due) return;
  const std::shared_ptr<const TissueView> view = sources_.view();
  if (!view || view->step == reader.last_step) return;  // it is looked for again when the output is due next
  // A recording that is played has shapes alone.
  to.publish_tissue_shapes(report_ ? report_->state.time : now, *view, forces_);
  reader.last_step = view->step;
  reader.shapes_due = now + period;
}

}  // namespace cellmirror::app
