// States that do not come from the loop, for the readers of the gateway's cell: robots keep their names, slots may
// differ. One thread publishes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "app/recording_layout/tick_inputs.hpp"
#include "app/snapshot/board.hpp"
#include "app/snapshot/cell_state.hpp"
#include "rt_core/engine/tick_reader.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/rt/broadcast.hpp"

namespace cellmirror::app {

class TickPublication {
 public:
  // For cells of at most so many robots. `board` outlives it.
  TickPublication(std::size_t robots, const Board<CellState>& board)
      : states_(engine::TickState(robots)), board_(board) {}

  // Before the first publication; as Engine::subscribe().
  engine::TickReader& subscribe(std::string name) {
    return readers_.emplace_back(std::move(name), states_.subscribe());
  }

  // `recorded` by the slots of `names`; `revision` changes with them. A robot of the cell that is not there stands
  // where it starts.
  void publish(const engine::TickState& recorded, const NamesBySlot& names, std::uint64_t revision);
  // Robots of the cell that the recording does not have, or with other joints; as of the last publication.
  [[nodiscard]] const std::vector<std::string>& missing() const { return missing_; }

 private:
  void match(const CellState& cell_state, const NamesBySlot& names);

  Broadcast<engine::TickState> states_;
  std::deque<engine::TickReader> readers_;
  const Board<CellState>& board_;
  std::shared_ptr<const CompiledCell> cell_;  // matched with
  std::uint64_t revision_ = 0;                // likewise
  struct Match {
    std::size_t recorded = 0;
    std::size_t slot = 0;
  };
  std::vector<Match> matches_;
  std::vector<std::string> missing_;
};

}  // namespace cellmirror::app
