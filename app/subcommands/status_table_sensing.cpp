#include "app/subcommands/status_table_sensing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "app/subcommands/status_words.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr std::size_t kPairsShown = 10;
constexpr std::size_t kSensorEventsShown = 5;

std::string mm(const json& metres) { return fmt::format("{:.1f} mm", mm_from_m(metres.get<double>())); }

std::string age(const json& age_s) {
  if (!age_s.is_number()) return "-";
  const double value = age_s.get<double>();
  return value < 1.0 ? fmt::format("{:.1f} ms", value * 1e3) : fmt::format("{:.1f} s", value);
}

const char* doubt(const json& finding) { return finding.at("doubtful").get<bool>() ? " (doubtful)" : ""; }

// The short name; the full path where a gateway of an older version tells no other.
std::string body(const json& finding, const std::string& key) {
  const std::string short_key = key + "_short";
  return text(finding.at(finding.contains(short_key) ? short_key : key));
}

std::string near_line(const json& pair) {
  std::string line =
      fmt::format("  {} - {}: {}{}", body(pair, "a"), body(pair, "b"), mm(pair.at("distance_m")), doubt(pair));
  if (pair.at("time_to_contact_s").is_number())
    line += fmt::format(", contact in {:.2f} s", pair.at("time_to_contact_s").get<double>());
  return line + "\n";
}

std::string findings(const json& collisions) {
  std::string out;
  const json& touching = collisions.at("touching");
  for (std::size_t i = 0; i < std::min(touching.size(), kPairsShown); ++i) {
    const json& pair = touching[i];
    out += fmt::format("  TOUCH {} - {}: {} deep{}\n", body(pair, "a"), body(pair, "b"), mm(pair.at("depth_m")),
                       doubt(pair));
  }
  if (touching.size() > kPairsShown) out += fmt::format("  and {} more that touch\n", touching.size() - kPairsShown);
  std::size_t shown = 0;
  for (const json& pair : collisions.at("near")) {
    const bool touches = pair.at("distance_m").get<double>() <= 0.0;
    if (touches || !pair.at("within_warning").get<bool>()) continue;
    if (++shown <= kPairsShown) out += near_line(pair);
  }
  if (shown > kPairsShown) out += fmt::format("  and {} more within the warning distance\n", shown - kPairsShown);
  if (shown == 0 && touching.empty() && collisions.at("nearest").is_object())
    out += "  nearest:" + near_line(collisions.at("nearest")).substr(1);
  for (const json& sentence : collisions.at("doubts")) out += fmt::format("  doubt: {}\n", text(sentence));
  const json& events = collisions.at("events");
  const std::size_t first = events.size() > kSensorEventsShown ? events.size() - kSensorEventsShown : 0;
  for (std::size_t i = first; i < events.size(); ++i) {
    const json& event = events[i];
    out += fmt::format("  {} ago {}: {} - {}\n", age(event.at("age_s")), text(event.at("change")), body(event, "a"),
                       body(event, "b"));
  }
  return out;
}

std::string collision_lines(const json& collisions) {
  const json& ages = collisions.at("age_ms");
  std::string out =
      fmt::format("\ncollisions  {} of {}, {} tested; {:.0f} Hz, age {} (p50 {} p99 {} ms), computed in p50 {} us\n",
                  collisions.at("active").get<bool>() ? "on" : "off",
                  number_of(collisions.at("bodies").get<std::uint64_t>(), "body", "bodies"),
                  number_of(collisions.at("pairs").at("tested").get<std::uint64_t>(), "pair"),
                  collisions.at("rate_hz").get<double>(), age(collisions.at("age_s")), milliseconds(ages.at("p50"), 2),
                  milliseconds(ages.at("p99"), 2), milliseconds(collisions.at("compute_us").at("p50"), 2));
  const std::string note = text(collisions.at("note"));
  if (!note.empty()) out += fmt::format("  note: {}\n", note);
  return out + findings(collisions);
}

std::string range_lines(const json& ranges) {
  std::string out;
  for (const json& sensor : ranges.at("sensors")) {
    if (!sensor.at("active").get<bool>()) continue;
    if (out.empty()) out = fmt::format("ranges  age {}\n", age(ranges.at("age_s")));
    const bool seen = sensor.at("distance_m").is_number();
    const std::string what =
        seen ? fmt::format("{} to {}", mm(sensor.at("distance_m")), body(sensor, "object")) : "nothing in the cone";
    out += fmt::format("  {}: {}{}{}\n", text(sensor.at("id")), what,
                       sensor.at("in_blind_zone").get<bool>() ? " (in the blind zone)" : "", doubt(sensor));
  }
  return out;
}

// Also while no ultrasonic sensor is active.
std::string barrier_lines(const json& ranges) {
  if (!ranges.contains("light_barriers") || ranges.at("light_barriers").empty()) return {};
  std::string out = fmt::format("light barriers  age {}\n", age(ranges.at("age_s")));
  for (const json& barrier : ranges.at("light_barriers")) {
    const bool interrupted = barrier.at("interrupted").get<bool>();
    const std::string by = barrier.at("object").is_null() ? "" : " by " + body(barrier, "object");
    out += fmt::format("  {}: {}{}{}, {}\n", text(barrier.at("name")), interrupted ? "interrupted" : "free", by,
                       doubt(barrier), number_of(barrier.value("interruptions", std::uint64_t{0}), "interruption"));
  }
  return out;
}

}  // namespace

std::string sensing_table(const json& status) {
  std::string out;
  if (status.contains("collisions")) out += collision_lines(status.at("collisions"));
  if (status.contains("ranges")) out += range_lines(status.at("ranges")) + barrier_lines(status.at("ranges"));
  return out;
}

}  // namespace cellmirror::app
