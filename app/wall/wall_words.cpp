#include "app/wall/wall_words.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app/wall/wall_inbox.hpp"

namespace cellmirror::app {

namespace {

std::string gateway_text(std::string_view host, std::string_view instance) {
  return fmt::format("{}/{}", host.empty() ? "any host" : host, instance.empty() ? "any instance" : instance);
}

std::string renamed_text(const WallTile& tile) {
  if (tile.names_refused > 0)
    return fmt::format("its gateway calls itself by more than {} names; the others are left out", kMostNamesOfSender);
  return fmt::format("its gateway called itself {} before, without a restart", tile.called_before);
}

}  // namespace

std::string_view word(WallMark mark) {
  switch (mark) {
    case WallMark::conflict:
      return "conflict";
    case WallMark::wrong_gateway:
      return "wrong_gateway";
    case WallMark::unexpected:
      return "unexpected";
    case WallMark::renamed:
      return "renamed";
    case WallMark::newer_version:
      return "newer_version";
    case WallMark::clock:
      return "clock";
    case WallMark::flood:
      return "flood";
    case WallMark::rejected:
      return "rejected";
  }
  return "";
}

std::string mark_text(const WallTile& tile, WallMark mark) {
  switch (mark) {
    case WallMark::conflict:
      return fmt::format("two gateways say that they are this cell; this one is {}",
                         gateway_text(tile.host, tile.instance));
    case WallMark::wrong_gateway:
      return fmt::format("this is {}, but the list of cells has {}", gateway_text(tile.host, tile.instance),
                         gateway_text(tile.expected->host, tile.expected->instance));
    case WallMark::unexpected:
      return "it is not in the list of cells";
    case WallMark::renamed:
      return renamed_text(tile);
    case WallMark::newer_version:
      return fmt::format("its summaries have version {}, this wall knows version {}: update the wall",
                         tile.summary->version, kCellSummaryVersion);
    case WallMark::clock:
      return fmt::format("its clock is {:.0f} s {} that of the wall", std::abs(tile.clock_difference_s),
                         tile.clock_difference_s > 0 ? "ahead of" : "behind");
    case WallMark::flood:
      return fmt::format("it sends more than {} summaries a second; the others are left out", kSummariesPerSecond);
    case WallMark::rejected:
      return fmt::format("some of what it sends is refused: {}", tile.rejected_why);
  }
  return {};
}

std::string_view state_word(const WallTile& tile) {
  if (!tile.ever_heard()) return "never seen";
  if (!tile.live || !tile.summary) return "silent";
  return cellmirror::word(tile.summary->health);
}

}  // namespace cellmirror::app
