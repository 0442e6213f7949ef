#include "app/wall/wall_cells.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cellmirror::app {

namespace {

constexpr std::uint64_t kMostLostAtOnce = 1'000'000;  // a sequence is a number from outside

bool same_gateway(const WallTile& tile, const CellSummary& summary) {
  return tile.host == summary.host && tile.instance == summary.instance;
}

bool is_expected_gateway(const WallCell& expected, const WallTile& tile) {
  return (expected.host.empty() || expected.host == tile.host) &&
         (expected.instance.empty() || expected.instance == tile.instance);
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

}  // namespace

std::vector<WallMark> WallTile::marks() const {
  std::vector<WallMark> out;
  const auto add = [&](bool is, WallMark mark) {
    if (is) out.push_back(mark);
  };
  add(conflict, WallMark::conflict);
  add(expected != nullptr && ever_heard() && !is_expected_gateway(*expected, *this), WallMark::wrong_gateway);
  add(unexpected, WallMark::unexpected);
  add(!called_before.empty() || names_refused > 0, WallMark::renamed);
  add(summary && summary->version > kCellSummaryVersion, WallMark::newer_version);
  add(live && std::abs(clock_difference_s) > kClockDifferenceShown_s, WallMark::clock);
  add(flooding, WallMark::flood);
  add(rejected > 0, WallMark::rejected);
  return out;
}

CellHealth level_of(const WallTile& tile) {
  if (!tile.live || !tile.summary) return CellHealth::fault;
  if (tile.summary->health == CellHealth::ok && !tile.marks().empty()) return CellHealth::attention;
  return tile.summary->health;
}

WallCells::WallCells(WallSettings settings) : settings_(std::move(settings)) {
  for (const WallCell& cell : settings_.cells) {
    if (!by_cell_.contains(cell.name)) add(cell.name);
  }
}

WallTile* WallCells::add(const std::string& cell) {
  if (tiles_.size() >= kMostWallTiles && !make_room()) return nullptr;
  WallTile& tile = tiles_[next_number_];
  tile.number = next_number_++;
  tile.cell = cell;
  const auto expected = std::ranges::find(settings_.cells, cell, &WallCell::name);
  if (expected != settings_.cells.end()) tile.expected = &*expected;
  tile.unexpected = tile.expected == nullptr && !settings_.cells.empty();
  by_cell_[cell].push_back(tile.number);
  return &tile;
}

// Removes a cell that nobody expects, the one that is silent for longest.
bool WallCells::make_room() {
  const WallTile* oldest = nullptr;
  for (const auto& [number, tile] : tiles_) {
    if (tile.live || tile.expected != nullptr) continue;
    if (oldest == nullptr || tile.last_heard_wall_ns < oldest->last_heard_wall_ns) oldest = &tile;
  }
  if (oldest == nullptr) return false;
  erase(oldest->number);
  return true;
}

void WallCells::erase(std::uint64_t number) {
  const auto found = tiles_.find(number);
  if (found == tiles_.end()) return;
  if (const auto of = by_cell_.find(found->second.cell); of != by_cell_.end()) {
    std::erase(of->second, number);
    if (of->second.empty()) by_cell_.erase(of);
  }
  std::erase_if(senders_, [number](const auto& entry) { return entry.second.tile == number; });
  tiles_.erase(found);
}

void WallCells::remember(const RememberedCell& cell) {
  const auto known = by_cell_.find(cell.cell);
  WallTile* tile = known == by_cell_.end() ? add(cell.cell) : &tiles_.at(known->second.front());
  if (tile == nullptr || tile->ever_heard()) return;
  tile->host = cell.host;
  tile->instance = cell.instance;
  tile->last_heard_wall_ns = cell.last_heard_wall_ns;
  ++tile->version;
}

std::vector<RememberedCell> WallCells::remembered() const {
  std::vector<RememberedCell> out;
  for (const auto& [number, tile] : tiles_) {
    if (tile.ever_heard()) out.push_back({tile.cell, tile.host, tile.instance, tile.last_heard_wall_ns});
  }
  return out;
}

WallTile* WallCells::tile_of(std::string_view sender) {
  const auto found = senders_.find(sender);
  const auto tile = found == senders_.end() ? tiles_.end() : tiles_.find(found->second.tile);
  return tile == tiles_.end() ? nullptr : &tile->second;
}

WallCells::Sender* WallCells::sender_of(const std::string& name) {
  if (const auto found = senders_.find(name); found != senders_.end()) return &found->second;
  if (senders_.size() >= kMostWallSenders) {
    std::erase_if(senders_, [this](const auto& entry) {
      const auto tile = tiles_.find(entry.second.tile);
      return tile == tiles_.end() || !tile->second.live;
    });
  }
  return senders_.size() >= kMostWallSenders ? nullptr : &senders_[name];
}

WallTile* WallCells::place_for(const WallMessage& message) {
  const auto claims = by_cell_.find(message.summary.cell);
  if (claims == by_cell_.end()) return nullptr;
  WallTile* best = nullptr;
  int rank = 0;
  for (const std::uint64_t number : claims->second) {
    WallTile& tile = tiles_.at(number);
    // Where the one before still sends, it comes back and finds its place taken: then both are shown.
    const bool restarted = same_gateway(tile, message.summary) && tile.previous_sender != message.sender;
    const int fit = tile.sender == message.sender ? 4 : !tile.ever_heard() ? 3 : restarted ? 2 : !tile.live ? 1 : 0;
    if (fit <= rank) continue;
    rank = fit;
    best = &tile;
  }
  return best;
}

WallTile* WallCells::claim(const WallMessage& message) {
  WallTile* const before = tile_of(message.sender);
  if (before != nullptr && before->cell == message.summary.cell) return before;
  Sender* sender = sender_of(message.sender);
  if (sender == nullptr) return nullptr;
  if (!contains(sender->names, message.summary.cell)) {
    if (sender->names.size() >= kMostNamesOfSender) {
      if (before == nullptr) return nullptr;
      ++before->names_refused;
      ++before->version;
      return nullptr;
    }
    sender->names.push_back(message.summary.cell);
  }
  const std::uint64_t number_before = before == nullptr ? 0 : before->number;
  const std::string name_before = before == nullptr ? std::string() : before->cell;
  WallTile* tile = place_for(message);
  if (tile == nullptr) tile = add(message.summary.cell);
  if (tile == nullptr) return nullptr;
  if (tile->sender != message.sender) {
    if (!tile->sender.empty() && senders_.contains(tile->sender) && senders_[tile->sender].tile == tile->number)
      senders_[tile->sender].tile = 0;
    tile->previous_sender = std::exchange(tile->sender, message.sender);
    if (tile->ever_heard() && !same_gateway(*tile, message.summary))
      tile->moved_from = tile->host + "/" + tile->instance;
  }
  tile->called_before = name_before;
  senders_[message.sender].tile = tile->number;
  // What it was before is silent from now on.
  if (const auto left = tiles_.find(number_before); left != tiles_.end()) {
    left->second.live = false;
    ++left->second.version;
  }
  return tile;
}

void WallCells::update(WallTile& tile, const WallMessage& message, std::int64_t wall_ns) {
  const CellSummary& next = message.summary;
  if (tile.summary && tile.summary->run == next.run) {
    const std::uint64_t last = tile.summary->sequence;
    if (next.sequence <= last) ++tile.repeated;
    if (next.sequence > last) tile.lost += std::min(next.sequence - last - 1, kMostLostAtOnce);
  } else if (tile.summary) {
    ++tile.restarts;
  }
  tile.summary = next;
  tile.host = next.host;
  tile.instance = next.instance;
  tile.last_heard = message.receive_time;
  tile.last_heard_wall_ns = wall_ns;
  tile.clock_difference_s = 1e-9 * (static_cast<double>(next.time_ns) - static_cast<double>(wall_ns));
  tile.live = true;
  ++tile.received;
  ++tile.version;
}

void WallCells::receive(const WallMessage& message, std::int64_t wall_ns) {
  ++totals_.received;
  WallTile* tile = claim(message);
  if (tile == nullptr) {
    ++totals_.left_out;
    return;
  }
  update(*tile, message, wall_ns);
}

void WallCells::dropped(std::string_view sender, std::uint64_t number, Timestamp now) {
  totals_.dropped += number;
  WallTile* tile = tile_of(sender);
  if (tile == nullptr) return;
  tile->dropped += number;
  tile->last_dropped = now;
  tile->flooding = true;
  ++tile->version;
}

void WallCells::rejected(std::string_view sender, std::uint64_t number, std::string_view why) {
  totals_.rejected += number;
  totals_.rejected_why = why;
  WallTile* tile = tile_of(sender);
  if (tile == nullptr) return;
  tile->rejected += number;
  tile->rejected_why = why;
  ++tile->version;
}

void WallCells::gone(std::string_view sender) {
  WallTile* tile = tile_of(sender);
  if (tile == nullptr || !tile->live) return;
  tile->live = false;
  ++tile->version;
}

// A dead gateway stays on the wall although another one has the name of its cell: nobody may miss its death.
bool WallCells::is_superseded(const WallTile& dead, const std::vector<std::uint64_t>& numbers) const {
  return std::ranges::any_of(numbers, [&](std::uint64_t number) {
    const WallTile& other = tiles_.at(number);
    if (!other.live) return false;
    const bool is_same = other.host == dead.host && other.instance == dead.instance;
    // The list names one gateway: the dead one never was that cell.
    const bool was_wrong = dead.expected != nullptr && is_expected_gateway(*dead.expected, other) &&
                           !is_expected_gateway(*dead.expected, dead);
    return is_same || was_wrong;
  });
}

void WallCells::forget_claims(std::vector<std::uint64_t>& numbers) {
  std::vector<std::uint64_t> dead;
  for (const std::uint64_t number : numbers) {
    if (!tiles_.at(number).live) dead.push_back(number);
  }
  std::ranges::sort(dead, {}, [this](std::uint64_t number) { return tiles_.at(number).last_heard_wall_ns; });
  const std::size_t too_many = dead.size() - std::min(dead.size(), kMostDeadClaims);
  for (std::size_t i = 0; i < dead.size(); ++i) {
    if (i >= too_many && !is_superseded(tiles_.at(dead[i]), numbers)) continue;
    std::erase_if(senders_, [&](const auto& entry) { return entry.second.tile == dead[i]; });
    std::erase(numbers, dead[i]);
    tiles_.erase(dead[i]);
  }
}

void WallCells::settle_claims(std::vector<std::uint64_t>& numbers) {
  if (numbers.size() > 1) forget_claims(numbers);
  const auto live = std::ranges::count_if(numbers, [this](std::uint64_t number) { return tiles_.at(number).live; });
  for (const std::uint64_t number : numbers) {
    WallTile& tile = tiles_.at(number);
    if (tile.conflict == (live > 1)) continue;
    tile.conflict = live > 1;
    ++tile.version;
  }
}

void WallCells::look(Timestamp now) {
  for (auto& [number, tile] : tiles_) {
    if (tile.live && now - tile.last_heard > settings_.silent_after) {
      tile.live = false;
      ++tile.version;
    }
    if (tile.flooding && now - tile.last_dropped > kFloodShownFor) {
      tile.flooding = false;
      ++tile.version;
    }
  }
  for (auto& [cell, numbers] : by_cell_) settle_claims(numbers);
}

}  // namespace cellmirror::app
