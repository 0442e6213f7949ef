#include "sim_devices/robot/dbc_robot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "rt_core/base/text.hpp"

namespace cellmirror::sim {
namespace {

constexpr int kMostNestedMultiplexers = 8;

std::span<std::uint8_t> data_of(CanFrame& frame) { return {frame.data.data(), frame.length}; }

// Sets the multiplexers so that `signal` is in the frame, from the inmost outwards.
void select(const can::DbcMessage& message, const can::DbcSignal& signal, CanFrame& frame) {
  const can::DbcSignal* inner = &signal;
  for (int depth = 0; inner->is_multiplexed && depth < kMostNestedMultiplexers; ++depth) {
    const can::DbcSignal* outer = inner->multiplexer.empty() ? message.multiplexer() : message.find(inner->multiplexer);
    if (outer == nullptr || inner->multiplexer_values.empty()) return;
    const auto raw = static_cast<double>(inner->multiplexer_values.front().first);
    can::put_physical_value(*outer, raw * outer->factor + outer->offset, data_of(frame));
    inner = outer;
  }
}

double quantity_of(const JointValue& value, JointQuantity quantity) {
  switch (quantity) {
    case JointQuantity::position:
      return value.position;
    case JointQuantity::velocity:
      return value.velocity;
    case JointQuantity::effort:
      return value.effort;
  }
  return 0;
}

}  // namespace

DbcRobot::DbcRobot(const DbcRobotConfig& config, std::unique_ptr<MotionSource> motion,
                   std::unique_ptr<CanChannel> channel)
    : FaultyDevice(config.seed),
      config_(config),
      motion_(std::move(motion)),
      channel_(std::move(channel)),
      values_(config.joints),
      pacer_({}, period_of(config.rate_hz)) {
  counters_.endpoint = config.endpoint;
  counters_.first_robot = config.robot;
  counters_.robots = 1;
  counters_.samples_of_robot.resize(1);
}

Result<std::unique_ptr<DbcRobot>> DbcRobot::make(const DbcRobotConfig& config, const can::Dbc& dbc,
                                                 std::unique_ptr<MotionSource> motion,
                                                 std::unique_ptr<CanChannel> channel) {
  std::unique_ptr<DbcRobot> robot(new DbcRobot(config, std::move(motion), std::move(channel)));
  std::string problems;
  for (const DbcSignalConfig& wanted : config.signals) {
    const can::DbcMessage* message = dbc.find(wanted.message);
    const can::DbcSignal* signal = message == nullptr ? nullptr : message->find(wanted.signal);
    if (signal != nullptr) {
      robot->take_in(*message, *signal, wanted);
      continue;
    }
    const can::DbcFault* fault = dbc.fault_of(message == nullptr ? wanted.message : message->name,
                                              message == nullptr ? std::string() : wanted.signal);
    if (fault != nullptr) {
      problems += fmt::format("{}{}", problems.empty() ? "" : "; ", fault->why.message);
      continue;
    }
    std::vector<std::string> names;
    for (const can::DbcMessage& known : dbc.messages) {
      for (const can::DbcSignal& one : known.signals) names.push_back(known.name + "." + one.name);
    }
    const std::string guess = did_you_mean(wanted.message + "." + wanted.signal, names);
    problems += fmt::format("{}the DBC has no signal '{}.{}'{}{}", problems.empty() ? "" : "; ",
                            printable(wanted.message), printable(wanted.signal), guess.empty() ? "" : ", ", guess);
  }
  if (!problems.empty()) return fail(problems);
  for (const E2eConfig& protection : config.protections) {
    if (auto made = robot->protect_message(protection, dbc); !made) return std::unexpected(made.error());
  }
  return robot;
}

void DbcRobot::take_in(const can::DbcMessage& message, const can::DbcSignal& signal, const DbcSignalConfig& config) {
  CanFrame start;
  start.id = message.id;
  start.extended = message.extended;
  start.length = message.length;
  start.fd = message.length > 8;
  select(message, signal, start);
  const int joint = static_cast<int>(config.joint) + 1;
  const auto same = std::find_if(frames_.begin(), frames_.end(), [&](const Frame& frame) {
    return frame.start.id == start.id && frame.start.extended == start.extended && frame.start.data == start.data;
  });
  if (same == frames_.end()) {
    frames_.push_back({message, start, {{signal, config, false}}, joint, {}});
    return;
  }
  same->entries.push_back({signal, config, false});
  if (same->joint != joint) same->joint = 0;
}

Result<void> DbcRobot::protect_message(const E2eConfig& config, const can::Dbc& dbc) {
  const can::DbcMessage* message = dbc.find(config.message);
  if (message == nullptr) return fail(fmt::format("the DBC has no message {}", printable(config.message)));
  auto format = can::make_e2e_format(config, *message);
  if (!format) return std::unexpected(format.error());
  bool used = false;
  for (Frame& frame : frames_) {
    if (frame.message.name != config.message) continue;
    frame.protection = *format;
    used = true;
  }
  if (!used) return fail(fmt::format("--e2e: no signal of {} is sent", printable(config.message)));
  return {};
}

void DbcRobot::protect_frame(const Frame& frame, CanFrame& filled) {
  if (!frame.protection) return;
  std::uint16_t& counter = next_counter_[frame.message.name];
  can::protect(*frame.protection, counter, data_of(filled));
  counter = counter == frame.protection->last_counter ? std::uint16_t{0} : static_cast<std::uint16_t>(counter + 1);
}

void DbcRobot::start(Timestamp now) {
  start_motion(now);
  pacer_ = Pacer(now, pacer_.period());
}

Timestamp DbcRobot::next() const { return std::min(pacer_.next(), pipeline_.next()); }

void DbcRobot::work(Timestamp now) {
  if (pacer_.due(now)) {
    note_lateness(pacer_.next(), now);
    pacer_.advance(now);
    std::fill(values_.begin(), values_.end(), JointValue{});
    motion_->at(motion_time_s(now), values_);
    pipeline_.schedule().shape(now, config_.robot, values_);
    for (Frame& frame : frames_) send_frame(frame, now);
  }
  flush(now);
}

void DbcRobot::send_frame(Frame& frame, Timestamp now) {
  const Source source{config_.robot, frame.joint};
  if (!pipeline_.schedule().alive(now, source)) return;
  CanFrame filled = frame.start;
  for (Entry& entry : frame.entries) {
    const double value = quantity_of(values_[entry.config.joint], entry.config.quantity);
    const double physical = (value - entry.config.offset) / entry.config.scale;
    can::put_physical_value(entry.signal, physical, data_of(filled));
    note_fit(frame, entry, physical, filled);
  }
  protect_frame(frame, filled);
  pipeline_.push(now, {now, source, MessageKind::sample, filled});
}

void DbcRobot::note_fit(const Frame& frame, Entry& entry, double wanted, const CanFrame& filled) {
  if (entry.signal.type != can::DbcValueType::integer || !std::isfinite(wanted)) return;
  const double sent = can::physical_value(entry.signal, filled.payload());
  if (std::abs(sent - wanted) <= std::abs(entry.signal.factor)) return;
  ++did_not_fit_;
  if (entry.too_small) return;
  entry.too_small = true;
  fmt::print(stderr, "sim_robot: {:.6g} does not fit into {}.{}, {:.6g} is sent\n", wanted, frame.message.name,
             entry.signal.name, sent);
}

void DbcRobot::wait_until(Timestamp t) {
  // It ignores all frames, but receiving updates the channel's bus state.
  const SystemClock clock;
  ReceivedCanFrame ignored;
  for (Nanoseconds left = t - clock.now(); left.count() > 0; left = t - clock.now()) {
    if (channel_->receive(ignored, left) == CanReceive::frame) continue;
    sleep_until(t);
  }
}

Result<void> DbcRobot::check(const FaultSpec& spec) const {
  if (spec.kind == FaultKind::nan) {
    const bool any = std::any_of(frames_.begin(), frames_.end(), [](const Frame& frame) {
      return std::any_of(frame.entries.begin(), frame.entries.end(),
                         [](const Entry& entry) { return entry.signal.type != can::DbcValueType::integer; });
    });
    if (!any) return fail("an integer signal cannot be NaN", "use jump or corrupt");
  }
  return {};
}

DeviceStatus DbcRobot::status(Timestamp now) const {
  DeviceStatus status = common_status(now);
  status.missed_periods = pacer_.missed();
  status.details.emplace_back("frames_of_a_sample", frames_.size());
  status.details.emplace_back("values_that_did_not_fit", did_not_fit_);
  return status;
}

}  // namespace cellmirror::sim
