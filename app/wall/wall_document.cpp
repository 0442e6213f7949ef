#include "app/wall/wall_document.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/wall/wall_words.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr double kToMilliseconds = 1e-6;

// Of what came from outside; texts may have bytes that are not UTF-8.
std::string text_of(const json& document) { return document.dump(-1, ' ', false, json::error_handler_t::replace); }

json rounded(double value, double step) {
  return std::isfinite(value) ? json(std::round(value / step) * step) : json(nullptr);
}

json pair_of(const BodyPair& pair) { return json::array({pair.a, pair.b}); }

json robots_of(const CellSummary& summary) {
  json out = json::array();
  for (const RobotSummary& robot : summary.robots)
    out.push_back({{"id", robot.id},
                   {"mirrored", robot.mirrored},
                   {"state", robot.mirrored ? word(robot.state) : std::string_view()}});
  return out;
}

json marks_of(const WallTile& tile) {
  json out = json::array();
  for (const WallMark mark : tile.marks()) out.push_back({{"mark", word(mark)}, {"text", mark_text(tile, mark)}});
  return out;
}

void add_summary(json& out, const CellSummary& summary) {
  out["health"] = word(summary.health);
  out["reasons"] = summary.reasons;
  out["robots"] = robots_of(summary);
  out["robots_left_out"] = summary.robots_left_out;
  out["touching"] = summary.touching;
  json pairs = json::array();
  for (const BodyPair& pair : summary.touching_pairs) pairs.push_back(pair_of(pair));
  out["touching_pairs"] = std::move(pairs);
  out["nearest"] = summary.nearest ? pair_of(summary.nearest->bodies) : json(nullptr);
  out["on_time"] = summary.loop.on_time;
  out["faults"] = summary.loop.faults;
  out["alarms"] = summary.alarms.active;
  out["unacknowledged"] = summary.alarms.unacknowledged;
  out["replay"] = summary.replay;
  out["page_port"] = summary.page_port;
}

json content_of(const WallTile& tile) {
  json out = {{"cell", tile.cell},
              {"title", tile.expected == nullptr ? "" : tile.expected->title},
              {"page", tile.expected == nullptr ? "" : tile.expected->page},
              {"host", tile.host},
              {"instance", tile.instance},
              {"level", word(level_of(tile))},
              {"state", state_word(tile)},
              {"marks", marks_of(tile)},
              {"moved_from", tile.moved_from},
              {"thumbnail", tile.expected != nullptr && !tile.expected->thumbnail.empty()}};
  if (!tile.live && tile.ever_heard())
    out["silent_since_ms"] = std::round(kToMilliseconds * static_cast<double>(tile.last_heard_wall_ns));
  if (tile.summary) add_summary(out, *tile.summary);
  return out;
}

json pulse_of(const WallTile& tile, const std::optional<ThumbnailReport>& thumbnail, Timestamp now) {
  json out = {{"received", tile.received}, {"lost", tile.lost},         {"restarts", tile.restarts},
              {"dropped", tile.dropped},   {"rejected", tile.rejected}, {"repeated", tile.repeated}};
  if (tile.last_heard.known()) out["age_s"] = rounded(seconds(now - tile.last_heard), 1e-3);
  if (thumbnail && thumbnail->number > 0) {
    out["thumbnail"] = thumbnail->number;
    out["thumbnail_age_s"] = rounded(seconds(now - thumbnail->receive_time), 1e-3);
  }
  if (thumbnail && thumbnail->refused > 0) out["thumbnail_refused"] = thumbnail->refused_why;
  if (!tile.summary) return out;
  const CellSummary& summary = *tile.summary;
  out["sequence"] = summary.sequence;
  out["time_ms"] = std::round(kToMilliseconds * static_cast<double>(summary.time_ns));
  out["uptime_s"] = rounded(summary.uptime_s, 0.1);
  out["rate_hz"] = rounded(summary.loop.rate_hz, 0.1);
  out["missed"] = summary.loop.missed;
  out["nearest_m"] = summary.nearest ? rounded(summary.nearest->distance_m, 1e-4) : json(nullptr);
  json ages = json::array();
  for (const RobotSummary& robot : summary.robots) ages.push_back(robot.age_s ? rounded(*robot.age_s, 1e-3) : json());
  out["robots_age_s"] = std::move(ages);
  return out;
}

std::optional<ThumbnailReport> thumbnail_of(const WallTile& tile, const Thumbnails& thumbnails) {
  if (tile.expected == nullptr || tile.expected->thumbnail.empty()) return std::nullopt;
  return thumbnails.report(tile.cell);
}

json totals_of(const WallCells& cells) {
  const WallTotals& totals = cells.totals();
  return {{"received", totals.received},
          {"rejected", totals.rejected},
          {"dropped", totals.dropped},
          {"left_out", totals.left_out},
          {"rejected_why", totals.rejected_why}};
}

}  // namespace

std::string WallDocuments::changes(const WallCells& cells, const Thumbnails& thumbnails, Timestamp now) {
  json tiles = json::array();
  json removed = json::array();
  for (const auto& [number, tile] : cells.tiles()) {
    const auto thumbnail = thumbnail_of(tile, thumbnails);
    const std::uint64_t picture = thumbnail ? thumbnail->number : 0;
    Sent& sent = sent_[number];
    if (sent.version == tile.version + 1 && sent.thumbnail == picture) continue;
    sent.version = tile.version + 1;  // 0: not sent yet
    sent.thumbnail = picture;
    json changed = {{"number", number}, {"pulse", pulse_of(tile, thumbnail, now)}};
    json content = content_of(tile);
    std::string content_text = text_of(content);
    if (content_text != sent.content) {
      changed["content"] = std::move(content);
      sent.content = std::move(content_text);
    }
    tiles.push_back(std::move(changed));
  }
  std::erase_if(sent_, [&](const auto& entry) {
    if (cells.tiles().contains(entry.first)) return false;
    removed.push_back(entry.first);
    return true;
  });
  const std::uint64_t from = revision_++;
  return text_of({{"from", from},
                  {"to", revision_},
                  {"tiles", std::move(tiles)},
                  {"removed", std::move(removed)},
                  {"totals", totals_of(cells)}});
}

std::string WallDocuments::whole(const WallCells& cells, const Thumbnails& thumbnails, Timestamp now) const {
  json tiles = json::array();
  for (const auto& [number, tile] : cells.tiles()) {
    tiles.push_back({{"number", number},
                     {"content", content_of(tile)},
                     {"pulse", pulse_of(tile, thumbnail_of(tile, thumbnails), now)}});
  }
  return text_of({{"version", version_},
                  {"to", revision_},
                  {"silent_after_s", seconds(cells.settings().silent_after)},
                  {"tiles", std::move(tiles)},
                  {"totals", totals_of(cells)}});
}

}  // namespace cellmirror::app
