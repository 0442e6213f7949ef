#include "app/report/status_collisions.hpp"
#include "app/report/status_values.hpp"
#include "app/snapshot/proximity_words.hpp"

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace cellmirror::app {

namespace {

using nlohmann::json;

json optional_json(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

const std::string& name(const ProximityState& state, std::uint32_t body) {
  static const std::string unknown;
  return state.names && body < state.names->size() ? (*state.names)[body] : unknown;
}

const std::string& short_name(const ProximityState& state, std::uint32_t body) {
  return state.names && body < state.names->size() ? state.short_name(body) : name(state, body);
}

json touching_json(const ProximityState& state, const TouchingPair& pair, Timestamp now) {
  json points = json::array();
  for (const TouchingPoint& point : pair.points) {
    points.push_back(
        {{"point_m", vector_json(point.point_m)}, {"normal", vector_json(point.normal)}, {"depth_m", point.depth_m}});
  }
  return {{"a", name(state, pair.a)},
          {"b", name(state, pair.b)},
          {"a_short", short_name(state, pair.a)},
          {"b_short", short_name(state, pair.b)},
          {"depth_m", pair.depth_m},
          {"point_m", vector_json(pair.point_m)},
          {"normal", vector_json(pair.normal)},
          {"points", std::move(points)},
          {"contact_age_s", seconds(now - pair.contact_time)},
          {"doubtful", pair.doubtful}};
}

json near_json(const ProximityState& state, const NearPair& pair) {
  return {{"a", name(state, pair.a)},
          {"b", name(state, pair.b)},
          {"a_short", short_name(state, pair.a)},
          {"b_short", short_name(state, pair.b)},
          {"distance_m", pair.distance_m},
          {"point_a_m", vector_json(pair.point_a_m)},
          {"point_b_m", vector_json(pair.point_b_m)},
          {"within_warning", pair.within_warning},
          {"closing_speed_m_s", optional_json(pair.closing_speed_m_s)},
          {"time_to_contact_s", optional_json(pair.time_to_contact_s)},
          {"doubtful", pair.doubtful}};
}

json pairs_json(const collision::PairTable& table) {
  std::array<std::size_t, 7> counts{};
  for (const collision::Pair& pair : table.pairs) ++counts.at(static_cast<std::size_t>(pair.state));
  const auto count = [&](collision::PairState state) { return counts.at(static_cast<std::size_t>(state)); };
  using enum collision::PairState;
  return {{"tested", count(tested) + count(rule_test)},
          {"left_out",
           {{"rigid", table.rigid_pairs + count(rigid)},
            {"neighbours", count(neighbours)},
            {"always", count(always)},
            {"never", count(never)},
            {"rule", count(rule_ignore)}}}};
}

void add_findings(json& out, const ProximityState& state, Timestamp now) {
  out["age_s"] = seconds(now - state.posture_time);
  out["sequence"] = state.sequence;
  for (const TouchingPair& pair : state.touching) {
    if (out["touching"].size() == kMostPairsTold) break;
    out["touching"].push_back(touching_json(state, pair, now));
  }
  out["touching_count"] = state.touching.size();
  for (const NearPair& pair : state.near) {
    if (out["near"].size() == kMostPairsTold) break;
    out["near"].push_back(near_json(state, pair));
  }
  out["near_count"] = state.near.size();
  if (state.nearest() != nullptr) out["nearest"] = near_json(state, *state.nearest());
  out["doubts"] = state.doubts;
}

json events_json(const std::vector<ProximityEvent>& events, Timestamp now) {
  json out = json::array();
  for (const ProximityEvent& event : events) {
    out.push_back({{"sequence", event.sequence},
                   {"change", word(event.change)},
                   {"a", event.a},
                   {"b", event.b},
                   {"a_short", event.short_a.empty() ? event.a : event.short_a},
                   {"b_short", event.short_b.empty() ? event.b : event.short_b},
                   {"distance_m", event.distance_m},
                   {"age_s", seconds(now - event.posture_time)}});
  }
  return out;
}

}  // namespace

json percentiles_json(const HistogramSnapshot& snapshot, Nanoseconds unit) {
  if (snapshot.empty()) return {{"p50", nullptr}, {"p99", nullptr}, {"max", nullptr}};
  const auto in_units = [unit](Nanoseconds d) {
    return static_cast<double>(d.count()) / static_cast<double>(unit.count());
  };
  return {{"p50", in_units(snapshot.percentile(50))},
          {"p99", in_units(snapshot.percentile(99))},
          {"max", in_units(snapshot.max())}};
}

json collisions_json(const CollisionReport& report, Timestamp now) {
  constexpr Nanoseconds kMillisecond{1'000'000};
  constexpr Nanoseconds kMicrosecond{1'000};
  const bool derived = report.pairs != nullptr;
  json out = {{"active", report.active},
              {"note", report.note},
              {"warning_distance_m", report.warning_distance_m},
              {"bodies", derived ? report.pairs->bodies.size() : 0},
              {"triangles", derived ? report.pairs->triangles : 0},
              {"pairs", pairs_json(derived ? *report.pairs : collision::PairTable{})},
              {"age_s", nullptr},
              {"sequence", 0},
              {"age_ms", percentiles_json(report.age, kMillisecond)},
              {"visible_after_ms", percentiles_json(report.visible_after, kMillisecond)},
              {"compute_us", percentiles_json(report.compute, kMicrosecond)},
              {"rate_hz", report.rate_hz},
              {"skipped", report.skipped},
              {"touching", json::array()},
              {"touching_count", 0},
              {"near", json::array()},
              {"near_count", 0},
              {"nearest", nullptr},
              {"events", events_json(report.events, now)},
              {"doubts", json::array()},
              {"counters",
               {{"checks", report.counters.checks},
                {"pairs_computed", report.counters.pairs_computed},
                {"second_opinions", report.counters.second_opinions},
                {"disagreements", report.counters.disagreements},
                {"doubts", report.counters.doubts}}}};
  if (report.state) add_findings(out, *report.state, now);
  return out;
}

}  // namespace cellmirror::app
