#include "app/owner/fleet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "app/io/can_tap.hpp"
#include "app/io/node_channels.hpp"
#include "app/io/payload_tap.hpp"
#include "app/io/robot_streams.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror::app {

namespace {

// The tick empties its queue in a few periods unless it stands still.
constexpr std::chrono::milliseconds kTickPatience{200};
constexpr std::chrono::microseconds kTickPoll{200};

Error tick_stands_still() {
  return {"the loop does not take commands", "see cellmirror status; a fault record says why it stopped"};
}

StreamAges ages_of(const StreamConfig& config) {
  return std::visit(
      [](const auto& stream) -> StreamAges {
        if constexpr (requires { stream.ages; }) {
          return stream.ages;
        } else {
          return {};
        }
      },
      config);
}

PlausibilityConfig plausibility_of(const StreamConfig& config) {
  return std::visit(
      [](const auto& stream) -> PlausibilityConfig {
        if constexpr (requires { stream.plausibility; }) {
          return stream.plausibility;
        } else {
          return {};
        }
      },
      config);
}

PlausibilityBounds bounds_of_robot(const RobotModel& robot, const PlausibilityConfig& config) {
  PlausibilityBounds bounds{.arrival_jitter = config.arrival_jitter, .plausible_after = config.plausible_after};
  if (config.enabled) bounds.frozen_after = config.frozen_after;
  const std::span<const KnownLimits> known = robot.known_limits();
  for (std::size_t i = 0; i < known.size() && i < bounds.joints.size(); ++i)
    bounds.joints[i] = bounds_of(known[i], config);
  return bounds;
}

std::uint8_t slot_number(std::size_t slot) { return static_cast<std::uint8_t>(slot); }

engine::JointLimits limits_of(const RobotModel& robot) {
  return {.lower = robot.parameters().min_range, .upper = robot.parameters().max_range};
}

}  // namespace

Fleet::Fleet(Cell& cell, engine::Engine& engine, std::map<std::string, StreamConfig, std::less<>> streams,
             const Clock& clock, int stream_priority, Events events)
    : cell_(cell),
      engine_(engine),
      ticks_(engine.subscribe("owner")),
      streams_(std::move(streams)),
      clock_(clock),
      stream_priority_(stream_priority),
      events_(std::move(events)),
      positions_(cell.start_positions()) {
  cell_.set_online_query([this](std::string_view id) {
    const FleetRobot* robot = find(id);
    return robot != nullptr && robot->online;
  });
}

Fleet::~Fleet() {
  cell_.set_online_query({});
  for (auto& [id, robot] : robots_) {
    if (robot.online) robot.stream->close();
  }
}

const FleetRobot* Fleet::find(std::string_view id) const {
  const auto found = robots_.find(id);
  return found == robots_.end() ? nullptr : &found->second;
}

Result<std::uint64_t> Fleet::send(engine::Command command) {
  const Timestamp deadline = clock_.now() + kTickPatience;
  for (;;) {
    const std::uint64_t id = engine_.send(command);
    if (id != 0) {
      last_command_ = id;
      return id;
    }
    if (clock_.now() > deadline) return std::unexpected(tick_stands_still());
    wait_for_tick();
  }
}

void Fleet::wait_for_tick() const {
  if (events_.let_tick_pass) return events_.let_tick_pass();
  std::this_thread::sleep_for(kTickPoll);
}

Result<void> Fleet::settle() {
  const Timestamp deadline = clock_.now() + kTickPatience;
  while (ticks_.newest().commands_done < last_command_) {
    if (clock_.now() > deadline) return std::unexpected(tick_stands_still());
    wait_for_tick();
  }
  engine_.free_returned();
  return {};
}

Result<void> Fleet::follow_cell() {
  for (auto robot = robots_.begin(); robot != robots_.end();) {
    if (cell_.robot(robot->first) != nullptr) {
      ++robot;
      continue;
    }
    const auto sent = send(engine::RemoveRobot{slot_number(robot->second.slot)});
    if (!sent) return std::unexpected(sent.error());
    robot = robots_.erase(robot);
  }
  for (const std::string& id : cell_.robot_ids()) {
    if (robots_.contains(id)) continue;
    if (auto added = add(*cell_.robot(id)); !added) return added;
  }
  return {};
}

Result<void> Fleet::add(const RobotModel& robot) {
  const engine::RobotSetup setup{.joint_count = static_cast<std::uint8_t>(robot.joint_count()),
                                 .positions = robot.parameters().start_position,
                                 .limits = limits_of(robot)};
  const auto sent = send(engine::AddRobot{.slot = slot_number(robot.slot()),
                                          .robot = lend(std::make_shared<const engine::RobotSetup>(setup))});
  if (!sent) return std::unexpected(sent.error());
  FleetRobot added;
  added.id = robot.id();
  added.slot = robot.slot();
  added.put_at = robot.parameters().start_position;
  added.put_command = *sent;
  added.start = added.put_at;
  robots_.emplace(robot.id(), std::move(added));
  return {};
}

Result<void> Fleet::update_limits(const RobotModel& robot) {
  const auto sent =
      send(engine::SetLimits{.slot = slot_number(robot.slot()),
                             .limits = lend(std::make_shared<const engine::JointLimits>(limits_of(robot)))});
  if (!sent) return std::unexpected(sent.error());
  return {};
}

Result<void> Fleet::set_online(std::string_view id, bool online) {
  const auto found = robots_.find(id);
  if (found == robots_.end()) return std::unexpected(cell_.explain_robot(id));
  FleetRobot& robot = found->second;
  if (robot.online == online) return {};
  return online ? bring_online(robot) : take_offline(robot);
}

Result<void> Fleet::make_stream(FleetRobot& robot) {
  if (events_.let_tick_pass) return fail(fmt::format("off line there is no controller that {} could follow", robot.id));
  const auto config = streams_.find(robot.id);
  if (config == streams_.end()) {
    robot.stream = events_.device_stream ? events_.device_stream(robot.id) : nullptr;
    if (robot.stream) return {};
    return fail(
        fmt::format("the cell file names no stream and no haptic device for the robot {}", robot.id),
        fmt::format("add a [[stream]] or [[haptic]] table with robot = \"{}\" to it (docs/cell-files.md)", robot.id));
  }
  StreamLinks links;
  if (events_.can_tap != nullptr) links.open_can = events_.can_tap->opener(robot.id);
  if (events_.payload_tap != nullptr) links.payloads = events_.payload_tap->sink_for(config->second, robot.id);
  if (const auto* device = std::get_if<Cia402DeviceConfig>(&config->second)) {
    CELLMIRROR_EXPECTS(events_.node_channels != nullptr);
    links.device_channel = events_.node_channels->find(device->channel);
    links.contacts = std::make_shared<ContactInlet>();
    auto target =
        std::make_shared<FaultTarget>(FaultTarget{.channel = device->channel.endpoint, .robot = robot.id, .nodes = {}});
    for (const DriveConfig& node : device->nodes) target->nodes.push_back(node.node_id);
    links.faults = target->inlet;
    robot.faults = std::move(target);
  }
  auto made = make_robot_stream(config->second, clock_, stream_priority_, links);
  if (!made) return std::unexpected(made.error());
  robot.contacts = std::move(links.contacts);
  robot.stream = std::move(*made);
  return {};
}

Result<void> Fleet::bring_online(FleetRobot& robot) {
  if (!robot.stream) {
    if (auto made = make_stream(robot); !made) return made;
  }
  engine::SetMode command{.slot = slot_number(robot.slot), .mode = engine::RobotMode::mirrored};
  if (const auto config = streams_.find(robot.id); config != streams_.end()) {
    command.ages = ages_of(config->second);
    command.given = static_cast<std::uint16_t>(joints_given_by(config->second));
    command.plausibility = lend(std::make_shared<const PlausibilityBounds>(
        bounds_of_robot(*cell_.robot(robot.id), plausibility_of(config->second))));
  }
  // The stream first: one that cannot be opened leaves the robot to what it does. Samples wait for the mode in the
  // inlet.
  if (auto opened = robot.stream->open(sink_of(robot)); !opened) return opened;
  if (auto sent = send(std::move(command)); !sent) {
    robot.stream->close();
    return std::unexpected(sent.error());
  }
  robot.online = true;
  robot.commanded = true;
  return {};
}

JointSampleSink& Fleet::sink_of(FleetRobot& robot) {
  JointSampleSink& inlet = engine_.inlet(robot.slot);
  const std::span<const JointKind> kinds = cell_.robot(robot.id)->joint_kinds();
  std::uint32_t turning = 0;
  for (std::size_t i = 0; i < kinds.size() && i < kMaxJointsPerRobot; ++i) {
    if (kinds[i] == JointKind::continuous) turning |= 1U << i;
  }
  // A simulated drive counts the turns of its joint itself.
  const auto config = streams_.find(robot.id);
  const bool counts = config != streams_.end() && std::holds_alternative<Cia402DeviceConfig>(config->second);
  if (turning == 0 || counts) return inlet;
  robot.turns = std::make_shared<TurnUnwrapper>(inlet, turning);
  return *robot.turns;
}

Result<void> Fleet::take_offline(FleetRobot& robot) {
  robot.stream->close();
  robot.online = false;
  const auto sent = send(engine::SetMode{.slot = slot_number(robot.slot), .mode = engine::RobotMode::simulated});
  if (!sent) return std::unexpected(sent.error());
  // The model stays where the real robot was seen last: once this is carried out, no sample moves it any more.
  return settle();
}

Result<void> Fleet::set_sending(std::string_view id, bool sending) {
  const auto found = robots_.find(id);
  if (found == robots_.end()) return std::unexpected(cell_.explain_robot(id));
  found->second.sending = sending;
  return {};
}

Result<void> Fleet::check_simulated(std::string_view id) const {
  const FleetRobot* robot = find(id);
  if (robot == nullptr) return std::unexpected(cell_.explain_robot(id));
  if (!robot->online) return {};
  return fail(fmt::format("the robot {} is online and follows its controller", id),
              fmt::format("command it after ROBOT {} offline", id));
}

motion::MotionState Fleet::motion(std::string_view id) {
  const FleetRobot* robot = find(id);
  return robot == nullptr ? motion::MotionState() : ticks_.newest().robots[robot->slot].motion;
}

bool Fleet::knows_position(std::string_view id) {
  const FleetRobot* robot = find(id);
  if (robot == nullptr) return false;
  return !robot->online || ticks_.newest().robots[robot->slot].state == DataState::fresh;
}

std::span<const JointValues> Fleet::positions() {
  const engine::TickState& view = ticks_.newest();
  for (const auto& [id, robot] : robots_) {
    JointValues& out = positions_[robot.slot];
    if (view.commands_done < robot.put_command) {
      out = robot.put_at;
      continue;
    }
    const engine::RobotTickState& state = view.robots[robot.slot];
    for (std::size_t i = 0; i < state.joint_count; ++i) out[i] = state.joints[i].position;
  }
  return positions_;
}

Result<void> Fleet::set_chain(std::string_view id, std::shared_ptr<const kinematics::Chain> chain) {
  const auto sent = send(engine::SetChain{.slot = slot_of(id), .chain = lend(std::move(chain))});
  if (!sent) return std::unexpected(sent.error());
  return {};
}

Result<void> Fleet::add_move(std::string_view id, const motion::Move& move) {
  const auto sent =
      send(engine::AddMove{.slot = slot_of(id), .move = lend(std::make_shared<const motion::Move>(move))});
  if (!sent) return std::unexpected(sent.error());
  robots_.find(id)->second.commanded = true;
  if (events_.move_given) events_.move_given(id, move);
  return {};
}

Result<void> Fleet::stop_motion(std::string_view id) {
  const auto sent = send(engine::StopMotion{slot_of(id)});
  if (!sent) return std::unexpected(sent.error());
  return {};
}

Result<void> Fleet::set_pace(std::string_view id, double pace) {
  const auto sent = send(engine::SetPace{.slot = slot_of(id), .pace = pace});
  if (!sent) return std::unexpected(sent.error());
  return {};
}

Result<void> Fleet::hold_behind(std::string_view id, std::uint32_t move) {
  const auto sent = send(engine::HoldBehind{.slot = slot_of(id), .move = move});
  if (!sent) return std::unexpected(sent.error());
  return {};
}

Result<std::uint64_t> Fleet::follow_trajectory(std::string_view id,
                                               std::shared_ptr<const motion::Trajectory> trajectory) {
  auto sent = send(engine::FollowTrajectory{.slot = slot_of(id), .trajectory = lend(std::move(trajectory))});
  if (sent) robots_.find(id)->second.commanded = true;
  return sent;
}

std::uint8_t Fleet::slot_of(std::string_view id) const { return slot_number(find(id)->slot); }

Result<void> Fleet::jump(std::string_view id, const JointValues& positions) {
  FleetRobot& robot = robots_.find(id)->second;
  robot.commanded = true;
  return put(robot, positions);
}

Result<void> Fleet::put(FleetRobot& robot, const JointValues& positions) {
  const auto sent = send(engine::SetPositions{.slot = slot_number(robot.slot), .positions = positions});
  if (!sent) return std::unexpected(sent.error());
  robot.put_at = positions;
  robot.put_command = *sent;
  return {};
}

Result<bool> Fleet::begin_at(std::string_view id, const JointValues& start) {
  FleetRobot& robot = robots_.find(id)->second;
  // A coupling or a haptic device may have moved it without a command of its own.
  const JointValues& now = positions()[robot.slot];
  const std::size_t joints = cell_.robot(id)->joint_count();
  const bool moved = !std::equal(now.begin(), now.begin() + static_cast<std::ptrdiff_t>(joints), robot.start.begin());
  if (robot.commanded || moved) return false;
  if (auto done = put(robot, start); !done) return std::unexpected(done.error());
  robot.start = start;
  return true;
}

}  // namespace cellmirror::app
