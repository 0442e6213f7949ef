#include "app/owner/cell_owner.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "app/io/controller_endpoints.hpp"
#include "config/volume_user_tables.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

// Commands of files before messages have their turn, and how long they may take: inverse kinematics takes a while.
constexpr std::size_t kScriptBudget = 256;
constexpr std::size_t kScriptSlice = 32;
constexpr Nanoseconds kScriptTime{5'000'000};
constexpr int kMessageBudget = 64;
constexpr Nanoseconds kPublishPeriod{20'000'000};     // at most so old while commands keep coming
constexpr std::chrono::milliseconds kIdleWait{50};    // expired messages are removed from the display
constexpr std::chrono::milliseconds kHapticWait{10};  // how soon a device that has vanished is noticed
constexpr std::chrono::milliseconds kMovingWait{1};   // how soon an arrival is noticed, and WAIT goes on

constexpr std::string_view kScripts = "scripts";
constexpr std::string_view kScriptExtension = ".spt";

// Of a name that is no path from where the program was started: a file of the home's scripts/, with or without that
// folder in front.
Result<std::filesystem::path> startup_file(const KismetHome& home, const std::string& script) {
  const std::filesystem::path name(script);
  if (name.is_absolute()) return fail(fmt::format("the SCRIPT file {} does not exist", printable(script)));
  auto found = home.file(kScripts, script, kScriptExtension);
  if (!found && *name.begin() == kScripts) found = home.file("", script, kScriptExtension);
  if (!found && found.error().remedy.empty())
    found.error().remedy = "name any path, or a file of the cell's scripts/ as EXEC_SCRIPT does";
  return found;
}

// More robots than the engine has slots for are refused where they would be loaded.
Cell with_capacity_of(const engine::Engine& engine, Cell cell) {
  cell.set_robot_capacity(engine.capacity().robots);
  return cell;
}

}  // namespace

CellOwner::CellOwner(Parts parts)
    : cell_(with_capacity_of(parts.engine, std::move(parts.cell))),
      home_(std::move(parts.home)),
      board_(parts.board),
      clock_(parts.clock),
      node_channels_(parts.streams, parts.io_nodes, clock_, parts.stream_priority, parts.can_tap),
      names_(cell_),
      volumes_(cell_, [this] { return load_volume_tables(home_); }),
      fleet_(std::make_unique<Fleet>(
          cell_, parts.engine, std::move(parts.streams), clock_, parts.stream_priority,
          Fleet::Events{.let_tick_pass = parts.let_tick_pass,
                        .move_given = std::move(parts.move_given),
                        .device_stream = [this](std::string_view robot) { return haptics_.stream(robot); },
                        .can_tap = parts.can_tap,
                        .node_channels = &node_channels_,
                        .payload_tap = parts.payload_tap})),
      display_(
          {cell_, names_, home_, clock_, [this] { return fleet_->positions(); }, std::move(parts.picture_updates),
           std::move(parts.bell), [this](std::size_t slot) { return is_online(slot); }, std::move(parts.message_shown)},
          parts.views, std::move(parts.layout)),
      motion_(
          cell_, names_, [this] { return display_.screen_axes(); }, *fleet_, clock_,
          [this]() -> const CoupledRobots& { return couplings_; }),
      couplings_(cell_, *fleet_, motion_),
      program_motion_(cell_, motion_, *fleet_, clock_),
      programs_({cell_, home_, *fleet_, motion_, display_, program_motion_, clock_,
                 [this]() -> script::ScriptRunner& { return *runner_; }, std::move(parts.program_event),
                 !parts.let_tick_pass}),
      controllers_({cell_, *fleet_, motion_, couplings_,
                    [this](std::string_view robot) { return programs_.moving_program(robot); }, clock_,
                    std::move(parts.controllers), [this] { wake_.wake(); }, &make_controller_endpoint}),
      guarded_motion_(motion_, programs_, controllers_),
      world_({cell_, *fleet_, motion_, programs_, volumes_, [this] { publish_state(); }}),
      robots_(cell_, *fleet_, motion_, couplings_, programs_, names_),
      sensing_(cell_, std::move(parts.collision)),
      haptics_({cell_, *fleet_, clock_, parts.instance, std::move(parts.haptics), parts.guard}),
      forces_({parts.tcp_force_key, parts.memory_mode, parts.instance, clock_,
               [this](std::string_view text) { static_cast<void>(display_.show_message(text)); }, parts.guard}),
      robot_forces_({cell_, clock_, parts.memory_mode, parts.instance, parts.guard}),
      interaction_(
          cell_, names_,
          {haptics_, forces_, robot_forces_, couplings_, [this]() -> FootSwitchService& { return *switches_; }},
          static_cast<bool>(parts.let_tick_pass)),
      tissue_(cell_, names_, std::move(parts.tissue)),
      diagnosis_(std::move(parts.save_flight_record), std::move(parts.record), std::move(parts.acknowledge_alarms)) {
  runner_ = std::make_unique<script::ScriptRunner>(
      CommandHost{names_, world_, robots_, guarded_motion_, programs_, display_, sensing_, interaction_, tissue_,
                  volumes_, diagnosis_},
      home_, clock_,
      script::ScriptRunner::Events{.refused = std::move(parts.refused),
                                   .all_stopped = [this] { switches_->forget_waiting(); },
                                   .withheld = std::move(parts.withheld),
                                   .traced = std::move(parts.traced)});
  switches_ = std::make_unique<FootSwitchService>(
      FootSwitchService::Options{parts.foot_switches, parts.instance, parts.stream_priority, [this] { wake_.wake(); },
                                 std::move(parts.switch_changed)},
      *runner_, home_, clock_);
  if (parts.let_tick_pass) return;
  io_ = std::make_unique<IoService>(
      IoService::Parts{cell_, *fleet_, guarded_motion_, motion_, *runner_, clock_, node_channels_},
      std::move(parts.io_nodes), [this] { wake_.wake(); });
}

CellOwner::~CellOwner() { stop(); }

Result<void> CellOwner::prepare(const std::string& script, bool is_path) {
  if (auto followed = fleet_->follow_cell(); !followed) return followed;
  if (auto made = haptics_.prepare(); !made) return made;
  if (haptics_.used()) {
    // Not what anybody has asked for in so many words: the gateway goes on without.
    if (const auto made = forces_.make_memory(); !made) log_warning("force.memory", "{}", made.error().text());
  }
  if (auto prepared = switches_->prepare(); !prepared) return prepared;
  if (io_) io_->prepare();
  if (auto opened = controllers_.prepare(); !opened) return opened;
  publish_state();
  if (script.empty()) return {};
  const auto path = is_path ? Result<std::filesystem::path>(script) : startup_file(home_, script);
  if (!path) return std::unexpected(path.error());
  auto started = runner_->start_path(*path);
  if (!started) return std::unexpected(started.error());
  return {};
}

void CellOwner::start() {
  thread_ = std::thread([this] { loop(stopping_.get_token()); });
}

void CellOwner::stop() {
  stopping_.request_stop();
  if (!thread_.joinable()) return;
  wake_.wake();
  thread_.join();
}

void CellOwner::submit(script::ScriptCommand command) {
  while (!queue_.push(command) && !stopping_.stop_requested()) room_.wait(std::chrono::milliseconds(10));
  wake_.wake();
}

bool CellOwner::offer(script::ScriptCommand& command) {
  const bool taken = queue_.push(command);
  wake_.wake();
  return taken;
}

bool CellOwner::execute_messages() {
  int executed = 0;
  for (; executed < kMessageBudget; ++executed) {
    auto command = queue_.pop();
    if (!command) break;
    runner_->execute(std::move(*command));
  }
  if (executed > 0) room_.wake();
  return executed > 0;
}

bool CellOwner::execute_files() {
  const Timestamp end = clock_.now() + kScriptTime;
  bool any = false;
  for (std::size_t budget = 0; budget < kScriptBudget; budget += kScriptSlice) {
    const bool begun = switches_->follow();
    if (runner_->step(kScriptSlice) == 0 && !begun) break;
    any = true;
    if (clock_.now() > end) break;
  }
  return any;
}

bool CellOwner::turn() {
  turns_.fetch_add(1, std::memory_order_acq_rel);
  motion_.follow();
  changed_ = controllers_.follow() || changed_;
  couplings_.follow();
  haptics_.follow();
  forces_.follow();
  robot_forces_.follow();
  // Not a reason to come back at once: a program that computes without end would keep this thread from ever waiting.
  changed_ = programs_.follow() || changed_;
  // Files first: what a foot switch begins does not wait behind a flood of messages.
  bool busy = execute_files();
  busy = (io_ && io_->follow()) || busy;
  busy = execute_messages() || busy;
  changed_ = changed_ || busy;
  const bool due = clock_.now() - last_publication_ > kPublishPeriod;
  if (changed_ && (due || !busy)) {
    publish_state();
    changed_ = false;
  }
  return busy;
}

bool CellOwner::quiet() const {
  return runner_->idle() && !motion_.moving() && !controllers_.moving() && !switches_->busy() &&
         !programs_.needs_turns();
}

void CellOwner::loop(const std::stop_token& stop) {
  set_thread_name("cell");
  changed_ = true;
  while (!stop.stop_requested()) {
    if (turn()) continue;
    wake_.wait(!quiet() ? kMovingWait : haptics_.any_online() ? kHapticWait : kIdleWait);
    changed_ = changed_ || clock_.now() - last_publication_ > kPublishPeriod;
  }
  programs_.shut_down();
  runner_->stop_all();
  haptics_.shut_down();
}

bool CellOwner::is_online(std::size_t slot) const {
  const RobotModel* robot = cell_.robot(slot);
  const FleetRobot* fleet = robot == nullptr ? nullptr : fleet_->find(robot->id());
  return fleet != nullptr && fleet->online;
}

void CellOwner::publish_state() {
  auto cell_state = std::make_shared<CellState>();
  cell_state->cell = cell_.compile();
  cell_state->levels = levels_.of(cell_, cell_state->cell);
  cell_state->collision = sensing_.collision();
  cell_state->range_send_mode = sensing_.send_mode();
  for (const CompiledRobot& compiled : cell_state->cell->robots) {
    const FleetRobot* robot = fleet_->find(compiled.id);
    if (robot == nullptr) continue;
    cell_state->robots.push_back({robot->id, robot->slot, robot->online, robot->sending, robot->stream, robot->contacts,
                                  robot->faults, cell_.robot(robot->id)->parameters(), motion_.target(robot->id),
                                  motion_.positioning(robot->id)});
  }
  cell_state->haptics = haptics_.snapshots();
  cell_state->forces = forces_.settings();
  cell_state->tcp_force = forces_.memory();
  cell_state->robot_forces = robot_forces_.snapshots();
  cell_state->active_robot = names_.active_robot();
  cell_state->language = programs_.language();
  cell_state->script = runner_->counters();
  cell_state->runs = runner_->runs();
  cell_state->script_errors = runner_->last_errors();
  cell_state->programs = programs_.snapshot();
  cell_state->switches = switches_->snapshot();
  cell_state->couplings = couplings_.snapshots();
  cell_state->controllers = controllers_.snapshots();
  cell_state->tissue = tissue_.settings();
  cell_state->volumes = volumes_.states();
  if (io_) cell_state->io_nodes = io_->snapshots();
  display_.follow();
  cell_state->display = display_.state();
  board_.publish(std::move(cell_state));
  last_publication_ = clock_.now();
}

}  // namespace cellmirror::app
