#include "config/collision_reader.hpp"

#include <fmt/format.h>

#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

using collision::PairRule;

constexpr std::size_t kMostRules = 10'000;  // of a kind

// A rule fits nothing that is no node: without this a slip of the pen would leave a pair tested, or untested.
void complete_path(const Cell& cell, const Place& place, std::string& path, Diagnostics& diagnostics) {
  if (path.empty()) return;  // everything
  if (auto found = cell.find_branch(path)) {
    path = std::move(*found);
    return;
  }
  for (std::size_t dot = path.rfind('.'); dot != std::string::npos && dot > 0; dot = path.rfind('.', dot - 1)) {
    const auto above = cell.find(std::string_view(path).substr(0, dot));
    if (!above) continue;
    const Node& node = cell.node(*above);
    if (!node.has_abstract() || node.content != nullptr) break;
    path = cell.path(*above) + path.substr(dot);
    return;
  }
  const Error error = cell.explain(path);
  diagnostics.error(place, error.what, error.remedy);
}

}  // namespace

void CollisionReader::read_rules(TableReader& table, const char* key, PairRule::Kind kind) {
  for (TableReader& item : table.tables(key, kMostRules)) {
    item.require("a");
    item.require("b");
    const auto a = item.text("a");
    const auto b = item.text("b");
    std::string reason = item.text("reason").value_or("");
    item.finish();
    if (!a || !b) continue;
    settings_.rules.push_back({*a, *b, kind, std::move(reason)});
    places_.push_back({item.place("a"), item.place("b")});
  }
}

void CollisionReader::read(TableReader& top) {
  auto table = top.table("collision");
  if (!table) return;
  settings_.active = table->boolean("active").value_or(settings_.active);
  settings_.warning_distance_m =
      table->number("warning_distance_m", {0.0, 100.0}).value_or(settings_.warning_distance_m);
  // In this order: of two rules about one pair the last counts, so that `test` makes exceptions from `ignore`.
  read_rules(*table, "ignore", PairRule::Kind::ignore);
  read_rules(*table, "test", PairRule::Kind::test);
  table->finish();
}

collision::Settings CollisionReader::settings(const Cell& cell, Diagnostics& diagnostics) const {
  collision::Settings out = settings_;
  for (std::size_t i = 0; i < out.rules.size(); ++i) {
    complete_path(cell, places_[i].a, out.rules[i].a, diagnostics);
    complete_path(cell, places_[i].b, out.rules[i].b, diagnostics);
  }
  return out;
}

}  // namespace cellmirror
