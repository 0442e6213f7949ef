#include "drivers/can/cia402/session.hpp"

#include <fmt/format.h>

#include <utility>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/cia402/drive_objects.hpp"

namespace cellmirror::can {
namespace {

// Without SYNC for this many periods of silence a synchronous TPDO is taken as it comes.
constexpr Nanoseconds kSyncSilence{1'000'000'000};

constexpr bool is_synchronous(std::uint8_t transmission_type) { return transmission_type <= 240; }

}  // namespace

Cia402Session::Cia402Session(Cia402Plan plan, Cia402SessionOutput& output) : plan_(std::move(plan)), output_(&output) {
  CELLMIRROR_EXPECTS(plan_.nodes.size() <= kMaxJointsPerRobot);
  for (const Cia402NodePlan& node_plan : plan_.nodes) {
    Node node;
    node.plan = node_plan;
    node.status.node_id = node_plan.config.node_id;
    node.status.joint_name = node_plan.config.joint_name;
    if (node_plan.config.configure) node.steps = steps_of(plan_, node_plan);
    if (asks_lost_nodes(node) || !node.steps.empty()) {
      node.sdo.emplace(node_plan.config.node_id, plan_.config.sdo_timeout);
    }
    for (const TpdoConfig& config : node_plan.tpdos) {
      const auto field = [&config](ObjectAddress address) {
        const auto found = find_in_mapping(config.entries, address.index, address.subindex);
        return found ? Quantity{found->first_bit, found->bits} : Quantity{};
      };
      Tpdo tpdo;
      tpdo.node = nodes_.size();
      tpdo.extended = (config.cob_id & kCobIdExtended) != 0;
      tpdo.cob_id = config.cob_id & (tpdo.extended ? 0x1FFF'FFFFU : 0x7FFU);
      tpdo.number = config.number;
      tpdo.length = static_cast<std::uint8_t>(pdo_length(config.entries));
      tpdo.synchronous = is_synchronous(config.transmission_type);
      tpdo.every = config.transmission_type;
      tpdo.statusword = field(kStatusword);
      tpdo.position = field(kPositionActual);
      tpdo.velocity = field(kVelocityActual);
      tpdo.torque = field(kTorqueActual);
      tpdos_.push_back(tpdo);
      has_extended_ |= tpdo.extended;
      if (!tpdo.extended) tpdo_of_id_[tpdo.cob_id] = static_cast<std::uint16_t>(tpdos_.size());
    }
    nodes_.push_back(std::move(node));
    node_of_id_[node_plan.config.node_id] = static_cast<std::uint8_t>(nodes_.size());
  }
}

void Cia402Session::start(Timestamp now) {
  if (plan_.config.sync_period.count() > 0) next_sync_ = now + plan_.config.sync_period;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (plan_.config.heartbeat_timeout.count() > 0) {
      nodes_[i].heartbeat_deadline = now + plan_.config.heartbeat_timeout;
    }
    bring_up(i, now);
  }
}

void Cia402Session::receive(const CanFrame& frame, Timestamp now) {
  if (frame.error || frame.remote) return;
  if (frame.extended) {
    for (Tpdo& tpdo : tpdos_) {
      if (has_extended_ && tpdo.extended && tpdo.cob_id == frame.id) on_tpdo(tpdo, frame, now);
    }
    return;
  }
  if (frame.id >= 0x800) return;
  if (const std::uint16_t tpdo = tpdo_of_id_[frame.id]; tpdo != 0) {
    on_tpdo(tpdos_[tpdo - 1U], frame, now);
    return;
  }
  if (is_sync(frame)) {
    // Another node's: where this session produces SYNC itself, a second producer is none of its cycles.
    if (plan_.config.sync_period.count() == 0) on_sync(now);
    return;
  }
  const std::uint8_t node = node_of_id_[frame.id & 0x7F];
  if (node == 0) return;
  const std::size_t index = node - 1U;
  switch (frame.id & ~0x7FU) {
    case kHeartbeatBase:
      if (const auto heartbeat = decode_heartbeat(frame)) {
        on_heartbeat(index, heartbeat->state, now);
      } else {
        reject(index, fmt::format("heartbeat of {} bytes or of an unknown state", frame.length));
      }
      return;
    case kEmcyBase:
      if (const auto emcy = decode_emcy(frame)) {
        on_emcy(index, *emcy);
      } else {
        reject(index, fmt::format("EMCY of {} bytes instead of 8", frame.length));
      }
      return;
    case kSdoResponseBase:
      // Nodes that are not configured are asked while they are lost only; other answers are to other masters.
      if (nodes_[index].steps.empty() && !nodes_[index].asking) return;
      if (frame.length != 8) {
        reject(index, fmt::format("SDO answer of {} bytes instead of 8", frame.length));
        return;
      }
      if (const auto request = nodes_[index].sdo->receive(frame, now)) output_->send(*request);
      on_sdo_progress(index, now);
      return;
    default:
      return;
  }
}

void Cia402Session::on_tpdo(Tpdo& tpdo, const CanFrame& frame, Timestamp now) {
  Node& node = nodes_[tpdo.node];
  node.status.heard = true;
  if (frame.length != tpdo.length) {
    reject(tpdo.node, fmt::format("TPDO{} of {} bytes, its mapping has {}", tpdo.number, frame.length, tpdo.length));
    return;
  }
  node.status.last_tpdo = now;
  sample_.receive_time = now;
  decode(tpdo, frame);
  tpdo.expected = false;
  tpdo.syncs = 0;
  if (tpdo.synchronous) node.answering = true;
  const bool cyclic = tpdo.synchronous && in_cycle_ && now - cycle_start_ < kSyncSilence;
  if (cyclic) {
    if (!cycle_is_complete()) return;
  } else if (tpdo.position.bits == 0) {
    return;  // waits for the position, whose TPDO makes the sample
  }
  emit();
}

void Cia402Session::decode(const Tpdo& tpdo, const CanFrame& frame) {
  Node& node = nodes_[tpdo.node];
  const Cia402NodeConfig& config = node.plan.config;
  const auto raw = [&frame](const Quantity& field) {
    return static_cast<double>(sign_extended(get_bits(frame.payload(), field.first_bit, field.bits), field.bits));
  };
  if (tpdo.statusword.bits != 0) {
    node.status.statusword =
        static_cast<std::uint16_t>(get_bits(frame.payload(), tpdo.statusword.first_bit, tpdo.statusword.bits));
    node.status.state = decode_statusword(node.status.statusword);
  }
  if (tpdo.velocity.bits != 0) {
    const double scale = config.velocity_scale != 0.0 ? config.velocity_scale : config.scale;
    velocity_.set(config.joint, config.sign * raw(tpdo.velocity) * scale, sample_.receive_time);
  }
  if (tpdo.torque.bits != 0) {
    effort_.set(config.joint, config.sign * raw(tpdo.torque) * config.torque_scale, sample_.receive_time);
  }
  if (tpdo.position.bits != 0) {
    const Quantity& field = tpdo.position;
    const std::int64_t counter = sign_extended(get_bits(frame.payload(), field.first_bit, field.bits), field.bits);
    take_position(tpdo.node, config.sign * unwrapped(node, counter, field.bits) * config.scale + config.offset);
  }
}

// Takes the shorter way: no drive moves by half of its range between two frames.
double Cia402Session::unwrapped(Node& node, std::int64_t counter, std::uint8_t bits) {
  const Cia402NodeConfig& config = node.plan.config;
  constexpr std::uint8_t kMostBits = 62;
  const bool has_range = config.range_lower < config.range_upper;
  if (!config.turns || (!has_range && bits > kMostBits)) return static_cast<double>(counter);
  const std::int64_t span = has_range ? config.range_upper - config.range_lower + 1 : std::int64_t{1} << bits;
  if (!node.counter) {
    node.turned = counter;
  } else {
    std::int64_t step = (counter - *node.counter) % span;
    if (step > span / 2) step -= span;
    if (step < -(span / 2)) step += span;
    node.turned += step;
  }
  node.counter = counter;
  return static_cast<double>(node.turned);
}

void Cia402Session::take_position(std::size_t index, double position) {
  Node& node = nodes_[index];
  const std::size_t joint = node.plan.config.joint;
  const std::uint32_t bit = 1U << joint;
  const Timestamp now = sample_.receive_time;
  const bool before = node.status.in_conflict;
  node.status.in_conflict = node.senders.take(position, now);
  if (!node.status.in_conflict) {
    sample_.present |= bit;
    sample_.position[joint] = position;
    return;
  }
  sample_.conflict |= bit;
  ++node.status.conflicts;
  node.status.last_conflict = now;
  node.status.places = node.senders.places();
  if (!before) report(Cia402EventKind::second_drive, index, conflict_text(node.status));
}

bool Cia402Session::cycle_is_complete() const {
  for (const Tpdo& tpdo : tpdos_) {
    if (tpdo.expected) return false;
  }
  return true;
}

void Cia402Session::emit() {
  if ((sample_.present | sample_.conflict) == 0) return;
  sample_.velocity = velocity_.at(sample_.receive_time, plan_.config.ages.lost_after);
  sample_.effort = effort_.at(sample_.receive_time, plan_.config.ages.lost_after);
  sample_.sequence = ++counters_.samples;
  output_->sample(sample_);
  sample_.present = 0;
  sample_.conflict = 0;
}

void Cia402Session::on_sync(Timestamp now) {
  ++counters_.syncs;
  if (in_cycle_) {
    count_missing();
    emit();  // what came of an incomplete cycle
  }
  in_cycle_ = true;
  cycle_start_ = now;
  for (Tpdo& tpdo : tpdos_) {
    const Node& node = nodes_[tpdo.node];
    const bool sleeping = node.status.nmt && *node.status.nmt != NmtState::operational;
    const bool due = tpdo.synchronous && tpdo.every > 0 && ++tpdo.syncs >= tpdo.every;
    tpdo.expected = due && node.answering && !node.status.heartbeat_lost && !sleeping;
  }
}

void Cia402Session::count_missing() {
  for (Tpdo& tpdo : tpdos_) {
    if (!tpdo.expected) continue;
    ++counters_.lost;
    report(Cia402EventKind::tpdo_missing, tpdo.node, fmt::format("TPDO{} did not follow a SYNC", tpdo.number));
  }
}

void Cia402Session::produce_sync(Timestamp now) {
  const Nanoseconds period = plan_.config.sync_period;
  if (output_->send(encode_sync())) {
    on_sync(now);
  } else {
    ++counters_.syncs_missed;
    // Nobody was asked, so nobody fails to answer.
    for (Tpdo& tpdo : tpdos_) tpdo.expected = false;
    emit();
    in_cycle_ = false;
  }
  next_sync_ = next_sync_ + period;
  if (next_sync_ <= now) {
    const std::int64_t late = (now - next_sync_) / period + 1;
    counters_.syncs_missed += static_cast<std::uint64_t>(late);
    next_sync_ = next_sync_ + late * period;  // the phase stays
  }
}

void Cia402Session::advance(Timestamp now) {
  if (next_sync_.known() && now >= next_sync_) produce_sync(now);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    watch(i, now);
    Node& node = nodes_[i];
    if (!node.sdo) continue;
    if (const auto abort = node.sdo->advance(now)) {
      output_->send(*abort);
      on_sdo_progress(i, now);
    }
    if (node.retry.known() && now >= node.retry) bring_up(i, now);
    if (node.ask.known() && now >= node.ask) ask(i, now);
  }
}

Timestamp Cia402Session::next_due() const {
  Timestamp due = next_sync_;
  const auto take = [&due](Timestamp candidate) {
    if (candidate.known() && (!due.known() || candidate < due)) due = candidate;
  };
  for (const Node& node : nodes_) {
    take(node.heartbeat_deadline);
    take(node.retry);
    take(node.ask);
    if (node.sdo) take(node.sdo->due());
  }
  return due;
}

void Cia402Session::reject(std::size_t node, std::string why) {
  ++counters_.rejected;
  report(Cia402EventKind::rejected, node, std::move(why));
}

void Cia402Session::report(Cia402EventKind kind, std::size_t node, std::string what) {
  const Cia402NodeStatus& status = nodes_[node].status;
  output_->event({kind, node, fmt::format("node {} ({}): {}", status.node_id, status.joint_name, what)});
}

std::vector<Cia402NodeStatus> Cia402Session::nodes() const {
  std::vector<Cia402NodeStatus> result;
  copy_nodes(result);
  return result;
}

void Cia402Session::copy_nodes(std::vector<Cia402NodeStatus>& out) const {
  out.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) out[i] = nodes_[i].status;
}

}  // namespace cellmirror::can
