#include "app/simulation/tissue_summary.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr std::size_t kListedEvents = 40;

std::string object_name(const TissueSummary& tissue, std::int16_t object) {
  const auto index = static_cast<std::size_t>(object);
  return object >= 0 && index < tissue.state.objects.size() ? tissue.state.objects[index].name : std::string();
}

json objects_json(const TissueState& state) {
  json list = json::array();
  for (const TissueObjectState& object : state.objects) {
    list.push_back({{"name", object.name},
                    {"nodes", object.nodes},
                    {"elements", object.elements},
                    {"parts", object.parts},
                    {"volume_m3", object.volume_m3},
                    {"energy_j", object.energy_j},
                    {"coagulated_share", object.coagulated_share}});
  }
  return list;
}

json events_json(const TissueSummary& tissue) {
  json list = json::array();
  for (const auto& [time_s, event] : tissue.events) {
    json out = {{"time_s", time_s},
                {"event", word(event.kind)},
                {"object", object_name(tissue, event.object)},
                {"at_m", {event.at.x(), event.at.y(), event.at.z()}},
                {"value", event.value}};
    if (event.instrument >= 0) out["instrument_slot"] = event.instrument;
    if (event.part[0] != 0) out["part"] = event.part.data();
    if (event.kind == TissueEventKind::limit) out["limit"] = word(event.limit);
    list.push_back(std::move(out));
  }
  return list;
}

}  // namespace

json tissue_json(const SimulationResult& result) {
  const TissueSummary& tissue = result.tissue;
  if (tissue.steps == 0) return nullptr;
  return {{"simd", tissue.simd},
          {"steps", tissue.steps},
          {"digest", fmt::format("{:016x}", tissue.digest)},
          {"objects", objects_json(tissue.state)},
          {"blood_loss_ml", tissue.state.blood_loss_ml},
          {"events", events_json(tissue)},
          {"events_not_listed", tissue.more_events}};
}

std::string tissue_text(const SimulationResult& result) {
  const TissueSummary& tissue = result.tissue;
  if (tissue.steps == 0) return {};
  std::string text =
      fmt::format("\ndeformable objects: {} steps with {}, state {:016x}\n", tissue.steps, tissue.simd, tissue.digest);
  for (const TissueObjectState& object : tissue.state.objects) {
    text += fmt::format("  {:<24} {} nodes, {} elements, parts: {}\n", object.name, object.nodes, object.elements,
                        object.parts);
  }
  const std::size_t shown = std::min(tissue.events.size(), kListedEvents);
  for (std::size_t i = 0; i < shown; ++i) {
    const auto& [time_s, event] = tissue.events[i];
    const bool named = event.part[0] != 0;
    text += fmt::format("  {:9.3f} s  {:<10} {}{}{}\n", time_s, word(event.kind), object_name(tissue, event.object),
                        named ? " " : "", event.part.data());
  }
  if (tissue.events.size() > shown || tissue.more_events > 0)
    text += fmt::format("  ... and {} more\n", tissue.events.size() - shown + tissue.more_events);
  return text;
}

}  // namespace cellmirror::app
