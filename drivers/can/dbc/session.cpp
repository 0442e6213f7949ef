#include "drivers/can/dbc/session.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "drivers/can/dbc/unit.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

constexpr Nanoseconds kToldAgainAfter = std::chrono::seconds(10);

class Planner {
 public:
  Planner(const DbcStreamConfig& config, Dbc dbc, Diagnostics& diagnostics) : diagnostics_(&diagnostics) {
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
    if (!has_position) error(stream, "none of the signals is a position: nothing would be mirrored");
    if (diagnostics_->errors() != before) return {};
    return std::move(plan_);
  }

 private:
  void error(const Place& place, std::string message, std::string remedy = {}) {
    diagnostics_->error(place, std::move(message), std::move(remedy));
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
    if (message == nullptr) {
      error(config.message_place, fmt::format("the DBC has no message {}", printable(config.message)),
            nearest_message(config.message));
      return;
    }
    const DbcSignal* signal = message->find(config.signal);
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

}  // namespace

std::optional<DbcPlan> plan_dbc(const DbcStreamConfig& config, Dbc dbc, Diagnostics& diagnostics) {
  return Planner(config, std::move(dbc), diagnostics).plan();
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
        {&message.signals[mapped.signal], config.joint, config.quantity, config.scale, config.offset, false, {}});
  }
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
  for (Field& field : source.fields) take(source, field, frame, now);
  if ((sample_.present | sample_.refused) == 0) return;
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
      (finite ? sample_.present : sample_.refused) |= bit;
      if (finite) sample_.position[field.joint] = value;
      return;
    case JointQuantity::velocity:
      return keep(velocity_);
    case JointQuantity::effort:
      return keep(effort_);
  }
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
