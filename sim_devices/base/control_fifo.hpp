// Run-time commands from a FIFO, one per line.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::sim {

class ControlFifo {
 public:
  // Fails where `path` is no FIFO.
  static Result<std::unique_ptr<ControlFifo>> open(const std::string& path);
  ControlFifo(const ControlFifo&) = delete;
  ControlFifo& operator=(const ControlFifo&) = delete;

  // What has come since the last call, whole lines only; never waits. Lines that are too long are dropped.
  [[nodiscard]] std::vector<std::string> lines();

 private:
  explicit ControlFifo(Descriptor fifo) : fifo_(std::move(fifo)) {}

  Descriptor fifo_;
  std::string partial_;
};

}  // namespace cellmirror::sim
