#include "app/owner/chain_cache.hpp"

#include <utility>

namespace cellmirror::app {

void ChainCache::replaced(std::size_t slot, Chain chain, std::uint64_t command, std::uint32_t newest_move) {
  Chain& current = current_[slot];
  if (current) old_.push_back({std::move(current), slot, command, newest_move});
  current = std::move(chain);
}

void ChainCache::removed(std::size_t slot, std::uint64_t command) {
  for (Old& old : old_) {
    if (old.slot != slot) continue;
    old.command = command;
    old.move = 0;
  }
  replaced(slot, nullptr, command, 0);
  current_.erase(slot);
}

void ChainCache::release(const engine::TickState& tick) {
  std::erase_if(old_, [&](const Old& old) {
    return tick.commands_done >= old.command && tick.robots[old.slot].motion.finished >= old.move;
  });
}

}  // namespace cellmirror::app
