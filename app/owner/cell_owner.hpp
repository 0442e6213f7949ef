// The owner of the cell: it executes SCRIPT from messages and files, and nobody else changes the model. In the gateway
// it has a thread; the off-line simulation gives it turns between ticks.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "app/io/node_channels.hpp"
#include "app/owner/command_queue.hpp"
#include "app/owner/controllers/controller_service.hpp"
#include "app/owner/display/display_service.hpp"
#include "app/owner/fleet.hpp"
#include "app/owner/foot_switch_service.hpp"
#include "app/owner/haptics/haptic_service.hpp"
#include "app/owner/hosts.hpp"
#include "app/owner/interaction.hpp"
#include "app/owner/io_service.hpp"
#include "app/owner/motion/coupling_service.hpp"
#include "app/owner/motion/guarded_motion.hpp"
#include "app/owner/motion/motion_service.hpp"
#include "app/owner/node_levels.hpp"
#include "app/owner/programs/program_motion.hpp"
#include "app/owner/programs/program_service.hpp"
#include "app/owner/robot_force_service.hpp"
#include "app/owner/sensing.hpp"
#include "app/owner/tcp_force_service.hpp"
#include "app/owner/tissue/tissue_service.hpp"
#include "app/owner/volume/volume_service.hpp"
#include "app/snapshot/cell_state.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/rt/wake_signal.hpp"
#include "scripts/runner/script_runner.hpp"

namespace cellmirror::app {

class CellOwner {
 public:
  static constexpr std::size_t kCommandQueue = 64;  // beside what waits in the System V queue

  struct Parts {
    Cell cell;
    KismetHome home;
    std::map<std::string, StreamConfig, std::less<>> streams;
    std::vector<RobotHaptic> haptics;
    std::vector<IoNodeConfig> io_nodes = {};
    std::vector<ControllerConfig> controllers = {};  // of ROS 2
    std::vector<ViewSetting> views;
    DisplayLayout layout = {};
    collision::Settings collision;
    TissueParts tissue = {};
    FootSwitchSettings foot_switches;
    std::function<void(const FootSwitchChange& change)> switch_changed = {};  // by the owner's thread
    engine::Engine& engine;
    Board<CellState>& board;
    const Clock& clock;
    int stream_priority = 0;  // SCHED_FIFO priority of the streams' threads; 0: none
    std::string instance;
    std::int32_t tcp_force_key = kTcpForceKey;
    std::uint32_t memory_mode = 0600;
    ForceGuard* guard = nullptr;        // of the shared memories; outlives the owner; null: none
    CanTap* can_tap = nullptr;          // sees the frames of CAN streams; outlives the owner; null: nobody does
    PayloadTap* payload_tap = nullptr;  // what DDS and RTDE streams receive; likewise
    std::function<Result<void>(std::string_view file_name)> save_flight_record;
    std::function<Result<void>(RecordAction action)> record = {};  // empty: off line
    // `alarm`: 0 for all. Empty: off line.
    std::function<Result<std::string>(std::string_view name, std::uint64_t alarm)> acknowledge_alarms = {};
    std::function<std::uint64_t()> picture_updates = {};  // so far; empty: counted by the clock
    std::function<void()> bell = {};                      // with a message while BEEP is on
    // Off line nothing runs beside the owner: where it waits for the tick it lets one pass with this. Robots cannot be
    // mirrored then, and shared memories are not made. Empty: the gateway, where the tick has its own thread.
    std::function<void()> let_tick_pass = {};
    std::function<void(const Diagnostics& findings)> refused = {};  // with each command of a file that is refused
    script::ScriptRunner::TraceFunction traced = {};                // with each command that is done or refused
    std::function<std::optional<Error>(script::FormId command, script::CommandSource::Kind from)> withheld =
        {};                                                                                 // ScriptRunner::Events
    std::function<void(std::string_view robot, const motion::Move& move)> move_given = {};  // to the tick
    std::function<void(const program::ProgramEvent&)> program_event = {};
    std::function<void(const ShownText& message)> message_shown = {};
  };

  explicit CellOwner(Parts parts);
  // Closes the streams. The loop has to stand still by then: it looks into chains that end with this.
  ~CellOwner();
  CellOwner(const CellOwner&) = delete;
  CellOwner& operator=(const CellOwner&) = delete;

  // Before start(): gives the tick its robots, publishes the first state, and starts the startup script, if any
  // (`script`: any path where `is_path`, else a file of the home's scripts/, with or without that folder in front).
  Result<void> prepare(const std::string& script, bool is_path);
  void start();
  [[nodiscard]] bool running() const { return thread_.joinable(); }
  // Ends the thread; submit() waits no longer.
  void stop();

  // Instead of start(), where the owner has no thread: all that can be done now, bounded. True where there may be
  // more to do at once; else it has to come back after the next tick.
  bool turn();
  // No script, no move, no robot program and no script of a foot switch is under way.
  [[nodiscard]] bool quiet() const;

  // From the receiver's thread: waits while the queue is full, so that the senders see the System V queue fill up. At
  // the end of the owner what is left is answered as refused.
  void submit(script::ScriptCommand command);
  // From any other thread: false, at once, and `command` as it was, where the queue is full.
  [[nodiscard]] bool offer(script::ScriptCommand& command);
  [[nodiscard]] engine::QueueStatus command_queue() const { return queue_.status(); }
  // For tests with a manual clock, from any thread: makes the owner take a turn at once instead of within a
  // millisecond, and tells how many it has begun. Once that has risen by two, what lay before the owner then has been
  // seen to.
  void wake() { wake_.wake(); }
  [[nodiscard]] std::uint64_t turns() const { return turns_.load(std::memory_order_acquire); }
  // For the off-line gateway.
  [[nodiscard]] const ProgramService& programs() const { return programs_; }

 private:
  void loop(const std::stop_token& stop);
  bool execute_messages();
  bool execute_files();
  void publish_state();
  [[nodiscard]] bool is_online(std::size_t slot) const;

  WakeSignal wake_;  // of the owner's thread
  Cell cell_;
  KismetHome home_;
  Board<CellState>& board_;
  const Clock& clock_;
  NodeChannels node_channels_;
  CellNames names_;
  VolumeService volumes_;
  std::unique_ptr<Fleet> fleet_;
  DisplayService display_;
  MotionService motion_;
  CouplingService couplings_;
  CellProgramMotion program_motion_;
  ProgramService programs_;
  ControllerService controllers_;
  GuardedMotion guarded_motion_;
  CellWorld world_;
  CellRobots robots_;
  CellSensing sensing_;
  HapticService haptics_;
  TcpForceService forces_;
  RobotForceService robot_forces_;
  CellInteraction interaction_;
  TissueService tissue_;
  CellDiagnosis diagnosis_;
  std::unique_ptr<script::ScriptRunner> runner_;
  CommandQueue queue_{kCommandQueue};
  NodeLevels levels_;
  std::unique_ptr<FootSwitchService> switches_;  // its thread wakes the owner's
  std::unique_ptr<IoService> io_;                // likewise; null: off line
  WakeSignal room_;                              // wakes the receiver's thread when the queue has room again
  Timestamp last_publication_;
  bool changed_ = true;  // since the last publication
  std::atomic<std::uint64_t> turns_{0};
  std::stop_source stopping_;  // apart from the thread, so that submit() may ask before the thread is there
  std::thread thread_;
};

}  // namespace cellmirror::app
