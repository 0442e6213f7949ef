// Forces and torques of one robot, from the worker that computes them to a plain buffer in shared memory (rob_ela_shm).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace cellmirror::app {

class RobotForceChannel {
 public:
  virtual ~RobotForceChannel() = default;
  // One writer. Force in N, in the end-effector frame; torques by joint, Nm (N for joints that slide). Values that are
  // not finite make all of them zero, as does a robot of which nothing is known.
  virtual void write(const Eigen::Vector3d& force_T, std::span<const double> torques) = 0;
};

struct RobotForceSnapshot {
  std::string robot;
  std::int32_t key = 0;
  std::size_t bytes = 0;
  std::uint64_t attached = 0;  // processes that share it, ourselves included
  std::uint64_t renewed = 0;   // times that the memory was removed and created again
  std::shared_ptr<RobotForceChannel> channel;
};

}  // namespace cellmirror::app
