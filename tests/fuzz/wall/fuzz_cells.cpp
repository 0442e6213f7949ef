// Lines of any bytes as summaries of a few senders, with gaps of time between: the wall stays within its bounds, has
// each tile once, and its documents are JSON.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>

#include "app/wall/wall_document.hpp"
#include "app/wall/wall_metrics.hpp"
#include "ipc/wire/cell_summary_text.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::app;

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const WallCells& cells) {
  require(cells.tiles().size() <= kMostWallTiles);
  std::set<std::pair<std::string, std::string>> claims;
  for (const auto& [number, tile] : cells.tiles()) {
    require(number == tile.number);
    if (!tile.sender.empty()) require(claims.emplace(tile.cell, tile.sender).second);
    static_cast<void>(level_of(tile));
  }
}

}  // namespace

// A line: a byte for the sender, one for what it does, one for the time, then a summary.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  WallSettings settings;
  settings.cells = {{.name = "A", .host = "h"}, {.name = "B"}};
  WallCells cells(settings);
  WallDocuments documents("v");
  const Thumbnails thumbnails({});
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  Timestamp now{1'000'000'000};
  for (int line = 0; line < 64 && !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (text.size() < 3) continue;
    const std::string sender(1, static_cast<char>('0' + static_cast<unsigned char>(text[0]) % 8));
    now = now + Nanoseconds(std::int64_t{static_cast<unsigned char>(text[2])} * 20'000'000);
    const auto summary = parse_cell_summary(text.substr(3));
    if (summary) {
      cells.receive({*summary, sender, now, text.size()}, to_wall_clock_ns(now));
    } else {
      cells.rejected(sender, 1, summary.error().what);
    }
    if (text[1] == 'g') cells.gone(sender);
    if (text[1] == 'd') cells.dropped(sender, 3, now);
    if (text[1] != 'n') cells.look(now);
    check(cells);
    require(nlohmann::json::accept(documents.changes(cells, thumbnails, now)));
  }
  require(nlohmann::json::accept(documents.whole(cells, thumbnails, now)));
  require(!wall_metrics(cells, {}, now).empty());
  return 0;
}
