#include "drivers/can/dbc/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include "drivers/can/dbc/unit.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

constexpr Nanoseconds kToldAgainAfter = std::chrono::seconds(10);

class SignalPlanner {
 public:
  SignalPlanner(const DbcStreamConfig& config, Dbc dbc, Diagnostics& diagnostics) : diagnostics_(&diagnostics) {
    plan_.config = config;
    plan_.dbc = std::move(dbc);
  }

  std::optional<DbcPlan> plan() {
    const std::size_t before = diagnostics_->errors();
    const Place& stream = plan_.config.place;
    if (plan_.config.signals.empty()) error(stream, "a DBC stream needs at least one signal");
    bool has_position = plan_.config.signals.empty();
    for (const DbcSignalConfig& signal : plan_.config.signals) {
      has_position |= signal.quantity == JointQuantity::position;
      add(signal);
    }
    for (const E2eConfig& protection : plan_.config.protections) protect_message(protection);
    if (!has_position) error(stream, "none of the signals is a position: nothing would be mirrored");
    if (diagnostics_->errors() != before) return {};
    return std::move(plan_);
  }

 private:
  void error(const Place& place, std::string message, std::string remedy = {}) {
    diagnostics_->error(place, std::move(message), std::move(remedy));
  }

  // Returns true if the message or signal was left out as faulty, and reports the fault as an error in the DBC.
  bool is_left_out(std::string_view message, std::string_view signal) {
    const DbcFault* fault = plan_.dbc.fault_of(message, signal);
    if (fault == nullptr) return false;
    error(fault->why.place,
          fmt::format("the stream uses {}{}{}: {}", printable(message), signal.empty() ? "" : ".", printable(signal),
                      fault->why.message),
          fault->why.remedy);
    return true;
  }

  void look_at_unit(const DbcSignalConfig& config, const DbcSignal& signal) {
    if (config.scale_given) return;
    const auto scale = si_scale_of(signal.unit);
    if (!scale) return;
    diagnostics_->warning(
        config.place,
        fmt::format("signal {}.{} is in {} and scale is 1", config.message, config.signal, printable(signal.unit)),
        fmt::format("write scale = {}", *scale));
  }

  void add(const DbcSignalConfig& config) {
    if (config.joint >= kMaxJointsPerRobot) {
      error(config.place, fmt::format("joint {} is beyond {} joints", config.joint, kMaxJointsPerRobot));
      return;
    }
    if (!std::isfinite(config.scale) || config.scale == 0.0 || !std::isfinite(config.offset)) {
      error(config.place,
            fmt::format("signal {}: the scale has to be finite and not 0, the offset finite", config.signal));
      return;
    }
    const DbcMessage* message = plan_.dbc.find(config.message);
    if (message == nullptr && is_left_out(config.message, {})) return;
    if (message == nullptr) {
      error(config.message_place, fmt::format("the DBC has no message {}", printable(config.message)),
            nearest_message(config.message));
      return;
    }
    const DbcSignal* signal = message->find(config.signal);
    if (signal == nullptr && is_left_out(message->name, config.signal)) return;
    if (signal == nullptr) {
      error(config.place, fmt::format("the message {} has no signal {}", config.message, printable(config.signal)),
            nearest_signal(*message, config.signal));
      return;
    }
    look_at_unit(config, *signal);
    DbcPlan::Mapped mapped;
    mapped.message = static_cast<std::size_t>(message - plan_.dbc.messages.data());
    mapped.signal = static_cast<std::size_t>(signal - message->signals.data());
    mapped.config = config;
    plan_.mapped.push_back(std::move(mapped));
  }

  void protect_message(const E2eConfig& config) {
    const DbcMessage* message = plan_.dbc.find(config.message);
    if (message == nullptr && is_left_out(config.message, {})) return;
    if (message == nullptr) {
      error(config.place, fmt::format("the DBC has no message {}", printable(config.message)),
            nearest_message(config.message));
      return;
    }
    const auto number = static_cast<std::size_t>(message - plan_.dbc.messages.data());
    const bool used = std::ranges::any_of(plan_.mapped, [&](const auto& mapped) { return mapped.message == number; });
    const bool twice =
        std::ranges::any_of(plan_.protections, [&](const auto& other) { return other.message == number; });
    if (!used) return error(config.place, fmt::format("no signal of {} is used", printable(config.message)));
    if (twice) return error(config.place, fmt::format("{} is protected twice", printable(config.message)));
    auto format = make_e2e_format(config, *message);
    if (!format) return error(config.place, format.error().what, format.error().remedy);
    plan_.protections.push_back({number, *format});
  }

  std::string nearest_message(std::string_view wrong) const {
    std::vector<std::string> names;
    for (const DbcMessage& message : plan_.dbc.messages) names.push_back(message.name);
    return did_you_mean(wrong, names);
  }
  static std::string nearest_signal(const DbcMessage& message, std::string_view wrong) {
    std::vector<std::string> names;
    for (const DbcSignal& signal : message.signals) names.push_back(signal.name);
    return did_you_mean(wrong, names);
  }

  DbcPlan plan_;
  Diagnostics* diagnostics_;
};

// The range of the signal's counter in SI units; 0 if the signal is not a counter that wraps.
double span_of(const DbcSignal& signal, const DbcSignalConfig& config) {
  constexpr std::uint16_t kLongest = 32;
  const bool wraps = config.turns && config.quantity == JointQuantity::position &&
                     signal.type == DbcValueType::integer && signal.length <= kLongest;
  return wraps ? std::ldexp(std::abs(signal.factor * config.scale), signal.length) : 0.0;
}

// The motion between two frames behind a difference of counter values. Takes the shorter way round, since no joint
// moves by half of the counter's range between two frames. A source may also wrap at one turn, although its signal
// holds more (0 to 360 degrees in 16 bits): then the way round the counter is long and the way round one turn is short.
double step_of(double difference, double span) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double by_counter = std::remainder(difference, span);
  const double by_turn = std::remainder(difference, kTurn);
  const bool wraps_at_turn = std::abs(by_counter) > span / 4 && std::abs(by_turn) < std::abs(by_counter) / 2;
  return wraps_at_turn ? by_turn : by_counter;
}

}  // namespace

std::optional<DbcPlan> plan_dbc(const DbcStreamConfig& config, Dbc dbc, Diagnostics& diagnostics) {
  return SignalPlanner(config, std::move(dbc), diagnostics).plan();
}

std::optional<DbcPlan> plan_dbc(const DbcStreamConfig& config, Diagnostics& diagnostics) {
  const std::size_t before = diagnostics.errors();
  auto dbc = read_dbc(config.dbc_file, diagnostics);
  if (!dbc) return {};
  auto plan = plan_dbc(config, std::move(*dbc), diagnostics);
  if (diagnostics.errors() != before) return {};
  return plan;
}

DbcSession::DbcSession(DbcPlan plan, DbcSessionOutput& output) : plan_(std::move(plan)), output_(&output) {
  for (const DbcPlan::Mapped& mapped : plan_.mapped) {
    CELLMIRROR_EXPECTS(mapped.message < plan_.dbc.messages.size() && mapped.config.joint < kMaxJointsPerRobot);
    const DbcMessage& message = plan_.dbc.messages[mapped.message];
    CELLMIRROR_EXPECTS(mapped.signal < message.signals.size());
    Source& source = sources_[{message.extended, message.id}];
    source.message = &message;
    const DbcSignalConfig& config = mapped.config;
    source.fields.push_back(
        {&message.signals[mapped.signal], config.joint, config.quantity, config.scale, config.offset, false, {}, {}});
    source.fields.back().span = span_of(message.signals[mapped.signal], config);
  }
  for (const DbcPlan::Protection& protection : plan_.protections) {
    const DbcMessage& message = plan_.dbc.messages.at(protection.message);
    sources_.at({message.extended, message.id}).checker.emplace(protection.format);
  }
}

void DbcSession::restart() {
  for (auto& [id, source] : sources_) {
    for (Field& field : source.fields) {
      field.senders = {};
      field.last.reset();
    }
  }
  for (const DbcPlan::Protection& protection : plan_.protections) {
    const DbcMessage& message = plan_.dbc.messages.at(protection.message);
    sources_.at({message.extended, message.id}).checker.emplace(protection.format);
  }
  velocity_ = {};
  effort_ = {};
}

void DbcSession::receive(const CanFrame& frame, Timestamp now) {
  if (frame.error || frame.remote) return;
  const auto found = sources_.find({frame.extended, frame.id});
  if (found == sources_.end()) return;
  Source& source = found->second;
  if (frame.length < source.message->length) {
    reject(fmt::format("{}: {} bytes, the DBC says {}", source.message->name, frame.length, source.message->length));
    return;
  }
  sample_.present = 0;
  sample_.refused = 0;
  sample_.conflict = 0;
  if (is_sound(source, frame, now)) {
    for (Field& field : source.fields) take(source, field, frame, now);
  }
  emit(now);
}

bool DbcSession::is_sound(Source& source, const CanFrame& frame, Timestamp now) {
  if (!source.checker) return true;
  const E2eChecker::Verdict verdict = source.checker->check(frame.payload().first(source.message->length));
  counters_.lost += verdict.missing;
  if (verdict.good()) return true;
  trouble_.status = verdict.status;
  trouble_.message = source.message;
  trouble_.protection = now;
  if (verdict.status == E2eStatus::repeated) {
    ++counters_.repeated;
    return false;
  }
  ++(verdict.status == E2eStatus::wrong_crc ? counters_.wrong_crc : counters_.wrong_sequence);
  reject(fmt::format("{}: {}", source.message->name, word(verdict.status)));
  refuse_fields(source);
  return false;
}

void DbcSession::refuse_fields(const Source& source) {
  for (const Field& field : source.fields) {
    if (field.quantity == JointQuantity::position) sample_.refused |= 1U << field.joint;
    if (field.quantity == JointQuantity::velocity) velocity_.forget(field.joint);
    if (field.quantity == JointQuantity::effort) effort_.forget(field.joint);
  }
}

void DbcSession::emit(Timestamp now) {
  if ((sample_.present | sample_.refused | sample_.conflict) == 0) return;
  sample_.velocity = velocity_.at(now, plan_.config.ages.lost_after);
  sample_.effort = effort_.at(now, plan_.config.ages.lost_after);
  sample_.receive_time = now;
  sample_.sequence = ++counters_.samples;
  output_->sample(sample_);
}

void DbcSession::take(const Source& source, Field& field, const CanFrame& frame, Timestamp now) {
  if (!is_present(*source.message, *field.signal, frame.payload())) return;
  const double physical = physical_value(*field.signal, frame.payload());
  const double value = physical * field.scale + field.offset;
  const bool finite = std::isfinite(value);
  if (finite) watch_limits(source, field, physical, now);
  if (!finite) reject(fmt::format("{}.{} is not finite", source.message->name, field.signal->name));
  const std::uint32_t bit = 1U << field.joint;
  const auto keep = [&](TimedValues& values) {
    if (finite) return values.set(field.joint, value, now);
    values.forget(field.joint);
  };
  switch (field.quantity) {
    case JointQuantity::position:
      if (finite) return take_position(source, field, value, now);
      sample_.refused |= bit;
      return;
    case JointQuantity::velocity:
      return keep(velocity_);
    case JointQuantity::effort:
      return keep(effort_);
  }
}

void DbcSession::take_position(const Source& source, Field& field, double value, Timestamp now) {
  if (field.span > 0) {
    const double sent = std::exchange(field.last_sent, value);
    if (field.last) value = *field.last + step_of(value - sent, field.span);
    field.last = value;
  }
  const std::uint32_t bit = 1U << field.joint;
  if (!field.senders.take(value, now)) {
    if (trouble_.conflict_signal == field.signal) trouble_.conflict = {};
    sample_.present |= bit;
    sample_.position[field.joint] = value;
    return;
  }
  sample_.conflict |= bit;
  ++counters_.conflicts;
  trouble_.conflict_message = source.message;
  trouble_.conflict_signal = field.signal;
  trouble_.places = field.senders.places();
  trouble_.conflict = now;
}

void DbcSession::watch_limits(const Source& source, Field& field, double physical, Timestamp now) {
  const DbcSignal& signal = *field.signal;
  if (!(signal.minimum < signal.maximum)) return;
  // Limits are written in decimals: what lies within half a step of one is on it.
  const double slack =
      signal.type == DbcValueType::integer ? std::abs(signal.factor) / 2 : (signal.maximum - signal.minimum) * 1e-6;
  if (physical >= signal.minimum - slack && physical <= signal.maximum + slack) {
    field.outside = false;
    return;
  }
  ++counters_.outside;
  if (field.outside || (field.told.known() && now - field.told < kToldAgainAfter)) return;
  field.outside = true;
  field.told = now;
  output_->outside(fmt::format("{}.{} is {:.6g}{}{}, beyond {:.6g} .. {:.6g} of the DBC; it is taken as it is",
                               source.message->name, signal.name, physical, signal.unit.empty() ? "" : " ",
                               printable(signal.unit), signal.minimum, signal.maximum));
}

void DbcSession::reject(const std::string& why) {
  ++counters_.rejected;
  output_->rejected(why);
}

}  // namespace cellmirror::can
