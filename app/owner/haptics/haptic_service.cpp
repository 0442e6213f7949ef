#include "app/owner/haptics/haptic_service.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "app/owner/haptics/haptic_instrument.hpp"
#include "app/snapshot/haptic_names.hpp"
#include "ipc/wire/haptic_block.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::app {

using haptics::Instrument;

namespace {

constexpr std::chrono::milliseconds kResetPatience{30};

}  // namespace

HapticService::HapticService(Parts parts)
    : cell_(parts.cell),
      fleet_(parts.fleet),
      clock_(parts.clock),
      instance_(std::move(parts.instance)),
      guard_(parts.guard) {
  for (RobotHaptic& device : parts.devices) add(std::move(device));
}

std::shared_ptr<JointStream> HapticService::stream(std::string_view robot) const {
  const auto found = devices_.find(robot);
  return found == devices_.end() ? nullptr : found->second.stream;
}

HapticService::~HapticService() {
  for (auto& [robot, device] : devices_) device.stream->detach();
}

HapticService::Device& HapticService::add(RobotHaptic config) {
  const std::string robot = config.robot;
  Device& device = devices_[robot];
  device.config = std::move(config);
  // Never more than kMaxHapticDevices, and none is ever taken away.
  device.channel = static_cast<std::uint8_t>(devices_.size() - 1);
  device.meter = std::make_shared<HapticMeter>();
  device.stream = std::make_shared<HapticStream>([this, robot] { return open(devices_.find(robot)->second); },
                                                 [this, robot] { close(devices_.find(robot)->second); });
  return device;
}

Result<void> HapticService::prepare() {
  for (auto& [robot, device] : devices_) {
    if (!device.config.key) continue;
    if (auto made = make_memory(device, *device.config.key, device.config.bytes); !made) return made;
    if (!device.config.online) continue;
    if (auto online = fleet_.set_online(robot, true); !online) return online;
  }
  return {};
}

void HapticService::shut_down() {
  for (auto& [robot, device] : devices_) {
    close(device);
    drop_memory(device);
  }
}

Result<std::shared_ptr<const Instrument>> HapticService::instrument_of(const Device& device) {
  const RobotModel* robot = cell_.robot(device.config.robot);
  if (robot == nullptr) return std::unexpected(cell_.explain_robot(device.config.robot));
  return make_instrument(cell_, *robot, device.config.settings, fleet_.positions());
}

Result<void> HapticService::open(Device& device) {
  if (!device.segment) {
    return fail(fmt::format("the haptic device of {} has no shared memory", device.config.robot),
                fmt::format("name it with ROBACT {0} and rob_ela_shm, or with shm_key in the [[haptic]] table of {0}",
                            device.config.robot));
  }
  if (!device.config.placed) place_at_tip(device);
  auto instrument = instrument_of(device);
  if (!instrument) return std::unexpected(instrument.error());
  if (auto sent = send_open(device, std::move(*instrument)); !sent) return sent;
  device.gone = false;
  device.samples_seen = 0;
  device.faults_seen = 0;
  device.online = true;
  return {};
}

void HapticService::place_at_tip(Device& device) {
  const RobotModel* robot = cell_.robot(device.config.robot);
  if (robot == nullptr) return;
  const Pose X_WT = cell_.world_pose(robot->flange(), fleet_.positions()) * robot->X_FT();
  device.config.settings.X_WD.translation() = X_WT.translation();
}

Result<void> HapticService::send_open(Device& device, std::shared_ptr<const Instrument> instrument) {
  const auto sent =
      fleet_.send(engine::OpenHaptic{.channel = device.channel,
                                     .instrument = fleet_.lend(instrument),
                                     .device = fleet_.lend(std::static_pointer_cast<HapticDevicePort>(device.port))});
  if (!sent) return std::unexpected(sent.error());
  device.instrument = std::move(instrument);
  device.revision = cell_.revision();
  return {};
}

void HapticService::close(Device& device) {
  if (!device.online) return;
  device.online = false;
  device.instrument.reset();
  // Once the tick has carried it out, it has given back the device. Where the loop stands still, that stays with it.
  if (fleet_.send(engine::CloseHaptic{device.channel})) static_cast<void>(fleet_.settle());
}

void HapticService::drop_memory(Device& device) {
  device.port.reset();  // writes zero forces
  device.segment.reset();
  device.users = SegmentUsers();
}

Result<void> HapticService::make_memory(Device& device, std::int32_t key, std::size_t bytes) {
  const RobotModel* robot = cell_.robot(device.config.robot);
  const auto joints = static_cast<std::uint8_t>(robot == nullptr ? 0 : robot->joint_count());
  auto segment = SharedSegment::make({.purpose = "haptic device of " + device.config.robot,
                                      .key = key,
                                      .bytes = bytes,
                                      .mode = device.config.mode,
                                      .instance = instance_,
                                      .guard = guard_,
                                      .block = GuardedBlock::haptic});
  if (!segment) return std::unexpected(segment.error());
  device.segment = std::move(*segment);
  // The memory outlives the device, which the tick may keep longer than we do.
  const auto memory = std::make_shared<std::pair<std::shared_ptr<SharedSegment>, std::optional<MeteredDevice>>>();
  memory->first = device.segment;
  memory->second.emplace(device.segment->memory(), joints, static_cast<std::uint32_t>(getpid()), clock_, device.meter);
  device.port = std::shared_ptr<MeteredDevice>(memory, &*memory->second);
  device.users = device.segment->users();
  device.stream->set_memory("shared memory " + key_text(key), device.meter);
  if (bytes < haptic_block_offset::kSize) {
    log_warning("haptic.memory",
                "the memory of {} has {} bytes: its forces stay zero, a device needs {} to write its position",
                device.config.robot, bytes, haptic_block_offset::kSize);
  }
  return {};
}

Result<HapticService::Device*> HapticService::device_for(std::string_view robot) {
  const auto found = devices_.find(robot);
  if (found != devices_.end()) return &found->second;
  if (fleet_.has_stream(robot)) {
    return fail(fmt::format("the robot {} follows the stream that the cell file names, and no haptic device", robot),
                "make another robot the active one with ROBACT");
  }
  if (devices_.size() >= kMaxHapticDevices)
    return fail(fmt::format("there are {} haptic devices already", kMaxHapticDevices));
  return &add(RobotHaptic{.robot = std::string(robot), .settings = {}, .key = {}});
}

Result<void> HapticService::set_force_memory(std::string_view robot, std::int32_t key, std::size_t bytes) {
  if (bytes < kLeastHapticBytes) {
    return fail(fmt::format("{} bytes hold no force", bytes),
                fmt::format("three float32 take {}, all that a device may say and hear {}", kLeastHapticBytes,
                            haptic_block_offset::kSize));
  }
  for (const auto& [id, other] : devices_) {
    if (id != robot && other.segment && other.segment->options().key == key)
      return fail(fmt::format("the key {} is that of the haptic device of {}", key_text(key), id),
                  "choose another key");
  }
  auto device = device_for(robot);
  if (!device) return std::unexpected(device.error());
  Device& open_anew = **device;
  const bool was_online = open_anew.online;
  const bool same =
      open_anew.segment && open_anew.segment->options().key == key && open_anew.segment->options().bytes == bytes;
  close(open_anew);
  if (!same) {
    drop_memory(open_anew);
    if (auto made = make_memory(open_anew, key, bytes); !made) return made;
  }
  return was_online ? open(open_anew) : Result<void>();
}

Result<void> HapticService::reset(std::string_view robot) {
  const auto found = devices_.find(robot);
  if (found == devices_.end()) {
    return fail(fmt::format("the robot {} has no haptic device", robot),
                "name one with a [[haptic]] table in the cell file, or with rob_ela_shm");
  }
  Device& device = found->second;
  if (!device.online)
    return fail(fmt::format("the robot {} is not online", robot), fmt::format("ROBOT {} online", robot));
  const HapticState before = fleet_.tick().haptics[device.channel];
  if (before.phase != HapticPhase::faulted) return {};
  follow_process(device, before);
  follow_cell(device);
  auto after = try_reset(device);
  if (after && after->phase == HapticPhase::faulted) {
    // The channel wants to see the cause away for a while.
    std::this_thread::sleep_for(kResetPatience);
    after = try_reset(device);
  }
  if (!after) return std::unexpected(after.error());
  if (after->phase != HapticPhase::faulted) return {};
  return fail(fmt::format("the haptic device of {} stays in fault: {}", robot, explanation(after->fault)),
              fmt::format("{}; then RESET_HAPTIC {}", remedy(after->fault), robot));
}

Result<HapticState> HapticService::try_reset(Device& device) {
  auto sent = fleet_.send(engine::ResetHaptic{device.channel});
  if (!sent) return std::unexpected(sent.error());
  if (auto settled = fleet_.settle(); !settled) return std::unexpected(settled.error());
  return fleet_.tick().haptics[device.channel];
}

void HapticService::follow() {
  const Timestamp now = clock_.now();
  if (last_check_.known() && now - last_check_ < kFollowEvery) return;
  last_check_ = now;
  for (auto& [robot, device] : devices_) {
    if (!device.segment) continue;
    const HapticState state = fleet_.tick().haptics[device.channel];
    follow(device, state);
  }
}

void HapticService::follow(Device& device, const HapticState& state) {
  follow_memory(device);
  if (!device.online) return;
  follow_process(device, state);
  report_faults(device, state);
  follow_cell(device);
}

void HapticService::follow_memory(Device& device) {
  device.users = device.segment->users();
  if (!device.users.gone) return;
  if (auto renewed = device.segment->renew(); !renewed) {
    log_error("haptic.memory", "the memory of {} was removed: {}", device.config.robot, renewed.error().text());
    return;
  }
  log_warning(
      "haptic.memory",
      "the memory of {} was removed by another process and is created again: the device has to attach to it again",
      device.config.robot);
  device.users = device.segment->users();
}

void HapticService::follow_process(Device& device, const HapticState& state) {
  const bool came = state.samples != device.samples_seen;
  device.samples_seen = state.samples;
  bool gone = device.gone && !came;
  bool ended = false;
  if (state.device_writer != 0) {
    ended = device.process.has_ended(state.device_writer);
    gone = gone || (!came && (ended || device.users.attached <= 1));
  }
  if (gone == device.gone) return;
  device.gone = gone;
  const auto sent = fleet_.send(engine::SetDeviceGone{.channel = device.channel, .gone = gone});
  if (!sent) log_error("haptic.loop", "{}", sent.error().text());
  if (gone) {
    log_warning("haptic.device", "the process {} of the haptic device of {} {}", state.device_writer,
                device.config.robot, ended ? "has ended" : "is no longer attached to its memory");
  } else {
    log_info("haptic.device", "the haptic device of {} is back", device.config.robot);
  }
}

void HapticService::report_faults(Device& device, const HapticState& state) {
  if (state.re_engagements > device.re_engagements_seen)
    log_info("haptic.fault robot=" + device.config.robot, "the fault has passed: the device engages again");
  device.re_engagements_seen = state.re_engagements;
  if (state.faults == device.faults_seen) return;
  const bool news = state.faults > device.faults_seen && state.phase == HapticPhase::faulted;
  device.faults_seen = state.faults;
  if (!news) return;
  log_warning("haptic.fault robot=" + device.config.robot, "no force: {}", fault_text(state, device.config.robot));
}

void HapticService::follow_cell(Device& device) {
  const RobotModel* robot = cell_.robot(device.config.robot);
  if (robot == nullptr || !device.instrument) return;
  const bool changed = device.revision != cell_.revision();
  const Pose X_WB = cell_.world_pose(robot->zero_point(), fleet_.positions());
  const bool moved = (X_WB.matrix() - device.instrument->X_WB.matrix()).cwiseAbs().maxCoeff() > 1e-6;
  if (!changed && !moved) return;
  auto instrument = instrument_of(device);
  device.revision = cell_.revision();
  if (!instrument) {
    log_error("haptic.instrument", "{} is no instrument any more: {}", device.config.robot, instrument.error().text());
    const auto sent = fleet_.send(engine::CloseHaptic{device.channel});
    if (!sent) log_error("haptic.loop", "{}", sent.error().text());
    return;
  }
  if (same_instrument(**instrument, *device.instrument)) return;
  const Timestamp now = clock_.now();
  if (!device.exchanged.known() || now - device.exchanged > kSameChange)
    log_info("haptic.instrument", "{} has changed: its haptic device engages again", device.config.robot);
  device.exchanged = now;
  if (auto opened = send_open(device, std::move(*instrument)); !opened)
    log_error("haptic.loop", "{}", opened.error().text());
}

bool HapticService::any_online() const {
  return std::ranges::any_of(devices_, [](const auto& entry) { return entry.second.online; });
}

std::vector<HapticSnapshot> HapticService::snapshots() const {
  std::vector<HapticSnapshot> out;
  for (const auto& [robot, device] : devices_) {
    const RobotModel* model = cell_.robot(robot);
    if (model == nullptr) continue;
    HapticSnapshot snapshot;
    snapshot.robot = robot;
    snapshot.slot = static_cast<std::uint8_t>(model->slot());
    snapshot.channel = device.channel;
    snapshot.online = device.online;
    snapshot.reach_m = device.config.reach_m;
    snapshot.settings = device.config.settings;
    if (device.segment) {
      snapshot.key = device.segment->options().key;
      snapshot.bytes = device.segment->options().bytes;
      snapshot.attached = device.users.attached;
      snapshot.renewed = device.segment->renewed();
    }
    snapshot.device_gone = device.gone;
    snapshot.meter = device.meter;
    out.push_back(std::move(snapshot));
  }
  return out;
}

}  // namespace cellmirror::app
