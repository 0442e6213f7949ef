// The cells of a wall: what gateways said of them last, who says so, and what does not fit. Pure: no I/O, no clock.
// Ages are by the instants of receiving alone, never by a sender's clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/wall_settings.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/cell_summary.hpp"

namespace cellmirror::app {

inline constexpr std::size_t kMostWallTiles = 1'200;  // kMostWallCells, and some that two gateways claim
inline constexpr std::size_t kMostWallSenders = 4'096;
inline constexpr std::size_t kMostNamesOfSender = 4;
inline constexpr Nanoseconds kFloodShownFor{10'000'000'000};
inline constexpr double kClockDifferenceShown_s = 2;

struct WallMessage {
  CellSummary summary;
  std::string sender;  // of the transport, which no gateway can choose: the GUID of a DDS writer
  Timestamp receive_time;
  std::size_t bytes = 0;
};

// What the wall adds to the summary of a cell.
enum class WallMark : std::uint8_t {
  conflict,       // two gateways say that they are this cell
  wrong_gateway,  // wall.toml expects another host or instance
  unexpected,     // wall.toml does not name this cell
  renamed,        // its gateway called itself by another name before
  newer_version,  // its summaries have more than this program knows
  clock,          // its clock differs from this machine's
  flood,          // it sends more than is taken
  rejected,       // some of what it sends is no summary
};

// A gateway that says it is that cell; or a cell of which nothing was heard yet.
struct WallTile {
  std::uint64_t number = 0;   // does not change, is not used again
  std::uint64_t version = 0;  // of all that follows: grows with each change
  std::string cell;
  const WallCell* expected = nullptr;  // by wall.toml
  std::string sender;                  // empty: not heard in this run of the wall
  std::optional<CellSummary> summary;  // the newest; none: nothing was heard in this run
  std::string host;                    // of the gateway, also where it is known from an earlier run of the wall
  std::string instance;
  Timestamp last_heard;                 // never: not in this run
  std::int64_t last_heard_wall_ns = 0;  // since 1970 (UTC), by this machine's clock; 0: never
  bool live = false;                    // heard within WallSettings::silent_after, and its writer is there
  std::string called_before;            // the other name
  std::string moved_from;               // "host/instance", where another gateway was this cell before
  bool conflict = false;                // while more than one is live
  bool unexpected = false;              // wall.toml names cells, but not this one
  bool flooding = false;                // something was dropped within kFloodShownFor
  double clock_difference_s = 0;        // positive: the gateway's clock is ahead
  std::uint64_t received = 0;
  std::uint64_t lost = 0;      // by gaps of the sequence
  std::uint64_t repeated = 0;  // with a sequence that is not greater than the one before
  std::uint64_t restarts = 0;  // of the gateway
  std::uint64_t dropped = 0;   // flood
  Timestamp last_dropped;
  std::uint64_t rejected = 0;
  std::string rejected_why;         // of the last one
  std::uint64_t names_refused = 0;  // messages under further names of the same sender

  std::string previous_sender = {};  // whose place this one took

  [[nodiscard]] bool ever_heard() const { return last_heard_wall_ns != 0; }
  // In the order of WallMark.
  [[nodiscard]] std::vector<WallMark> marks() const;
};

// How bad it is: fault for a cell that is silent or was never heard, at least attention where there is a mark.
[[nodiscard]] CellHealth level_of(const WallTile& tile);

struct WallTotals {
  std::uint64_t received = 0;
  std::uint64_t rejected = 0;
  std::uint64_t dropped = 0;      // flood
  std::uint64_t left_out = 0;     // there were too many cells, senders or names
  std::string rejected_why = {};  // of the last one, of any sender
};

// What is kept over a restart of the wall.
struct RememberedCell {
  std::string cell;
  std::string host;
  std::string instance;
  std::int64_t last_heard_wall_ns = 0;

  bool operator==(const RememberedCell&) const = default;
};

class WallCells {
 public:
  static constexpr std::size_t kMostDeadClaims = 4;  // silent gateways of one cell name that are kept

  explicit WallCells(WallSettings settings);
  WallCells(const WallCells&) = delete;
  WallCells& operator=(const WallCells&) = delete;

  // Of an earlier run, before anything is received.
  void remember(const RememberedCell& cell);
  // `wall_ns`: the receive time since 1970 (UTC).
  void receive(const WallMessage& message, std::int64_t wall_ns);
  // So many messages of that sender were dropped since the last call.
  void dropped(std::string_view sender, std::uint64_t number, Timestamp now);
  void rejected(std::string_view sender, std::uint64_t number, std::string_view why);
  // So many messages were left out before they came here.
  void left_out(std::uint64_t number) { totals_.left_out += number; }
  // Its writer was closed, or is not there any more.
  void gone(std::string_view sender);
  // What changes by time alone. Several times a second.
  void look(Timestamp now);

  [[nodiscard]] const std::map<std::uint64_t, WallTile>& tiles() const { return tiles_; }
  [[nodiscard]] const WallTotals& totals() const { return totals_; }
  [[nodiscard]] const WallSettings& settings() const { return settings_; }
  [[nodiscard]] std::vector<RememberedCell> remembered() const;

 private:
  struct Sender {
    std::uint64_t tile = 0;
    std::vector<std::string> names;
  };

  WallTile* tile_of(std::string_view sender);
  // The tile that the message belongs to; null: it is left out.
  WallTile* claim(const WallMessage& message);
  // Of those that this sender may take over; null: none.
  WallTile* place_for(const WallMessage& message);
  WallTile* add(const std::string& cell);
  bool make_room();
  Sender* sender_of(const std::string& name);
  void erase(std::uint64_t number);
  void update(WallTile& tile, const WallMessage& message, std::int64_t wall_ns);
  // Several gateways may say that they are one cell; `numbers` are their tiles.
  [[nodiscard]] bool is_superseded(const WallTile& dead, const std::vector<std::uint64_t>& numbers) const;
  void forget_claims(std::vector<std::uint64_t>& numbers);
  void settle_claims(std::vector<std::uint64_t>& numbers);

  const WallSettings settings_;
  std::map<std::uint64_t, WallTile> tiles_;                                 // by number
  std::map<std::string, std::vector<std::uint64_t>, std::less<>> by_cell_;  // numbers
  std::map<std::string, Sender, std::less<>> senders_;
  WallTotals totals_;
  std::uint64_t next_number_ = 1;
};

}  // namespace cellmirror::app
