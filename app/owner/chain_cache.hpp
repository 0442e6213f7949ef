// Keeps the chains of robots that the tick may still look into (engine::Command::chain says how long). Belongs to the
// thread that owns the cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "rt_core/engine/tick_state.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::app {

class ChainCache {
 public:
  using Chain = std::shared_ptr<const kinematics::Chain>;

  // `command` tells the tick of a new chain (null: of none) for the slot; `newest_move` was given to it before.
  void replaced(std::size_t slot, Chain chain, std::uint64_t command, std::uint32_t newest_move);
  // `command` takes the robot of the slot out of the tick, with all its moves.
  void removed(std::size_t slot, std::uint64_t command);
  // Lets go what the tick has no use for any more.
  void release(const engine::TickState& tick);

  [[nodiscard]] std::size_t kept() const { return old_.size() + current_.size(); }

 private:
  struct Old {
    Chain chain;
    std::size_t slot;
    std::uint64_t command;   // kept until this is carried out
    std::uint32_t move = 0;  // and until this one has ended; 0: none
  };

  std::map<std::size_t, Chain> current_;  // by slot
  std::vector<Old> old_;
};

}  // namespace cellmirror::app
