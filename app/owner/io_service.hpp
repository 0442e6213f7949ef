// The I/O nodes that answer a controller ([[io_node]]): their channels, and what their outputs do. Belongs to the
// thread that owns the cell.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/owner/fleet.hpp"
#include "app/owner/motion/motion_service.hpp"
#include "app/snapshot/fault_target.hpp"
#include "app/snapshot/io_snapshot.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/ports/io_config.hpp"
#include "scripts/commands/motion_host.hpp"
#include "scripts/runner/script_runner.hpp"

namespace cellmirror::app {

class NodeChannels;

class IoService {
 public:
  struct Parts {
    const Cell& cell;
    Fleet& fleet;
    MotionHost& motion;
    const MotionService& targets;
    script::ScriptRunner& runner;
    const Clock& clock;
    const NodeChannels& channels;
  };

  // What the parts refer to outlives the service; the channels have those of all nodes. `wake`: wakes the owner's
  // thread; any thread.
  IoService(Parts parts, std::vector<IoNodeConfig> nodes, const std::function<void()>& wake);
  // Closes the channels.
  ~IoService();
  IoService(const IoService&) = delete;
  IoService& operator=(const IoService&) = delete;

  // Opens the channels. One that cannot be opened is tried again from time to time, and told in status.
  void prepare();
  // Carries out outputs that have changed. True where there were any.
  bool follow();

  [[nodiscard]] std::vector<IoNodeSnapshot> snapshots() const;

 private:
  // Outlives the service with commands whose answer is awaited.
  struct Refusals {
    std::uint64_t count = 0;
    std::string last;
  };
  struct Node {
    std::shared_ptr<const IoNodeConfig> config;
    std::shared_ptr<JointStream> stream;
    std::shared_ptr<Latest<IoInputs>> inputs = std::make_shared<Latest<IoInputs>>();
    std::shared_ptr<Latest<IoOutputs>> outputs = std::make_shared<Latest<IoOutputs>>();
    std::uint32_t done = 0;  // outputs that were carried out
    std::uint64_t changes = 0;
    std::shared_ptr<Refusals> refusals = std::make_shared<Refusals>();
    std::shared_ptr<const FaultTarget> faults;
    std::string trouble;
    bool open = false;
    Timestamp tried;
  };

  void open(Node& node);
  void carry_out(Node& node, const DigitalOutputConfig& output, bool on);
  [[nodiscard]] Result<void> move(const JointOutput& output, bool on);
  static void note(Refusals& refusals, const std::string& source, const Error& why);

  Parts parts_;
  std::vector<Node> nodes_;
};

}  // namespace cellmirror::app
