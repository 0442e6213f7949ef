// Writes the force at the TCP of the active robot into the shared memory of key 1313, every tick.
#pragma once

#include <cstdint>

#include "app/gateway/picture.hpp"
#include "app/gateway/tick_worker.hpp"
#include "ipc/wire/tcp_force_block.hpp"
#include "rt_core/engine/engine.hpp"

namespace cellmirror::app {

// As the picture and the tick tell; without sequence.
[[nodiscard]] TcpForce tcp_force_of(const OwnerPicture& picture, const engine::TickState& tick);

class TcpForceWorker final : private TickJob {
 public:
  // All are not owned and outlive the worker.
  TcpForceWorker(engine::Engine& engine, const PictureBoard& pictures, const Clock& clock, Nanoseconds tick_period);

 private:
  bool wanted(const OwnerPicture& picture) override { return picture.tcp_force != nullptr; }
  void run(const OwnerPicture& picture, const engine::TickState& tick) override;

  std::uint64_t sequence_ = 0;
  TickWorker worker_;  // last: it uses everything above
};

}  // namespace cellmirror::app
