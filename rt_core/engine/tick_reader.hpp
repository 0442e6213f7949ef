// How a thread reads what the tick publishes.
#pragma once

#include <string>
#include <utility>

#include "rt_core/engine/tick_state.hpp"
#include "rt_core/rt/broadcast.hpp"

namespace cellmirror::engine {

// A subscription to the states that the tick publishes, for one thread. Engine::subscribe() makes them.
class TickReader {
 public:
  // `edge` outlives the reader.
  TickReader(std::string name, Broadcast<TickState>::Reader& edge) : name_(std::move(name)), edge_(edge) {}
  TickReader(const TickReader&) = delete;
  TickReader& operator=(const TickReader&) = delete;

  // The state that was published last. The reference stays valid and unchanged until the next call.
  [[nodiscard]] const TickState& newest() CELL_RT { return edge_.read().value; }

  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
  Broadcast<TickState>::Reader& edge_;
};

}  // namespace cellmirror::engine
