#include "app/wall/wall_metrics.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "app/wall/wall_words.hpp"
#include "ipc/web/metrics_text.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::app {

namespace {

struct Labelled {
  const WallTile* tile;
  std::string claim;
};

std::vector<Labelled> labelled(const WallCells& cells) {
  std::map<std::tuple<std::string_view, std::string_view, std::string_view>, int> claims;
  std::vector<Labelled> out;
  for (const auto& [number, tile] : cells.tiles())
    out.push_back({&tile, std::to_string(++claims[{tile.cell, tile.host, tile.instance}])});
  return out;
}

class CellMetrics {
 public:
  CellMetrics(web::MetricsText& out, const WallCells& cells) : out_(out), tiles_(labelled(cells)) {}

  template <class Value>
  void family(std::string_view name, std::string_view type, std::string_view help, Value value) {
    out_.family(name, type, help);
    for (const auto& [tile, claim] : tiles_) {
      const std::optional<double> found = value(*tile);
      if (found)
        out_.sample(*found,
                    {{"cell", tile->cell}, {"host", tile->host}, {"instance", tile->instance}, {"claim", claim}});
    }
  }
  // Of cells that are there.
  template <class Value>
  void of_summary(std::string_view name, std::string_view help, Value value) {
    family(name, "gauge", help, [&](const WallTile& tile) -> std::optional<double> {
      if (!tile.live || !tile.summary) return std::nullopt;
      return value(*tile.summary);
    });
  }
  void robots() {
    out_.family("cellmirror_wall_cell_robots", "gauge", "Robots of a cell by the state of what they show.");
    for (const auto& [tile, claim] : tiles_) {
      if (!tile->live || !tile->summary) continue;
      std::map<std::string_view, int> states;
      for (const RobotSummary& robot : tile->summary->robots)
        ++states[robot.mirrored ? cellmirror::word(robot.state) : "not_mirrored"];
      for (const auto& [state, number] : states) {
        out_.sample(number, {{"cell", tile->cell},
                             {"host", tile->host},
                             {"instance", tile->instance},
                             {"claim", claim},
                             {"state", state}});
      }
    }
  }
  void marks() {
    out_.family("cellmirror_wall_cell_mark", "gauge", "1 where something does not fit (docs/wall.md).");
    for (const auto& [tile, claim] : tiles_) {
      for (const WallMark mark : tile->marks()) {
        out_.sample(1, {{"cell", tile->cell},
                        {"host", tile->host},
                        {"instance", tile->instance},
                        {"claim", claim},
                        {"mark", word(mark)}});
      }
    }
  }

 private:
  web::MetricsText& out_;
  std::vector<Labelled> tiles_;
};

std::optional<double> oldest_robot(const CellSummary& summary) {
  std::optional<double> oldest;
  for (const RobotSummary& robot : summary.robots) {
    if (robot.age_s) oldest = std::max(oldest.value_or(0), *robot.age_s);
  }
  return oldest;
}

void add_counters(CellMetrics& out) {
  const auto counter = [&](std::string_view name, std::string_view help, std::uint64_t WallTile::* member) {
    out.family(name, "counter", help,
               [member](const WallTile& tile) { return std::optional(static_cast<double>(tile.*member)); });
  };
  counter("cellmirror_wall_cell_received_total", "Summaries received.", &WallTile::received);
  counter("cellmirror_wall_cell_lost_total", "Summaries known to be missing, by gaps of their numbers.",
          &WallTile::lost);
  counter("cellmirror_wall_cell_dropped_total", "Summaries left out because their sender sends too many.",
          &WallTile::dropped);
  counter("cellmirror_wall_cell_rejected_total", "Messages that are no summaries.", &WallTile::rejected);
  counter("cellmirror_wall_cell_restarts_total", "Restarts of the gateway that were seen.", &WallTile::restarts);
}

void add_states(CellMetrics& out, Timestamp now) {
  out.family("cellmirror_wall_cell_up", "gauge", "1: summaries of the cell arrive; 0: it is silent.",
             [](const WallTile& tile) { return std::optional(tile.live ? 1.0 : 0.0); });
  out.family("cellmirror_wall_cell_age_seconds", "gauge", "Since the newest summary was received.",
             [now](const WallTile& tile) -> std::optional<double> {
               if (!tile.last_heard.known()) return std::nullopt;
               return seconds(now - tile.last_heard);
             });
  out.family(
      "cellmirror_wall_cell_level", "gauge", "0: ok, 1: attention, 2: fault, silent or never seen.",
      [](const WallTile& tile) { return std::optional(static_cast<double>(std::to_underlying(level_of(tile)))); });
  out.of_summary("cellmirror_wall_cell_health", "0: ok, 1: attention, 2: fault, as the gateway says.",
                 [](const CellSummary& s) { return std::optional(static_cast<double>(std::to_underlying(s.health))); });
  out.of_summary("cellmirror_wall_cell_touching", "Pairs of bodies that touch.",
                 [](const CellSummary& s) { return std::optional(static_cast<double>(s.touching)); });
  out.of_summary("cellmirror_wall_cell_nearest_meters", "The smallest distance of all tested pairs.",
                 [](const CellSummary& s) -> std::optional<double> {
                   if (!s.nearest) return std::nullopt;
                   return s.nearest->distance_m;
                 });
  out.of_summary("cellmirror_wall_cell_oldest_robot_seconds", "Age of the oldest newest sample of its mirrored robots.",
                 oldest_robot);
  out.of_summary("cellmirror_wall_cell_loop_rate_hertz", "Rate of the gateway's loop.",
                 [](const CellSummary& s) { return std::optional(s.loop.rate_hz); });
  out.of_summary("cellmirror_wall_cell_loop_on_time", "1: the gateway's loop is on time.",
                 [](const CellSummary& s) { return std::optional(s.loop.on_time ? 1.0 : 0.0); });
  out.of_summary("cellmirror_wall_cell_alarms_active", "Alarms whose condition holds.",
                 [](const CellSummary& s) { return std::optional(static_cast<double>(s.alarms.active)); });
  out.of_summary("cellmirror_wall_cell_alarms_unacknowledged", "Alarms that nobody has acknowledged.",
                 [](const CellSummary& s) { return std::optional(static_cast<double>(s.alarms.unacknowledged)); });
  out.family("cellmirror_wall_cell_clock_difference_seconds", "gauge",
             "The gateway's clock less that of the wall, with the time that a summary takes.",
             [](const WallTile& tile) -> std::optional<double> {
               if (!tile.live) return std::nullopt;
               return tile.clock_difference_s;
             });
}

}  // namespace

std::string wall_metrics(const WallCells& cells, const web::ServerStatus& web, Timestamp now) {
  web::MetricsText text;
  CellMetrics out(text, cells);
  add_states(out, now);
  out.robots();
  out.marks();
  add_counters(out);
  const WallTotals& totals = cells.totals();
  const auto total = [&](std::string_view name, std::string_view help, std::uint64_t value) {
    text.one(name, "counter", help, static_cast<double>(value));
  };
  total("cellmirror_wall_received_total", "Summaries received of all cells.", totals.received);
  total("cellmirror_wall_rejected_total", "Messages of anyone that are no summaries.", totals.rejected);
  total("cellmirror_wall_dropped_total", "Summaries left out because their sender sends too many.", totals.dropped);
  total("cellmirror_wall_left_out_total", "Summaries left out because there are too many cells, senders or names.",
        totals.left_out);
  text.one("cellmirror_wall_tiles", "gauge", "Tiles of the wall.", static_cast<double>(cells.tiles().size()));
  text.one("cellmirror_wall_pages", "gauge", "Pages that are open.", static_cast<double>(web.clients));
  return text.take();
}

}  // namespace cellmirror::app
