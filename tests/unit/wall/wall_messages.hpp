// Messages of made-up gateways, for tests of the wall.
#pragma once

#include <string>

#include "app/wall/wall_cells.hpp"

namespace cellmirror::app {

inline constexpr std::int64_t kNoon_ns = 1'800'000'000'000'000'000;  // since 1970

[[nodiscard]] inline Timestamp at(double seconds) {
  return Timestamp{1'000'000'000 + static_cast<std::int64_t>(1e9 * seconds)};
}
[[nodiscard]] inline std::int64_t wall_at(double seconds) {
  return kNoon_ns + static_cast<std::int64_t>(1e9 * seconds);
}

struct TestGateway {
  std::string sender;
  std::string cell;
  std::string host = "host";
  std::string run = "1";
  std::uint64_t sequence = 0;
  double clock_s = 0;
  int version = kCellSummaryVersion;
  CellHealth health = CellHealth::ok;

  [[nodiscard]] WallMessage message(double time_s) {
    CellSummary summary;
    summary.version = version;
    summary.cell = cell;
    summary.host = host;
    summary.instance = "default";
    summary.run = run;
    summary.sequence = ++sequence;
    summary.time_ns = wall_at(time_s + clock_s);
    summary.health = health;
    if (health != CellHealth::ok) summary.reasons = {"a reason"};
    summary.robots = {{.id = "R", .mirrored = true, .state = DataState::fresh, .age_s = 0.01}};
    return {summary, sender, at(time_s), 500};
  }
};

inline void tell(WallCells& cells, TestGateway& gateway, double time_s) {
  cells.receive(gateway.message(time_s), wall_at(time_s));
}

// The tile of that cell and that sender; null: there is none.
[[nodiscard]] inline const WallTile* tile_of(const WallCells& cells, const std::string& cell,
                                             const std::string& sender = {}) {
  for (const auto& [number, tile] : cells.tiles()) {
    if (tile.cell == cell && (sender.empty() || tile.sender == sender)) return &tile;
  }
  return nullptr;
}

[[nodiscard]] inline bool marked(const WallTile* tile, WallMark mark) {
  if (tile == nullptr) return false;
  for (const WallMark one : tile->marks()) {
    if (one == mark) return true;
  }
  return false;
}

}  // namespace cellmirror::app
