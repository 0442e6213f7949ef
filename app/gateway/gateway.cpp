#include "app/gateway/gateway.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include "app/gateway/gateway_alarms.hpp"
#include "app/gateway/gateway_mqtt.hpp"
#include "app/gateway/gateway_parts.hpp"
#include "app/gateway/loaded_cell.hpp"
#include "app/gateway/picture_outputs.hpp"
#include "app/gateway/recorded_events.hpp"
#include "app/io/flight_file.hpp"
#include "app/io/outputs.hpp"
#include "app/io/record_file.hpp"
#include "app/io/robot_streams.hpp"
#include "app/io/summary_outputs.hpp"
#include "app/owner/command_records.hpp"
#include "app/owner/played_commands.hpp"
#include "app/owner/tissue/tissue_parts.hpp"
#include "app/pictures/tissue_at_rest.hpp"
#include "config/volume/voxel_memory.hpp"
#include "drivers/dds/network.hpp"
#include "drivers/dds/presence.hpp"
#include "ipc/web/access.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/wall_clock.hpp"

namespace cellmirror::app {

namespace {

constexpr std::string_view kFaultRecord = "fault-";
constexpr std::size_t kFaultRecordsKept = 20;  // of all runs
constexpr std::int32_t kIdleWakeLimitUs = 10;  // keeps idle processors out of states that cost the loop its phase

bool script_is_there(const KismetHome& home, const std::string& script) {
  std::error_code error;
  return script.empty() || std::filesystem::exists(script, error) || home.file("scripts", script, ".spt") ||
         home.file("", script, ".spt");
}

}  // namespace

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

// What a recording that is played does not show is as the cell's files have it.
void Gateway::Parts::rest_tissue(const TissueSetup& setup) {
  auto rest = tissue_at_rest(setup);
  if (!rest) return log_warning("replay.tissue", "deformable objects are not shown: {}", rest.error().text());
  playback->run().tissue().set_rest(*std::move(rest));
}

Result<void> Gateway::Parts::make_owner(LoadedCell loaded, const GatewayOptions& options) {
  std::map<std::string, StreamConfig, std::less<>> streams;
  for (RobotStream& stream : loaded.streams) streams.emplace(stream.robot, std::move(stream.config));
  TissueParts of_tissue = tissue_parts(loaded.tissue, loaded.home, tissue.get());
  if (playback != nullptr) {
    streams.clear();
    loaded.haptics.clear();
    loaded.io_nodes.clear();
    loaded.controllers.clear();
    loaded.foot_switches = {};
  }
  const auto save = [this](std::string_view name) -> Result<void> {
    auto written = write_flight_record(std::string(name), "request");
    if (!written) return std::unexpected(written.error());
    return {};
  };
  // By the owner's thread, which sends to the loop.
  const auto traced = [this](script::CommandTrace&& trace) {
    CommandRecord record = command_record_of(std::move(trace));
    record.loop_command = playback == nullptr ? engine->newest_sent() : 0;
    log_command(std::move(record));
  };
  // Below the loop, so that a flood of frames cannot hold it up.
  const int below_loop = std::max(1, loop_settings.priority - 10);
  const int stream_priority = loop_settings.real_time == RealTimePolicy::off ? 0 : below_loop;
  owner = std::make_unique<CellOwner>(
      CellOwner::Parts{.cell = std::move(loaded.cell),
                       .home = loaded.home,
                       .streams = std::move(streams),
                       .haptics = std::move(loaded.haptics),
                       .io_nodes = std::move(loaded.io_nodes),
                       .controllers = std::move(loaded.controllers),
                       .views = std::move(loaded.views),
                       .layout = std::move(loaded.layout),
                       .collision = std::move(loaded.collision),
                       .tissue = std::move(of_tissue),
                       .foot_switches = loaded.foot_switches,
                       .switch_changed = [this](const FootSwitchChange& change) { recordings.switch_changed(change); },
                       .engine = *engine,
                       .board = board,
                       .clock = clock,
                       .stream_priority = stream_priority,
                       .instance = instance->info().name,
                       .tcp_force_key = queues.tcp_force_key,
                       .memory_mode = queues.mode,
                       .guard = options.guard,
                       .can_tap = &recordings.can_tap(),
                       .payload_tap = &recordings.payload_tap(),
                       .save_flight_record = save,
                       .record = [this](RecordAction action) { return recordings.switch_ring(action); },
                       .acknowledge_alarms = [this](std::string_view name, std::uint64_t alarm) -> Result<std::string> {
                         return alarms->acknowledged(name, alarm);
                       },
                       .picture_updates = [this] { return picture_counter.count(); },
                       .bell = options.bell,
                       .let_tick_pass = playback != nullptr ? std::function<void()>([this] { let_own_tick_pass(); })
                                                            : std::function<void()>(),
                       .traced = traced,
                       .withheld = playback != nullptr ? withheld_in_playback : nullptr});
  std::string script = options.startup_script.value_or(loaded.startup_script);
  if (playback != nullptr && !script_is_there(loaded.home, script)) {
    log_warning("replay.script", "the startup script {} is not there: views, and what is sent, are as without it",
                script);
    script.clear();
  }
  // A file that the operator names may lie anywhere; a bare name is also looked for in the home, as in EXEC_SCRIPT.
  std::error_code error;
  const bool is_path = options.startup_script.has_value() && std::filesystem::exists(script, error);
  return owner->prepare(script, is_path);
}

// A tick of the owner's own engine, so that the owner sees its commands done. What it publishes has no reader.
void Gateway::Parts::let_own_tick_pass() {
  own_tick.period = Nanoseconds(std::llround(1e9 / loop_settings.rate_hz));
  own_tick.now = machine_clock.now();
  own_tick.scheduled = own_tick.now;
  engine->run(own_tick);
  ++own_tick.cycle;
}

void Gateway::Parts::subscribe(std::size_t robots) {
  if (playback == nullptr) {
    readers.emplace(*engine);
  } else {
    readers.emplace(playback->make_publication(engine::capacity_for(robots).robots, board));
  }
}

void Gateway::Parts::open_alarms() {
  alarms = playback == nullptr ? open_alarm_log(*home, instance->info().name, clock)
                               : std::make_unique<AlarmLog>(AlarmLog::Options(), clock);
  if (playback == nullptr) return;
  read_alarms(playback->run(), recorded_alarms);
  playback->control().set_marks(read_marks(playback->run(), recorded_alarms));
}

Result<void> Gateway::Parts::start_loop() {
  CyclicThreadOptions options;
  options.name = "tick";
  options.period = Nanoseconds(std::llround(1e9 / loop_settings.rate_hz));
  options.policy = loop_settings.real_time;
  options.priority = loop_settings.priority;
  loop = std::make_unique<CyclicThread>(*engine, options);
  if (playback != nullptr) return playback->start();
  if (auto started_loop = loop->start(); !started_loop) return started_loop;
  ticking.store(true, std::memory_order_release);
  const SchedulingOutcome& outcome = loop->scheduling();
  if (!outcome.ok) log_warning("scheduling", "the loop is not real time: {}; {}", outcome.why_not, outcome.remedy);
  return {};
}

void Gateway::Parts::start_sensing(const Eigen::Vector3d& gravity_W) {
  const Nanoseconds period = loop->options().period;
  collisions = std::make_unique<CollisionWorker>(readers->collisions, board, clock, period, solids);
  ranging = std::make_unique<RangingWorker>(readers->ranging, board, clock, period, solids, std::move(barriers));
  io = std::make_unique<IoWorker>(readers->io, board, ranging->board(), clock, period);
  contacts = std::make_unique<ContactWorker>(*engine, readers->contacts, board, clock, period, solids);
  const Board<InstrumentLoads>* const loads = tissue ? &tissue->loads() : nullptr;
  forces = std::make_unique<ForceWorker>(readers->forces, board, clock, period, gravity_W, loads);
  tcp_force = std::make_unique<TcpForceWorker>(readers->tcp_force, board, clock, period, loads);
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
  if (playback != nullptr) return {};
  return messages->start(take, refused);
}

// A recording that is played takes no commands.
void Gateway::Parts::start_mqtt(const MqttConfig& settings, bool publish) {
  if (playback != nullptr && !publish) return;
  MqttConfig wanted = settings;
  wanted.commands = wanted.commands && playback == nullptr;
  if (wanted.sparkplug) {
    auto file = home->file_to_write("records", fmt::format("sparkplug-{}.session", instance->info().name));
    if (file) wanted.sparkplug->session_file = *std::move(file);
  }
  mqtt = open_mqtt(wanted, {cell_name, instance->info().name, machine_clock, *owner,
                            [this](const script::CommandSource& source, std::string_view command,
                                   const std::string& why) { note_refused(source, command, why); }});
}

Result<void> Gateway::Parts::start_outputs(const DdsOutputConfig& dds, bool publish) {
  Result<std::vector<PublishedOutput>> outputs;
  if (playback == nullptr || publish) outputs = make_outputs(queues, dds, instance->info().name);
  if (!outputs) return std::unexpected(outputs.error());
  if (mqtt) add_output(*outputs, mqtt->states_output(), mqtt->states_rate_hz());
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
    return SceneSource::Boards{ticks,           board,           collisions->board(), ranging->board(),
                               forces->board(), traces->board(), machine_clock,       tissue_sources().view,
                               &clock};
  };
  renderer = std::make_unique<RenderService>(RenderService::Options{settings, headless, std::move(*outputs), {}},
                                             boards(readers->pictures), picture_counter);
  scene = std::make_unique<SceneService>(settings.rate_hz, boards(readers->scene));
  return {};
}

void Gateway::Parts::start_recorder(const RecordSettings& settings) {
  if (playback != nullptr)
    return recordings.watch({readers->recorder,
                             board,
                             collisions->board(),
                             ranging->board(),
                             forces->board(),
                             clock,
                             loop->options().period,
                             [this] { return status(); },
                             nullptr,
                             nullptr,
                             nullptr,
                             {},
                             {},
                             tissue_sources()});
  recordings.begin_ring(settings, home->file_to_write("records", "blackbox.mcap"));
  recordings.watch({readers->recorder, board, collisions->board(), ranging->board(), forces->board(), clock,
                    loop->options().period, [this] { return status(); }, nullptr, nullptr, &engine->inputs(),
                    [this](const PictureRequest& request) { return renderer->open_pictures(request); },
                    alarm_lines(*alarms), tissue_sources()});
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

Result<void> Gateway::Parts::start_summaries(const DdsOutputConfig& dds) {
  auto outputs = make_summary_outputs(dds);
  if (!outputs) return std::unexpected(outputs.error());
  if (mqtt) outputs->push_back(mqtt->summary_output());
  run = fmt::format("{:x}-{:x}", machine_wall_clock_ns(started), getpid());
  summaries = std::make_unique<SummaryPublisher>(std::move(*outputs), [this] { return summary(); }, machine_clock);
  return {};
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

// Does not serve yet: status needs its report before that.
void Gateway::Parts::make_page(const GatewayOptions& options, const WebSettings& settings) {
  WebBackend::Parts parts;
  parts.clock = &machine_clock;
  parts.cell_clock = &clock;
  parts.playback = playback != nullptr ? &playback->control() : nullptr;
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
  parts.alarms = [this] { return alarm_report(); };
  parts.refused = [this](std::string_view command, const script::CommandSource& source, const std::string& why) {
    note_refused(source, command, why);
  };
  parts.at = [this](const std::function<void(const LiveSources&)>& look) { look_at(look); };
  page = std::make_unique<MonitorPage>(
      MonitorPage::Options{options.web, settings, options.port, cell_name, options.instance, instance->folder()},
      std::move(parts));
}

Gateway::Gateway(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Gateway::~Gateway() = default;

Result<std::unique_ptr<Gateway>> Gateway::start(const GatewayOptions& options) {
  auto loaded = load_cell_of(options);
  if (!loaded) return std::unexpected(loaded.error());
  auto parts = std::make_unique<Parts>(options.playback);
  parts->guard = options.guard;
  parts->cell_name = loaded->name;
  parts->home = loaded->home;
  const std::vector<std::filesystem::path> files = files_of(*loaded);
  parts->loop_settings = loaded->loop;
  parts->queues = default_queues(options.instance);
  loaded->queues.apply_to(parts->queues);
  parts->engine =
      std::make_unique<engine::Engine>(parts->watchdog, engine::capacity_for(loaded->cell.robot_ids().size()));
  parts->subscribe(loaded->cell.robot_ids().size());
  DdsOutputConfig dds = loaded->dds;
  dds.enabled = dds.enabled && (options.playback == nullptr || options.publish);
  const PictureSettings pictures = loaded->pictures;
  const WebSettings web = loaded->web;
  const MqttConfig mqtt_settings = loaded->mqtt;
  const RecordSettings record = loaded->record;
  const Eigen::Vector3d gravity_W = loaded->gravity_m_s2;
  parts->barriers = std::move(loaded->barriers);
  const bool live = options.playback == nullptr;
  Result<void> step = check_instance_name(options.instance);
  if (step && live) step = parts->prepare_machine();
  if (step) step = parts->take_instance(options);
  if (step && live) parts->open_command_log();
  if (step) parts->open_alarms();
  if (step) dds::set_ros_presence(loaded->ros);
  if (step) dds::set_network(loaded->dds_network);
  if (step && live) step = parts->make_tissue(loaded->tissue);
  if (step && !live) parts->rest_tissue(loaded->tissue);
  if (step) step = parts->make_owner(std::move(*loaded), options);
  if (step) step = parts->start_messages();
  if (step) step = parts->start_loop();
  if (step) parts->start_sensing(gravity_W);
  if (step) parts->start_mqtt(mqtt_settings, options.publish);
  if (step) step = parts->start_outputs(dds, options.publish);
  if (step) step = parts->start_renderer(pictures, options.headless, dds);
  if (!step) return std::unexpected(step.error());
  if (live) parts->start_fault_monitor();
  parts->make_page(options, web);
  parts->recordings.describe({options.instance, parts->cell_name, parts->loop_settings.rate_hz,
                              cell_files(parts->home->root(), files), files.front().string()});
  parts->start_recorder(record);
  if (step = parts->start_control(); !step) return std::unexpected(step.error());
  if (live)
    watch_for_alarms(
        *parts->alarms,
        {parts->collisions->board(), *parts->faults, [all = parts.get()](const auto& look) { all->look_at(look); }},
        report_alarms(parts->mqtt.get()));
  parts->page->open();
  if (step = parts->start_summaries(dds); !step) return std::unexpected(step.error());
  parts->owner->start();  // last: the startup script finds everything running
  return std::unique_ptr<Gateway>(new Gateway(std::move(parts)));
}

std::uint64_t Gateway::ticks() const { return parts_->loop->cycles(); }

std::string Gateway::greeting() const {
  const Parts& parts = *parts_;
  const PageReport report = parts.page->report();
  std::string page = report.address.empty() ? std::string() : fmt::format("; monitor page {}", report.address);
  if (!report.address.empty() && !web::is_loopback(report.listens_on))
    page += fmt::format(" (open to other machines: it listens on {})", report.listens_on);
  if (parts.playback != nullptr)
    return fmt::format("cell {} with {} is played from {}; instance {}{}; Ctrl-C ends it", parts.cell_name,
                       number_of(parts.board.latest()->robots.size(), "robot"), parts.playback->control().state().file,
                       parts.instance->info().name, page);
  return fmt::format("cell {} with {} runs at {:.0f} Hz ({}); instance {}, SCRIPT messages on key {}{}; Ctrl-C ends it",
                     parts.cell_name, number_of(parts.board.latest()->robots.size(), "robot"),
                     parts.loop_settings.rate_hz, parts.loop->scheduling().scheduler, parts.instance->info().name,
                     parts.queues.script_key, page);
}

}  // namespace cellmirror::app
