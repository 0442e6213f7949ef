// An I/O node that the gateway answers for, as the other threads see it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "app/snapshot/fault_target.hpp"
#include "rt_core/ports/io_config.hpp"
#include "rt_core/ports/io_image.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::app {

struct IoNodeSnapshot {
  std::shared_ptr<const IoNodeConfig> config;
  std::shared_ptr<const JointStream> stream;
  std::shared_ptr<Latest<IoInputs>> inputs;  // the I/O worker writes, the node's thread reads
  std::uint32_t outputs = 0;                 // that were carried out last
  std::uint64_t output_changes = 0;
  std::uint64_t refused = 0;  // of them: commands and moves that were refused
  std::string last_refusal;   // empty: none
  std::string trouble;        // why the channel is not open; empty: it is
  std::shared_ptr<const FaultTarget> faults;
};

}  // namespace cellmirror::app
