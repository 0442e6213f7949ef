// The parts of a running gateway, and what they do together. Only app/gateway includes it.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/alarms/alarm_history.hpp"
#include "app/alarms/alarm_log.hpp"
#include "app/gateway/gateway.hpp"
#include "app/gateway/monitor_page.hpp"
#include "app/gateway/recordings.hpp"
#include "app/gateway/tick_readers.hpp"
#include "app/io/command_log.hpp"
#include "app/io/publisher.hpp"
#include "app/io/summary_publisher.hpp"
#include "app/owner/cell_owner.hpp"
#include "app/playback/played_recording.hpp"
#include "app/render/render_service.hpp"
#include "app/render/scene_service.hpp"
#include "app/report/live_document.hpp"
#include "app/report/problem.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/robot_states.hpp"
#include "app/snapshot/tissue_sources.hpp"
#include "app/workers/collision_worker.hpp"
#include "app/workers/contact_worker.hpp"
#include "app/workers/fault_monitor.hpp"
#include "app/workers/force_worker.hpp"
#include "app/workers/io_worker.hpp"
#include "app/workers/ranging_worker.hpp"
#include "app/workers/tcp_force_worker.hpp"
#include "app/workers/tissue_worker.hpp"
#include "app/workers/trace_worker.hpp"
#include "config/cell_file.hpp"
#include "drivers/mqtt/mqtt_gateway.hpp"
#include "ipc/control/control_request.hpp"
#include "ipc/control/control_server.hpp"
#include "ipc/control/instance.hpp"
#include "ipc/sysv/script_message_receiver.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/ports/playback.hpp"
#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/memory_lock.hpp"
#include "rt_core/rt/watchdog.hpp"

namespace cellmirror::app {

inline constexpr std::chrono::milliseconds kLoopStandsStillAfter{100};

// In the order in which they are made; they end in the reverse order.
struct Gateway::Parts {
  explicit Parts(PlayedRecording* played) : playback(played) {}

  SystemClock machine_clock;
  PlayedRecording* const playback;  // null: real robots
  // Of all that tells times: what is played has the recorded ones.
  const Clock& clock = playback != nullptr ? playback->clock() : machine_clock;
  Timestamp started = machine_clock.now();
  std::string cell_name;
  std::optional<KismetHome> home;
  LoopSettings loop_settings;
  QueueConfig queues;
  MemoryLockOutcome memory;
  std::unique_ptr<CpuLatencyRequest> processors_awake;
  ForceGuard* guard = nullptr;  // may be null
  std::optional<Instance> instance;
  Watchdog watchdog{kLoopStandsStillAfter, {}};
  std::shared_ptr<geometry::SolidLibrary> solids = std::make_shared<geometry::SolidLibrary>();  // of all workers
  std::unique_ptr<engine::Engine> engine;  // where a recording is played: the owner's alone, which moves nothing
  CycleContext own_tick;                   // then
  std::optional<TickReaders> readers;
  Board<CellState> board;
  PictureCounter picture_counter;
  std::unique_ptr<CommandLog> commands;  // null: the cell folder has no place for it
  std::string commands_problem;          // then
  std::unique_ptr<AlarmLog> alarms;      // once the instance is known
  AlarmHistory recorded_alarms;          // of a recording that is played
  Recordings recordings{clock};
  std::unique_ptr<ScriptMessageReceiver> messages;
  std::unique_ptr<TissueWorker> tissue;  // null: the cell has no deformable object
  std::unique_ptr<CellOwner> owner;
  std::unique_ptr<CyclicThread> loop;
  std::atomic<bool> ticking{false};  // the loop runs, for threads that began before it
  std::unique_ptr<CollisionWorker> collisions;
  std::vector<LightBarrier> barriers;  // until the ranging worker has them
  std::unique_ptr<RangingWorker> ranging;
  std::unique_ptr<IoWorker> io;
  std::unique_ptr<ContactWorker> contacts;
  std::unique_ptr<ForceWorker> forces;
  std::unique_ptr<TcpForceWorker> tcp_force;
  std::unique_ptr<TraceWorker> traces;
  std::unique_ptr<mqtt::MqttGateway> mqtt;  // null: not wanted; the publisher has outputs of it
  std::unique_ptr<Publisher> publisher;
  std::unique_ptr<RenderService> renderer;
  std::unique_ptr<SceneService> scene;
  std::unique_ptr<FaultMonitor> faults;
  std::mutex answering;  // of the engine's view for status and of what follows: several threads answer questions
  RobotStateBuilder status_builder;
  std::unique_ptr<MonitorPage> page;
  std::unique_ptr<SummaryPublisher> summaries;
  std::string run;  // for summaries: differs from start to start
  std::unique_ptr<ControlServer> control;

  ~Parts() {
    control.reset();
    summaries.reset();
    // It stays until the end: its threads ask it for its report until it is closed.
    if (page) page->close();
    if (alarms) alarms->stop();
    if (playback != nullptr) playback->stop();
    recordings.stop();
    faults.reset();
    scene.reset();
    renderer.reset();
    publisher.reset();
    if (mqtt) mqtt->stop();
    forces.reset();
    tcp_force.reset();
    contacts.reset();
    if (tissue) tissue->stop();
    io.reset();
    ranging.reset();
    collisions.reset();
    // The receiver's handler may wait for the owner to take a command, so it has to end first; an owner that never
    // began takes none.
    if (owner && !owner->running()) owner->stop();
    if (messages) messages->stop();
    if (owner) owner->stop();
    if (loop) loop->stop();
    owner.reset();
  }

  Result<void> prepare_machine();
  Result<void> take_instance(const GatewayOptions& options);
  void subscribe(std::size_t robots);
  void open_command_log();
  void open_alarms();
  void log_command(CommandRecord record);
  void note_refused(const script::CommandSource& source, std::string_view command, const std::string& why);
  Result<void> make_tissue(const TissueSetup& setup);
  void rest_tissue(const TissueSetup& setup);
  // Empty in a cell without deformable objects; shapes alone where a recording is played.
  [[nodiscard]] TissueSources tissue_sources() const {
    if (playback != nullptr) return {nullptr, [&run = std::as_const(*playback).run()] { return run.tissue().view(); }};
    if (!tissue) return {};
    return {&tissue->reports(), [worker = tissue.get()] { return worker->view(); }};
  }
  Result<void> make_owner(LoadedCell loaded, const GatewayOptions& options);
  void let_own_tick_pass();
  Result<void> start_loop();
  void start_sensing(const Eigen::Vector3d& gravity_W);
  Result<void> start_messages();
  void start_mqtt(const MqttConfig& settings, bool publish);
  Result<void> start_outputs(const DdsOutputConfig& dds, bool publish);
  Result<void> start_renderer(const PictureSettings& settings, bool headless, const DdsOutputConfig& dds);
  void start_recorder(const RecordSettings& settings);
  void start_fault_monitor();
  Result<void> start_summaries(const DdsOutputConfig& dds);
  Result<void> start_control();
  void make_page(const GatewayOptions& options, const WebSettings& settings);

  Result<std::string> write_flight_record(const std::string& file_name, const std::string& reason);
  void answer(std::string_view request, ControlReply reply);
  void answer_snapshot(const ControlRequest& request, ControlReply reply);
  void answer_queues(ControlReply reply);
  [[nodiscard]] Result<void> inject(const ControlRequest& request);
  void answer_playback(const ControlRequest& request, ControlReply reply);
  std::string status();
  web::Health health();
  CellSummary summary();
  [[nodiscard]] OutputCounters output_counters() const;
  [[nodiscard]] Problems problems() const;
  [[nodiscard]] CommandLogReport command_log() const { return commands ? commands->report() : CommandLogReport{}; }
  [[nodiscard]] std::vector<engine::QueueStatus> thread_queues(const CellState& cell_state) const;
  void look_at(const std::function<void(const LiveSources&)>& look);
  [[nodiscard]] AlarmReport alarm_report() const {
    return playback != nullptr ? recorded_alarms.at(to_wall_clock_ns(clock.now())) : alarms->report();
  }
  // None: real robots.
  [[nodiscard]] std::optional<PlaybackState> playback_state() const {
    return playback != nullptr ? std::optional(playback->control().state()) : std::nullopt;
  }
};

}  // namespace cellmirror::app
