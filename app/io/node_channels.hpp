// The channels on which the gateway answers controllers, for drives ([[device]]) and I/O nodes ([[io_node]]). Those
// with the same channel share it and its thread.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/can/stream/streams.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/io_config.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::app {

class CanTap;

class NodeChannels {
 public:
  // All of the cell file, closed. `clock` outlives them. `fifo_priority`: of their threads, 0 for none. `tap`: sees
  // their frames under the name of the first robot in alphabetical order that has drives on the channel, else under
  // "io_node_" and the first I/O node's number; outlives them; null: nobody does.
  NodeChannels(const std::map<std::string, StreamConfig, std::less<>>& streams, std::span<const IoNodeConfig> io_nodes,
               const Clock& clock, int fifo_priority, CanTap* tap);

  // Null where no drive and no I/O node of the cell file has this channel. Two channels are the same where all keys of
  // their tables are.
  [[nodiscard]] std::shared_ptr<can::SharedChannel> find(const CanChannelConfig& config) const;

 private:
  struct Entry {
    CanChannelConfig config;
    std::shared_ptr<can::SharedChannel> channel;
  };
  std::vector<Entry> entries_;
};

}  // namespace cellmirror::app
