#include "app/subcommands/status_table_tissue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/subcommands/status_words.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr std::size_t kEventsShown = 5;
constexpr double kMlPerM3 = 1e6;

double number(const json& value) { return value.get<double>(); }

std::string head(const json& tissue) {
  const json& step = tissue.at("step_us");
  const std::uint64_t late = count(tissue.at("late_steps"));
  return fmt::format("\ntissue  {}, {:.0f} Hz, {}; step p50 {:.0f} p99 {:.0f} us, force after p99 {:.1f} ms ({})\n",
                     tissue.at("calculating").get<bool>() ? "calculating" : "NOT calculating (eladyn_calc off)",
                     number(tissue.at("rate_hz")), number_of(late, "late step"), number(step.at("p50")),
                     number(step.at("p99")), number(tissue.at("pose_to_force_us").at("p99")) * 1e-3,
                     text(tissue.at("simd")));
}

std::string object_line(const json& object) {
  std::string out =
      fmt::format("  {}: {}, {}, {:.1f} ml, {}", text(object.at("name")), number_of(count(object.at("nodes")), "node"),
                  number_of(count(object.at("elements")), "element"), number(object.at("volume_m3")) * kMlPerM3,
                  number_of(count(object.at("contacts")), "contact"));
  if (count(object.at("substeps")) > 1) out += fmt::format(", {} substeps", count(object.at("substeps")));
  if (number(object.at("added_mass_share")) > 0.0)
    out += fmt::format(", {:.1f} % mass added", number(object.at("added_mass_share")) * 100.0);
  if (count(object.at("parts")) > 1) out += fmt::format(", {} parts", count(object.at("parts")));
  if (number(object.at("coagulated_share")) > 0.0)
    out += fmt::format(", {:.1f} % coagulated", number(object.at("coagulated_share")) * 100.0);
  if (count(object.at("inverted")) > 0) out += fmt::format(", {} INVERTED", count(object.at("inverted")));
  return out + "\n";
}

std::string instrument_line(const json& instrument) {
  const json& force = instrument.at("force_n");
  const double size = std::hypot(number(force.at(0)), number(force.at(1)), number(force.at(2)));
  std::string out = fmt::format("  {} {}{}, {:.2f} N", text(instrument.at("robot")), text(instrument.at("kind")),
                                instrument.at("acting").get<bool>() ? " acting" : "", size);
  if (count(instrument.at("held")) > 0)
    out += fmt::format(", holds {}", number_of(count(instrument.at("held")), "point"));
  return out + "\n";
}

// A vessel to which nothing has happened is not worth a line.
std::string vessel_line(const json& vessel) {
  const std::uint64_t clips = count(vessel.at("clips"));
  const bool severed = vessel.at("severed").get<bool>();
  if (clips == 0 && !severed) return {};
  std::string out = fmt::format("  {} {} of {}: {}", text(vessel.at("kind")), text(vessel.at("name")),
                                text(vessel.at("object")), number_of(clips, "clip"));
  if (severed) out += ", severed";
  if (number(vessel.at("bleeding_ml_min")) > 0.0)
    out += fmt::format(", BLEEDS {:.1f} ml/min", number(vessel.at("bleeding_ml_min")));
  return out + "\n";
}

std::string fluids(const json& tissue) {
  std::string out;
  const auto add = [&](std::string part) { out += (out.empty() ? "  " : ", ") + std::move(part); };
  if (number(tissue.at("blood_loss_ml")) > 0.0)
    add(fmt::format("bleeding {:.1f} ml/min, {:.1f} ml lost", number(tissue.at("bleeding_ml_min")),
                    number(tissue.at("blood_loss_ml"))));
  if (const json& pool = tissue.at("pool"); pool.is_object())
    add(fmt::format("pool {:+.1f} mm, {:.0f} % blood", mm_from_m(number(pool.at("level_m"))),
                    number(pool.at("blood")) * 100.0));
  if (number(tissue.at("smoke")) > 0.0) add(fmt::format("smoke {:.0f} %", number(tissue.at("smoke")) * 100.0));
  if (number(tissue.at("lens_fog")) > 0.0)
    add(fmt::format("lens fogged {:.0f} %", number(tissue.at("lens_fog")) * 100.0));
  if (const std::uint64_t torn = count(tissue.at("connections_torn")); torn > 0)
    add(fmt::format("{} of {} torn", torn, number_of(count(tissue.at("connections")), "connection")));
  std::string effects;
  for (const auto& [name, on] : tissue.at("effects").items())
    if (on.get<bool>()) effects += " " + name;
  if (!effects.empty()) add("effects" + effects);
  std::string excesses;
  for (const json& limit : tissue.at("limits"))
    if (count(limit.at("excesses")) > 0)
      excesses += fmt::format(" {} {}", text(limit.at("limit")), count(limit.at("excesses")));
  if (!excesses.empty()) add("beyond limits:" + excesses);
  return out.empty() ? out : out + "\n";
}

std::string event_line(const json& event) {
  const json& at = event.at("at_m");
  std::string what = text(event.at("kind"));
  for (const char* key : {"robot", "part", "object"})
    if (const std::string name = text(event.at(key)); !name.empty()) what += " " + name;
  if (event.at("limit").is_string()) what += " " + text(event.at("limit"));
  const json& age = event.at("age_s");
  return fmt::format("  {} ago {} at ({:.1f}, {:.1f}, {:.1f}) mm\n",
                     age.is_number() ? fmt::format("{:.1f} s", number(age)) : std::string("-"), what,
                     mm_from_m(number(at.at(0))), mm_from_m(number(at.at(1))), mm_from_m(number(at.at(2))));
}

}  // namespace

std::string tissue_table(const json& status) {
  if (!status.contains("tissue") || !status.at("tissue").is_object()) return {};
  const json& tissue = status.at("tissue");
  std::string out = head(tissue);
  for (const json& object : tissue.at("objects")) out += object_line(object);
  for (const json& instrument : tissue.at("instruments")) out += instrument_line(instrument);
  for (const json& vessel : tissue.at("vessels")) out += vessel_line(vessel);
  out += fluids(tissue);
  const json& events = tissue.at("events").at("last");
  const std::size_t first = events.size() > kEventsShown ? events.size() - kEventsShown : 0;
  for (std::size_t i = first; i < events.size(); ++i) out += event_line(events.at(i));
  return out;
}

}  // namespace cellmirror::app
