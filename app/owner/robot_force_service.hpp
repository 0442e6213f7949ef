// Plain buffers with the force and the joint torques of a robot (rob_ela_shm below the size of a haptic device's
// memory): float32 values from offset 0, as many as fit (manual 1.2.6). Belongs to the thread that owns the cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/io/robot_force_memory.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/cell/cell.hpp"

namespace cellmirror::app {

class RobotForceService {
 public:
  struct Parts {
    const Cell& cell;
    const Clock& clock;
    std::uint32_t mode = 0600;
    std::string instance;
    ForceGuard* guard = nullptr;  // of the memories; may be null
  };
  explicit RobotForceService(Parts parts) : parts_(std::move(parts)) {}
  ~RobotForceService();  // closes all
  RobotForceService(const RobotForceService&) = delete;
  RobotForceService& operator=(const RobotForceService&) = delete;

  // Makes the buffer of `robot`, in place of an earlier one of the same robot. `bytes`: kLeastHapticBytes to less than
  // a haptic device needs. The answer names the torques that do not fit, and says why values stay zero; empty: neither.
  // Refused: a key that others hold, and what SharedSegment refuses; the earlier buffer is closed then if it had the
  // same key.
  Result<std::string> set_memory(const std::string& robot, std::int32_t key, std::size_t bytes);
  // Closes the buffer of `robot` if it has this key.
  void release(std::string_view robot, std::int32_t key);
  // The robot whose buffer has the key; empty: none has.
  [[nodiscard]] std::string robot_with_key(std::int32_t key) const;
  // Looks after buffers that other processes removed. Often; does something every kFollowEvery.
  void follow();

  [[nodiscard]] std::vector<RobotForceSnapshot> snapshots() const;

 private:
  static constexpr Nanoseconds kFollowEvery{50'000'000};

  struct Buffer {
    std::int32_t key = 0;
    std::size_t bytes = 0;
    std::uint64_t attached = 0;
    std::shared_ptr<RobotForceMemory> memory;
  };

  Parts parts_;
  std::map<std::string, Buffer, std::less<>> buffers_;
  Timestamp last_check_;
};

// What rob_ela_shm answers: the joints of `robot` whose torques do not fit into `bytes`; a robot whose joints move
// nothing that has a mass has no forces but those of a haptic device. Empty: there is nothing to say.
[[nodiscard]] std::string force_memory_remark(const CompiledCell& cell, const CompiledRobot& robot, std::size_t bytes);

}  // namespace cellmirror::app
