#include "drivers/can/dbc/session.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

class Planner {
 public:
  Planner(const DbcStreamConfig& config, Dbc dbc, Diagnostics& diagnostics) : diagnostics_(&diagnostics) {
    plan_.config = config;
    plan_.dbc = std::move(dbc);
  }

  std::optional<DbcPlan> plan() {
    const std::size_t before = diagnostics_->errors();
    if (plan_.config.signals.empty()) error("a DBC stream needs at least one signal");
    bool has_position = plan_.config.signals.empty();
    for (const DbcSignalConfig& signal : plan_.config.signals) {
      has_position |= signal.quantity == JointQuantity::position;
      add(signal);
    }
    if (!has_position) error("none of the signals is a position: nothing would be mirrored");
    if (diagnostics_->errors() != before) return {};
    return std::move(plan_);
  }

 private:
  void error(std::string message, std::string remedy = {}) {
    diagnostics_->error({plan_.config.dbc_file, 0, 0}, std::move(message), std::move(remedy));
  }

  void add(const DbcSignalConfig& config) {
    if (config.joint >= kMaxJointsPerRobot) {
      error(fmt::format("joint {} is beyond {} joints", config.joint, kMaxJointsPerRobot));
      return;
    }
    if (!std::isfinite(config.scale) || config.scale == 0.0 || !std::isfinite(config.offset)) {
      error(fmt::format("signal {}: the scale has to be finite and not 0, the offset finite", config.signal));
      return;
    }
    const DbcMessage* message = plan_.dbc.find(config.message);
    if (message == nullptr) {
      error(fmt::format("the DBC has no message {}", printable(config.message)), nearest_message(config.message));
      return;
    }
    const DbcSignal* signal = message->find(config.signal);
    if (signal == nullptr) {
      error(fmt::format("the message {} has no signal {}", config.message, printable(config.signal)),
            nearest_signal(*message, config.signal));
      return;
    }
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
        {&message.signals[mapped.signal], config.joint, config.quantity, config.scale, config.offset});
  }
}

void DbcSession::receive(const CanFrame& frame, Timestamp now) {
  if (frame.error || frame.remote) return;
  const auto found = sources_.find({frame.extended, frame.id});
  if (found == sources_.end()) return;
  const Source& source = found->second;
  if (frame.length < source.message->length) {
    reject(fmt::format("{}: {} bytes, the DBC says {}", source.message->name, frame.length, source.message->length));
    return;
  }
  sample_.present = 0;
  sample_.refused = 0;
  for (const Field& field : source.fields) take(source, field, frame, now);
  if ((sample_.present | sample_.refused) == 0) return;
  sample_.velocity = velocity_.at(now, plan_.config.ages.lost_after);
  sample_.effort = effort_.at(now, plan_.config.ages.lost_after);
  sample_.receive_time = now;
  sample_.sequence = ++counters_.samples;
  output_->sample(sample_);
}

void DbcSession::take(const Source& source, const Field& field, const CanFrame& frame, Timestamp now) {
  if (!is_present(*source.message, *field.signal, frame.payload())) return;
  const double value = physical_value(*field.signal, frame.payload()) * field.scale + field.offset;
  const bool finite = std::isfinite(value);
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

void DbcSession::reject(const std::string& why) {
  ++counters_.rejected;
  output_->rejected(why);
}

}  // namespace cellmirror::can
