#include "app/gateway/gateway.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "app/alarms/alarm_log.hpp"
#include "app/gateway/gateway_alarms.hpp"
#include "app/gateway/loaded_cell.hpp"
#include "app/gateway/monitor_page.hpp"
#include "app/gateway/picture_outputs.hpp"
#include "app/gateway/recordings.hpp"
#include "app/gateway/tick_readers.hpp"
#include "app/io/command_log.hpp"
#include "app/io/flight_file.hpp"
#include "app/io/outputs.hpp"
#include "app/io/publisher.hpp"
#include "app/io/record_file.hpp"
#include "app/io/robot_streams.hpp"
#include "app/owner/cell_owner.hpp"
#include "app/owner/command_records.hpp"
#include "app/owner/tissue/tissue_parts.hpp"
#include "app/pictures/snapshot_request.hpp"
#include "app/render/render_service.hpp"
#include "app/render/scene_service.hpp"
#include "app/report/live_document.hpp"
#include "app/report/loop_health.hpp"
#include "app/report/status_document.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/tissue_sources.hpp"
#include "app/workers/collision_worker.hpp"
#include "app/workers/contact_worker.hpp"
#include "app/workers/fault_monitor.hpp"
#include "app/workers/force_worker.hpp"
#include "app/workers/ranging_worker.hpp"
#include "app/workers/tcp_force_worker.hpp"
#include "app/workers/tissue_worker.hpp"
#include "app/workers/trace_worker.hpp"
#include "config/cell_file.hpp"
#include "config/volume/voxel_memory.hpp"
#include "ipc/control/control_request.hpp"
#include "ipc/control/control_server.hpp"
#include "ipc/control/instance.hpp"
#include "ipc/control/queue_answer.hpp"
#include "ipc/sysv/force_guard.hpp"
#include "ipc/sysv/script_message_receiver.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/memory_lock.hpp"
#include "rt_core/rt/watchdog.hpp"

namespace cellmirror::app {

namespace {

constexpr std::chrono::milliseconds kLoopStandsStillAfter{100};
constexpr std::string_view kFaultRecord = "fault-";
constexpr std::size_t kFaultRecordsKept = 20;  // of all runs
constexpr std::int32_t kIdleWakeLimitUs = 10;  // keeps idle processors out of states that cost the loop its phase

}  // namespace

// In the order in which they are made; they end in the reverse order.
struct Gateway::Parts {
  SystemClock clock;
  Timestamp started = clock.now();
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
  std::unique_ptr<engine::Engine> engine;
  std::optional<TickReaders> readers;
  Board<CellState> board;
  PictureCounter picture_counter;
  std::unique_ptr<CommandLog> commands;  // null: the cell folder has no place for it
  std::string commands_problem;          // then
  std::unique_ptr<AlarmLog> alarms;      // once the instance is known
  Recordings recordings{clock};
  std::unique_ptr<ScriptMessageReceiver> messages;
  std::unique_ptr<TissueWorker> tissue;  // null: the cell has no deformable object
  std::unique_ptr<CellOwner> owner;
  std::unique_ptr<CyclicThread> loop;
  std::atomic<bool> ticking{false};  // the loop runs, for threads that began before it
  std::unique_ptr<CollisionWorker> collisions;
  std::unique_ptr<RangingWorker> ranging;
  std::unique_ptr<ContactWorker> contacts;
  std::unique_ptr<ForceWorker> forces;
  std::unique_ptr<TcpForceWorker> tcp_force;
  std::unique_ptr<TraceWorker> traces;
  std::unique_ptr<Publisher> publisher;
  std::unique_ptr<RenderService> renderer;
  std::unique_ptr<SceneService> scene;
  std::unique_ptr<FaultMonitor> faults;
  std::mutex answering;  // of the engine's view for status and of what follows: several threads answer questions
  RobotStateBuilder status_builder;
  std::unique_ptr<MonitorPage> page;
  std::unique_ptr<ControlServer> control;

  ~Parts() {
    control.reset();
    // It stays until the end: its threads ask it for its report until it is closed.
    if (page) page->close();
    if (alarms) alarms->stop();
    recordings.stop();
    faults.reset();
    scene.reset();
    renderer.reset();
    publisher.reset();
    forces.reset();
    tcp_force.reset();
    contacts.reset();
    if (tissue) tissue->stop();
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
  void open_command_log();
  void log_command(CommandRecord record);
  void note_refused(const script::CommandSource& source, std::string_view command, const std::string& why);
  Result<void> make_tissue(const TissueSetup& setup);
  // Empty in a cell without deformable objects.
  [[nodiscard]] TissueSources tissue_sources() const {
    if (!tissue) return {};
    return {&tissue->reports(), [worker = tissue.get()] { return worker->view(); }};
  }
  Result<void> make_owner(LoadedCell loaded, const GatewayOptions& options);
  Result<void> start_loop();
  void start_sensing(const Eigen::Vector3d& gravity_W);
  Result<void> start_messages();
  Result<void> start_outputs(const DdsOutputConfig& dds);
  Result<void> start_renderer(const PictureSettings& settings, bool headless, const DdsOutputConfig& dds);
  void start_recorder(const RecordSettings& settings);
  void start_fault_monitor();
  Result<void> start_control();
  void make_page(const GatewayOptions& options, const WebSettings& settings);

  Result<std::string> write_flight_record(const std::string& file_name, const std::string& reason);
  void answer(std::string_view request, ControlReply reply);
  void answer_snapshot(const ControlRequest& request, ControlReply reply);
  void answer_queues(ControlReply reply);
  std::string status();
  web::Health health();
  [[nodiscard]] Problems problems() const;
  [[nodiscard]] CommandLogReport command_log() const { return commands ? commands->report() : CommandLogReport{}; }
  [[nodiscard]] std::vector<engine::QueueStatus> thread_queues(const CellState& cell_state) const;
  void look_at(const std::function<void(const LiveSources&)>& look);
};

Result<void> Gateway::Parts::prepare_machine() {
  memory = lock_memory(loop_settings.real_time);
  if (auto enforced = enforce(loop_settings.real_time, memory); !enforced) return enforced;
  if (memory.level != MemoryLockLevel::none) exempt_voxels_from_locking();
  if (!memory.ok) log_warning("memory", "memory is not locked: {}; {}", memory.why_not, memory.remedy);
  if (loop_settings.real_time != RealTimePolicy::off)
    processors_awake = std::make_unique<CpuLatencyRequest>(kIdleWakeLimitUs);
  return {};
}

Result<void> Gateway::Parts::take_instance(const GatewayOptions& options) {
  auto claimed = Instance::claim({options.instance, getpid(), options.cell_file.string(), queues});
  if (!claimed) return std::unexpected(claimed.error());
  instance.emplace(std::move(*claimed));
  return {};
}

// The gateway runs without it too: its folder may be read-only.
void Gateway::Parts::open_command_log() {
  auto file = home->file_to_write("records", fmt::format("commands-{}.jsonl", instance->info().name));
  if (file) {
    commands = std::make_unique<CommandLog>(CommandLog::Options{.file = std::move(*file)});
    return;
  }
  commands_problem = fmt::format("no log of commands is kept: {}", file.error().text());
  log_error("command-log", "{}", commands_problem);
}

void Gateway::Parts::log_command(CommandRecord record) {
  if (ticking.load(std::memory_order_acquire)) record.tick = std::max<std::uint64_t>(loop->cycles(), 1) - 1;
  recordings.command(record);
  if (commands) commands->add(std::move(record));
}

void Gateway::Parts::note_refused(const script::CommandSource& source, std::string_view command,
                                  const std::string& why) {
  log_command(refused_command(source, std::string(command), why, clock.now()));
}

Result<void> Gateway::Parts::make_tissue(const TissueSetup& setup) {
  auto made = TissueWorker::make(setup.objects, setup.connections, solids, *engine, readers->tissue, board, clock);
  if (!made) return std::unexpected(made.error());
  tissue = *std::move(made);
  return {};
}

Result<void> Gateway::Parts::make_owner(LoadedCell loaded, const GatewayOptions& options) {
  std::map<std::string, StreamConfig, std::less<>> streams;
  for (RobotStream& stream : loaded.streams) streams.emplace(stream.robot, std::move(stream.config));
  TissueParts of_tissue = tissue_parts(loaded.tissue, loaded.home, tissue.get());
  const auto save = [this](std::string_view name) -> Result<void> {
    auto written = write_flight_record(std::string(name), "request");
    if (!written) return std::unexpected(written.error());
    return {};
  };
  const auto traced = [this](script::CommandTrace&& trace) { log_command(command_record_of(std::move(trace))); };
  // Below the loop, so that a flood of frames cannot hold it up.
  const int below_loop = std::max(1, loop_settings.priority - 10);
  const int stream_priority = loop_settings.real_time == RealTimePolicy::off ? 0 : below_loop;
  owner = std::make_unique<CellOwner>(
      CellOwner::Parts{.cell = std::move(loaded.cell),
                       .home = loaded.home,
                       .streams = std::move(streams),
                       .haptics = std::move(loaded.haptics),
                       .views = std::move(loaded.views),
                       .layout = std::move(loaded.layout),
                       .collision = std::move(loaded.collision),
                       .tissue = std::move(of_tissue),
                       .foot_switches = loaded.foot_switches,
                       .engine = *engine,
                       .board = board,
                       .clock = clock,
                       .stream_priority = stream_priority,
                       .instance = instance->info().name,
                       .tcp_force_key = queues.tcp_force_key,
                       .memory_mode = queues.mode,
                       .guard = options.guard,
                       .can_tap = &recordings.can_tap(),
                       .save_flight_record = save,
                       .record = [this](RecordAction action) { return recordings.switch_ring(action); },
                       .acknowledge_alarms = [this](std::string_view name, std::uint64_t alarm) -> Result<std::string> {
                         return alarms->acknowledged(name, alarm);
                       },
                       .picture_updates = [this] { return picture_counter.count(); },
                       .bell = options.bell,
                       .traced = traced});
  const std::string script = options.startup_script.value_or(loaded.startup_script);
  // A file that the operator names may lie anywhere; a bare name is also looked for in the home, as in EXEC_SCRIPT.
  std::error_code error;
  const bool is_path = options.startup_script.has_value() && std::filesystem::exists(script, error);
  return owner->prepare(script, is_path);
}

Result<void> Gateway::Parts::start_loop() {
  CyclicThreadOptions options;
  options.name = "tick";
  options.period = Nanoseconds(std::llround(1e9 / loop_settings.rate_hz));
  options.policy = loop_settings.real_time;
  options.priority = loop_settings.priority;
  loop = std::make_unique<CyclicThread>(*engine, options);
  if (auto started_loop = loop->start(); !started_loop) return started_loop;
  ticking.store(true, std::memory_order_release);
  const SchedulingOutcome& outcome = loop->scheduling();
  if (!outcome.ok) log_warning("scheduling", "the loop is not real time: {}; {}", outcome.why_not, outcome.remedy);
  return {};
}

void Gateway::Parts::start_sensing(const Eigen::Vector3d& gravity_W) {
  const Nanoseconds period = loop->options().period;
  collisions = std::make_unique<CollisionWorker>(readers->collisions, board, clock, period, solids);
  ranging = std::make_unique<RangingWorker>(readers->ranging, board, clock, period, solids);
  contacts = std::make_unique<ContactWorker>(*engine, readers->contacts, board, clock, period, solids);
  forces = std::make_unique<ForceWorker>(readers->forces, board, clock, period, gravity_W);
  tcp_force = std::make_unique<TcpForceWorker>(readers->tcp_force, board, clock, period);
  traces = std::make_unique<TraceWorker>(readers->traces, board, clock, period);
  if (tissue) tissue->start(loop_settings.real_time, loop_settings.priority - 20);  // below the loop and the streams
}

Result<void> Gateway::Parts::start_messages() {
  messages = std::make_unique<ScriptMessageReceiver>(queues, instance->info().name);
  const auto take = [this](ScriptMessage message) {
    script::CommandReply reply;
    if (message.tag != 0) {
      reply = [to = messages.get(), tag = message.tag](const Result<std::string>& result) {
        to->reply(tag, result ? ScriptReply{true, *result} : ScriptReply{false, result.error().text()});
      };
    }
    owner->submit({std::move(message.text), script::CommandSource::message(message.sender_pid, message.sender_user),
                   std::move(reply)});
  };
  const auto refused = [this](const ScriptMessage& message, const std::string& why) {
    note_refused(script::CommandSource::message(message.sender_pid, message.sender_user), "", why);
  };
  return messages->start(take, refused);
}

Result<void> Gateway::Parts::start_outputs(const DdsOutputConfig& dds) {
  auto outputs = make_outputs(queues, dds, instance->info().name);
  if (!outputs) return std::unexpected(outputs.error());
  publisher =
      std::make_unique<Publisher>(readers->publisher, board, collisions->board(), ranging->board(), forces->board(),
                                  clock, loop->options().period, std::move(*outputs), tissue_sources());
  return {};
}

// Draws nothing yet: the renderer is created with the first request.
Result<void> Gateway::Parts::start_renderer(const PictureSettings& settings, bool headless,
                                            const DdsOutputConfig& dds) {
  auto outputs = make_picture_outputs(dds);
  if (!outputs) return std::unexpected(outputs.error());
  const auto boards = [this](engine::TickReader& ticks) {
    return SceneSource::Boards{ticks,           board, collisions->board(),  ranging->board(), forces->board(),
                               traces->board(), clock, tissue_sources().view};
  };
  renderer = std::make_unique<RenderService>(RenderService::Options{settings, headless, std::move(*outputs), {}},
                                             boards(readers->pictures), picture_counter);
  scene = std::make_unique<SceneService>(settings.rate_hz, boards(readers->scene));
  return {};
}

void Gateway::Parts::start_recorder(const RecordSettings& settings) {
  recordings.begin_ring(settings, home->file_to_write("records", "blackbox.mcap"));
  recordings.watch({readers->recorder, board, collisions->board(), ranging->board(), forces->board(), clock,
                    loop->options().period, [this] { return status(); }, nullptr, &engine->inputs()});
}

void Gateway::Parts::start_fault_monitor() {
  faults = std::make_unique<FaultMonitor>(*loop, watchdog, clock, [this](const std::string& reason) {
    const auto wall_seconds = to_wall_clock_ns(clock.now()) / 1'000'000'000;
    auto written = write_flight_record(fmt::format("{}{}.jsonl.gz", kFaultRecord, wall_seconds), reason);
    recordings.fault();
    if (written) remove_old_records(std::filesystem::path(*written).parent_path(), kFaultRecord, kFaultRecordsKept);
    return written;
  });
}

Result<void> Gateway::Parts::start_control() {
  auto server = ControlServer::start_later(
      instance->control_socket(),
      [this](std::string_view request, ControlReply reply) { answer(request, std::move(reply)); });
  if (!server) return std::unexpected(server.error());
  control = std::move(*server);
  return {};
}

Result<std::string> Gateway::Parts::write_flight_record(const std::string& file_name, const std::string& reason) {
  auto path = home->file_to_write("records", file_name);
  if (!path) return std::unexpected(path.error());
  FlightFileHeader header{reason, cell_name, instance->info().name, loop_settings.rate_hz, {}};
  for (const RobotSnapshot& robot : board.latest()->robots) {
    if (header.robots.size() <= robot.slot) header.robots.resize(robot.slot + 1);
    header.robots[robot.slot] = robot.id;
  }
  auto written = write_flight_file(*path, header, engine->flight_ticks(), engine->flight_robots());
  if (!written) return std::unexpected(written.error());
  return path->string();
}

void Gateway::Parts::answer(std::string_view line, ControlReply reply) {
  const Result<ControlRequest> request = parse_control_request(line);
  if (!request) return reply(control_error(request.error()));
  if (request->request == "status") return reply(status());
  if (request->request == "snapshot") return answer_snapshot(*request, std::move(reply));
  if (request->request == "queues") return answer_queues(std::move(reply));
  if (request->request == "record") return reply(recordings.answer(*request));
  reply(control_error(
      {fmt::format("the request {} is not known", request->request), "known: status, snapshot, queues, record"}));
}

void Gateway::Parts::answer_queues(ControlReply reply) {
  const ScriptMessageStatus status = messages->status();
  reply(queue_answer_text({status.input_queue, status.reply_queue, status.input_problem, status.reply_problem}));
}

void Gateway::Parts::answer_snapshot(const ControlRequest& request, ControlReply reply) {
  const auto wanted = snapshot_request(request);
  if (!wanted) return reply(control_error(wanted.error()));
  const PictureSettings& settings = renderer->settings();
  // A function that is copied holds what can be moved only.
  const auto later = std::make_shared<ControlReply>(std::move(reply));
  renderer->ask_picture(picture_request_of(*wanted, settings.width, settings.height), wanted->format,
                        [this, later](const Result<EncodedImage>& picture) {
                          if (!picture) return (*later)(control_error(picture.error()));
                          (*later)(answer_text(*picture, seconds(clock.now() - picture->posture_time)));
                        });
}

// Does not serve yet: status needs its report before that.
void Gateway::Parts::make_page(const GatewayOptions& options, const WebSettings& settings) {
  WebBackend::Parts parts;
  parts.clock = &clock;
  parts.home = &*home;
  parts.topics = &recordings.live();
  parts.loop_rate_hz = loop_settings.rate_hz;
  parts.board = &board;
  parts.owner = owner.get();
  parts.renderer = renderer.get();
  parts.scene = scene.get();
  parts.status = [this] { return status(); };
  parts.health = [this] { return health(); };
  parts.command_log = [this] { return command_log(); };
  parts.alarms = [this] { return alarms->report(); };
  parts.refused = [this](std::string_view command, const script::CommandSource& source, const std::string& why) {
    note_refused(source, command, why);
  };
  parts.at = [this](const std::function<void(const LiveSources&)>& look) { look_at(look); };
  page = std::make_unique<MonitorPage>(
      MonitorPage::Options{options.web, settings, options.port, cell_name, options.instance, instance->folder()},
      std::move(parts));
}

std::vector<engine::QueueStatus> Gateway::Parts::thread_queues(const CellState& cell_state) const {
  std::vector<engine::QueueStatus> queues_now{engine->command_queue(), owner->command_queue()};
  for (const RobotSnapshot& robot : cell_state.robots) {
    if (!robot.stream) continue;
    queues_now.push_back(engine->sample_queue(robot.slot));
    queues_now.back().name = "samples " + robot.id;
  }
  return queues_now;
}

void Gateway::Parts::look_at(const std::function<void(const LiveSources&)>& look) {
  const std::shared_ptr<const CellState> cell_state = board.latest();
  const std::vector<engine::QueueStatus> queues_now = thread_queues(*cell_state);
  const Problems problems_now = problems();
  const std::uint64_t commands_logged = commands ? commands->count() : 0;
  const std::scoped_lock lock(answering);
  const engine::TickState& tick = readers->status.newest();
  const std::span<const RobotState> robots = status_builder.build(*cell_state, tick);
  const Timestamp now = clock.now();
  look({instance->info().name,
        cell_name,
        seconds(now - started),
        loop_settings.rate_hz,
        now,
        *loop,
        *cell_state,
        tick,
        robots,
        status_builder.poses(),
        picture_counter.count(),
        collisions->board().latest(),
        ranging->board().latest(),
        forces->board().latest(),
        queues_now,
        problems_now,
        commands_logged,
        tissue_sources().newest_report(),
        renderer->counters(),
        alarms->counts()});
}

Problems Gateway::Parts::problems() const {
  Problems out;
  const auto add = [&](const char* kind, std::string text) {
    if (!text.empty()) out.push_back({kind, std::move(text)});
  };
  const ScriptMessageStatus status = messages->status();
  add("script_queue", status.input_problem);
  add("reply_queue", status.reply_problem);
  add("command_log", commands ? commands->report().problem : commands_problem);
  add("alarm_log", alarms->problem());
  add("recording", recordings.hub().problem());
  for (const PublishedOutput& output : publisher->outputs()) add("sensor_queue", output.output->problem());
  if (guard == nullptr || !guard->running()) {
    add("force_guard", fmt::format("the process that removes the forces of a killed gateway from shared memory {}; "
                                   "restart the gateway",
                                   guard == nullptr ? "could not be started (see the log)" : "was ended"));
  }
  return out;
}

web::Health Gateway::Parts::health() {
  const std::scoped_lock lock(answering);
  const Timestamp newest = readers->status.newest().time;
  return loop_health(clock.now() - newest, kLoopStandsStillAfter, faults->status());
}

std::string Gateway::Parts::status() {
  const std::shared_ptr<const CellState> cell_state = board.latest();
  const std::scoped_lock lock(answering);
  const engine::TickState& tick = readers->status.newest();
  std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::uint64_t>>>> outputs;
  for (const PublishedOutput& output : publisher->outputs())
    outputs.emplace_back(output.output->name(), output.output->counters());
  for (const ImageOutput* output : renderer->outputs()) outputs.emplace_back(output->name(), output->counters());
  const FaultStatus fault_status = faults->status();
  const ScriptMessageStatus message_status = messages->status();
  const CollisionReport collision_report = collisions->report();
  const RangeReport range_report = ranging->report();
  const ContactReport contact_report = contacts->report();
  const ForceReport force_report = forces->report();
  const RenderReport render_report = renderer->report();
  PageReport page_report = page->report();
  page_report.live = recordings.live().feed().status();
  const Timestamp now = clock.now();
  return status_document({instance->info().name,
                          cell_name,
                          home->root().string(),
                          seconds(now - started),
                          loop_settings.rate_hz,
                          now,
                          *loop,
                          memory,
                          fault_status,
                          *cell_state,
                          tick,
                          status_builder.build(*cell_state, tick),
                          message_status,
                          collision_report,
                          range_report,
                          contact_report,
                          force_report,
                          render_report,
                          page_report,
                          thread_queues(*cell_state),
                          std::move(outputs),
                          problems(),
                          {guard != nullptr && guard->running(), guard != nullptr ? guard->process() : 0},
                          command_log(),
                          tissue_sources().newest_report(),
                          recordings.hub().reports(),
                          alarms->report()});
}

Gateway::Gateway(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Gateway::~Gateway() = default;

Result<std::unique_ptr<Gateway>> Gateway::start(const GatewayOptions& options) {
  auto loaded = load_cell_of(options);
  if (!loaded) return std::unexpected(loaded.error());
  auto parts = std::make_unique<Parts>();
  parts->guard = options.guard;
  parts->cell_name = loaded->name;
  parts->home = loaded->home;
  const std::vector<std::filesystem::path> files = files_of(*loaded);
  parts->loop_settings = loaded->loop;
  parts->queues = default_queues(options.instance);
  loaded->queues.apply_to(parts->queues);
  parts->engine =
      std::make_unique<engine::Engine>(parts->watchdog, engine::capacity_for(loaded->cell.robot_ids().size()));
  parts->readers.emplace(*parts->engine);
  const DdsOutputConfig dds = loaded->dds;
  const PictureSettings pictures = loaded->pictures;
  const WebSettings web = loaded->web;
  const RecordSettings record = loaded->record;
  const Eigen::Vector3d gravity_W = loaded->gravity_m_s2;
  Result<void> step = check_instance_name(options.instance);
  if (step) step = parts->prepare_machine();
  if (step) step = parts->take_instance(options);
  if (step) parts->open_command_log();
  if (step) parts->alarms = open_alarm_log(*parts->home, parts->instance->info().name, parts->clock);
  if (step) step = parts->make_tissue(loaded->tissue);
  if (step) step = parts->make_owner(std::move(*loaded), options);
  if (step) step = parts->start_messages();
  if (step) step = parts->start_loop();
  if (step) parts->start_sensing(gravity_W);
  if (step) step = parts->start_outputs(dds);
  if (step) step = parts->start_renderer(pictures, options.headless, dds);
  if (!step) return std::unexpected(step.error());
  parts->start_fault_monitor();
  parts->make_page(options, web);
  parts->recordings.describe({options.instance, parts->cell_name, parts->loop_settings.rate_hz,
                              cell_attachments(parts->home->root(), files),
                              std::filesystem::absolute(files.front()).lexically_normal().string()});
  parts->start_recorder(record);
  if (step = parts->start_control(); !step) return std::unexpected(step.error());
  watch_for_alarms(*parts->alarms, {parts->collisions->board(), *parts->faults,
                                    [all = parts.get()](const auto& look) { all->look_at(look); }});
  parts->page->open();
  // Last: the startup script finds everything running.
  parts->owner->start();
  return std::unique_ptr<Gateway>(new Gateway(std::move(parts)));
}

std::uint64_t Gateway::ticks() const { return parts_->loop->cycles(); }

std::string Gateway::greeting() const {
  const Parts& parts = *parts_;
  const std::string address = parts.page->report().address;
  const std::string page = address.empty() ? std::string() : fmt::format("; monitor page {}", address);
  return fmt::format("cell {} with {} runs at {:.0f} Hz ({}); instance {}, SCRIPT messages on key {}{}; Ctrl-C ends it",
                     parts.cell_name, number_of(parts.board.latest()->robots.size(), "robot"),
                     parts.loop_settings.rate_hz, parts.loop->scheduling().scheduler, parts.instance->info().name,
                     parts.queues.script_key, page);
}

}  // namespace cellmirror::app
