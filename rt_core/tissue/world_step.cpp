// A step of the world: contacts and constraints between bodies, instruments and surroundings.
#include <algorithm>
#include <cmath>
#include <utility>

#include "rt_core/tissue/instruments/grip.hpp"
#include "rt_core/tissue/world_parts.hpp"

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kSweeps = 8;            // of the solver
constexpr double kAllowedOverlap = 5e-5;        // m: contacts rest in it, so that they do not come and go
constexpr double kUndonePart = 0.2;             // of an overlap, in a step
constexpr double kFastestUndoing = 0.1;         // m/s
constexpr double kFastestUndoingOfLimit = 1.0;  // m/s, of what is beyond the limit of penetration
constexpr double kFixedStiffness = 800.0;       // N/m, of tissue whose nodes are all fixed

}  // namespace

void WorldParts::move_instruments(std::span<const InstrumentPose> poses) {
  for (Instrument& one : instruments) {
    one.force.setZero();
    one.pull.setZero();
    one.torque.setZero();
    one.directions.setZero();
    one.contacts = 0;
    one.depth = 0;
    if (std::ranges::find(poses, one.slot, &InstrumentPose::slot) == poses.end()) one.absent();
  }
  std::array<int, kMostInstruments> seen{};
  std::size_t count = 0;
  for (const InstrumentPose& pose : poses) {
    Instrument* one = instrument(pose.slot);
    if (one == nullptr || count == seen.size()) continue;
    if (std::find(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(count), pose.slot) !=
        seen.begin() + static_cast<std::ptrdiff_t>(count)) {
      continue;  // one pose a slot
    }
    seen.at(count++) = pose.slot;
    if (!one->move_to(pose, limits, log).has(TissueLimitAction::freeze)) continue;
    for (const Contact& contact : contacts) {  // of the last step
      if (contact.instrument == one - instruments.data() && contact.impulse > 0) freeze(objects[contact.key.object]);
    }
  }
}

// Speed of the fastest node. The last resort: a body whose numbers are no longer finite goes back to its shape at the
// start.
void WorldParts::measure_speed(DeformableObject& object) {
  double sum = 0;
  double largest = 0;
  for (const Vector3d& v : object.body->velocities()) {
    const double squared = v.squaredNorm();
    sum += squared;
    largest = std::max(largest, squared);
  }
  object.speed = std::sqrt(largest);
  if (std::isfinite(sum)) return;
  const auto number = static_cast<std::uint32_t>(&object - objects.data());
  object.body->reset();
  object.surface.rebuild(*object.body);
  object.speed = 0;
  memory.clear();
  for (Instrument& one : instruments) {
    std::erase_if(one.held, [&](const HeldPoint& held) { return held.point.object == number; });
  }
  connections.forget_impulses();
  clips.forget_impulses();
  limits.count(TissueLimit::node_speed);
  log.add_limit(TissueLimit::node_speed, {.object = static_cast<int>(number)},
                0.5 * (object.surface.low() + object.surface.high()), 0.0);
}

void WorldParts::search(std::span<const RigidBodyPose> bodies) {
  contacts.clear();
  for (DeformableObject& object : objects) {
    if (!object.body) continue;
    measure_speed(object);
    object.surface.advance(*object.body, object.speed * kStep_s);
  }
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    update_grip(instruments[i], objects, instrument_contacts, log);
    if (!instruments[i].effective) continue;
    instrument_contacts.search(instruments[i], static_cast<int>(i), objects, memory, contacts);
  }
  rigid_contacts.search(bodies, objects, memory, contacts);
  tissue_contacts.search(objects, memory, contacts);
}

void WorldParts::begin_bodies(std::uint32_t substep, std::uint32_t substeps) {
  const double time_s = static_cast<double>(steps_of_model) * kStep_s;
  for (std::uint32_t number = 0; number < objects.size(); ++number) {
    DeformableObject& object = objects[number];
    object.steps_now = object.calculates() && substep % (substeps / object.substeps) == 0;
    if (!object.steps_now) continue;
    if (surroundings.on(TissueEffect::pulse)) vessels.add_pulse(objects, number, time_s);
    object.body->begin_step(kStep_s / object.substeps, kGravity);
  }
}

void WorldParts::solve_step() {
  std::uint32_t substeps = 1;
  for (const DeformableObject& object : objects) {
    if (object.calculates()) substeps = std::max(substeps, object.substeps);
  }
  start_.clear();
  start_along_.clear();
  for (Contact& contact : contacts) {
    start_.push_back(contact.impulse);
    start_along_.push_back(contact.tangential);
    contact.impulse = 0;
    contact.tangential.setZero();
  }
  for (std::uint32_t substep = 0; substep < substeps; ++substep) {
    begin_bodies(substep, substeps);
    double dt = kStep_s;
    for (const DeformableObject& object : objects) {
      if (object.steps_now) dt = std::min(dt, kStep_s / object.substeps);
    }
    system.clear();
    add_contacts(kStep_s * substep / substeps);
    for (Instrument& one : instruments) add_grip(system, one, objects, limits);
    connections.add(system, objects, dt);
    clips.add(system, objects, dt);
    if (!system.empty()) {
      system.solve(kSweeps);
      take_contacts();
      for (Instrument& one : instruments) take_grip(system, one, objects);
      connections.take(system, objects, dt, log);
      clips.take(system);
      apply_velocities();
    }
    for (DeformableObject& object : objects) {
      if (!object.steps_now) continue;
      if (limits.clamps(TissueLimit::node_speed)) {
        object.too_fast = object.body->limit_speed(limits.value(TissueLimit::node_speed)) > 0 || object.too_fast;
      }
      object.body->end_step(kStep_s / object.substeps);
    }
  }
  memory.remember(contacts);
  for (DeformableObject& object : objects) object.contacts = 0;
  for (const Contact& contact : contacts) {
    if (contact.impulse > 0) ++objects[contact.key.object].contacts;
  }
}

void WorldParts::add_contacts(double elapsed_s) {
  rows_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const DeformableObject& object = objects[contact.key.object];
    const bool tissue = contact.key.other == ContactKey::Other::tissue;
    const DeformableObject& other = objects[tissue ? contact.other.object : contact.key.object];
    if (elapsed_s > 0 && !object.steps_now && !other.steps_now) continue;
    double gap = contact.gap;
    if (elapsed_s > 0) {
      const Vector3d on_other =
          tissue ? position(other, contact.other) : Vector3d(contact.anchor + elapsed_s * contact.velocity);
      gap = contact.normal.dot(position(object, contact.point) - on_other);
    }
    const double dt = kStep_s / (object.steps_now ? object.substeps : other.substeps);
    ConstraintSystem::Push push;
    push.normal = contact.normal;
    push.velocity = contact.velocity;
    push.friction = contact.friction;
    push.bias =
        gap > 0 ? -gap / dt : std::min(kUndonePart * std::max(-gap - kAllowedOverlap, 0.0) / kStep_s, kFastestUndoing);
    if (contact.instrument >= 0) {
      if (limits.clamps(TissueLimit::contact_force)) push.most = limits.value(TissueLimit::contact_force) * dt;
      const double beyond = -gap - limits.value(TissueLimit::penetration);
      if (limits.clamps(TissueLimit::penetration) && beyond > 0) {
        push.bias = std::max(push.bias, std::min(beyond / dt, kFastestUndoingOfLimit));
      }
    }
    push.impulse = start_[i] * dt / kStep_s;
    push.tangential = start_along_[i] * (dt / kStep_s);
    add_terms(system, object, contact.point, 1.0);
    if (tissue) add_terms(system, other, contact.other, -1.0);
    rows_.push_back({i, system.add(push), dt, gap});
  }
}

void WorldParts::take_contacts() {
  for (const Row& row : rows_) {
    Contact& contact = contacts[row.contact];
    const ConstraintSystem::Push& push = system.push(row.push);
    const Vector3d tangential = push.tangential;
    contact.impulse += push.impulse;
    contact.tangential += tangential;
    start_[row.contact] = push.impulse * kStep_s / row.dt;
    start_along_[row.contact] = tangential * (kStep_s / row.dt);
    if (contact.instrument < 0) continue;
    Instrument& one = instruments[static_cast<std::size_t>(contact.instrument)];
    double normal_force = push.impulse / kStep_s;
    // Nothing there can move: the instrument feels a stiff spring.
    if (!system.movable(row.push) && row.gap < 0) normal_force = -kFixedStiffness * row.gap * row.dt / kStep_s;
    const Vector3d force = -normal_force * contact.normal - tangential / kStep_s;
    one.force += force;
    one.torque += (contact.anchor - one.X_start.translation()).cross(force);
    one.directions += normal_force * contact.normal * contact.normal.transpose();
    one.depth = std::max(one.depth, -row.gap);
    if (normal_force > 0) ++one.contacts;
  }
}

void WorldParts::apply_velocities() {
  for (std::size_t i = 0; i < system.nodes().size(); ++i) {
    const ConstraintSystem::Node& node = system.nodes()[i];
    DeformableObject& object = objects[node.object];
    if (object.steps_now) {
      object.body->add_velocity(node.index, system.velocity(i) - node.before);
    } else if (object.calculates()) {
      // It seemed immovable in this substep; momentum is kept all the same.
      object.body->add_velocity(node.index, object.body->inverse_masses()[node.index] * node.impulse);
    }
  }
}

void WorldParts::freeze(DeformableObject& object) {
  if (!object.body || object.frozen) return;
  object.frozen = true;
  const auto velocities = object.body->velocities();
  for (std::uint32_t i = 0; i < velocities.size(); ++i) object.body->add_velocity(i, -Vector3d(velocities[i]));
}

// What a limit asks for beyond the clamping of its value. `instrument`: place, or -1: all that touch or hold the
// object.
void WorldParts::follow_limit(LimitActions actions, int instrument, int object) {
  if (!actions.any()) return;
  if (actions.has(TissueLimitAction::freeze) && object >= 0) freeze(objects[static_cast<std::size_t>(object)]);
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    Instrument& one = instruments[i];
    const auto concerns = [&](std::uint32_t number) {
      return object < 0 || number == static_cast<std::uint32_t>(object);
    };
    const bool holds =
        std::ranges::any_of(one.held, [&](const HeldPoint& held) { return concerns(held.point.object); });
    const bool touches = std::ranges::any_of(contacts, [&](const Contact& contact) {
      return contact.instrument == static_cast<int>(i) && contact.impulse > 0 && concerns(contact.key.object);
    });
    if (instrument >= 0 ? instrument != static_cast<int>(i) : !(holds || touches)) continue;
    if (actions.has(TissueLimitAction::discard)) one.discard_next = true;
    if (actions.has(TissueLimitAction::release)) one.release_requested = true;
  }
}

void WorldParts::apply_limits() {
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    Instrument& one = instruments[i];
    int object = one.held.empty() ? -1 : static_cast<int>(one.held.front().point.object);
    double hardest = 0;
    for (const Contact& contact : contacts) {
      if (contact.instrument != static_cast<int>(i) || contact.impulse <= hardest) continue;
      hardest = contact.impulse;
      object = static_cast<int>(contact.key.object);
    }
    const EventLog::Source source{.instrument = one.slot, .object = object};
    const int place = static_cast<int>(i);
    const Vector3d tip = one.X_end.translation();
    follow_limit(limits.examine(TissueLimit::penetration, one.depth, log, source, tip), place, object);
    follow_limit(limits.examine(TissueLimit::contact_force, one.force.norm(), log, source, tip), place, object);
    follow_limit(finish_grip(one, objects, limits, log), place, object);
  }
  for (std::size_t i = 0; i < objects.size(); ++i) {
    DeformableObject& object = objects[i];
    if (!object.calculates()) continue;
    const EventLog::Source source{.object = static_cast<int>(i)};
    const Vector3d centre = 0.5 * (object.surface.low() + object.surface.high());
    if (limits.on(TissueLimit::node_speed)) {
      // What was clamped is just at the limit.
      const double speed =
          object.too_fast ? limits.value(TissueLimit::node_speed) * (1 + 1e-9) : object.body->largest_speed();
      follow_limit(limits.examine(TissueLimit::node_speed, speed, log, source, centre), -1, static_cast<int>(i));
      object.too_fast = false;
    }
    if (limits.on(TissueLimit::strain)) {
      const LimitActions asked =
          limits.examine(TissueLimit::strain, object.body->largest_strain(), log, source, centre);
      if (asked.has(TissueLimitAction::clamp)) {
        // Slows what stretches it further.
        const auto velocities = object.body->velocities();
        for (std::uint32_t n = 0; n < velocities.size(); ++n)
          object.body->add_velocity(n, -0.5 * Vector3d(velocities[n]));
      }
      follow_limit(asked, -1, static_cast<int>(i));
    }
  }
}

void WorldParts::use_tools() {
  ToolSite site{.objects = objects,
                .vessels = vessels,
                .clips = clips,
                .finder = instrument_contacts,
                .surroundings = surroundings,
                .particles = particles,
                .pool = pool,
                .log = log,
                .step = steps_of_model};
  for (Instrument& one : instruments) use_tool(one, site);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].has(TissueAttribute::tear) || !objects[i].calculates()) continue;
    constexpr std::uint32_t kMostTears = 4;  // links in a step
    const CutResult torn = objects[i].body->tear(kMostTears);
    if (torn.links > 0) {
      log.add(TissueEventKind::tear, {.object = static_cast<int>(i)}, torn.at, torn.area_m2);
    }
  }
  after_cuts();
}

void WorldParts::after_cuts() {
  bool cut = false;
  for (DeformableObject& object : objects) {
    if (!object.body || object.body->revision() == object.surface.revision()) continue;
    object.surface.rebuild(*object.body);
    cut = true;
  }
  if (cut) {
    memory.clear();
    for (Instrument& one : instruments) attach_grip_again(one, objects);
    clips.follow_cuts(objects);
    connections.follow_cuts(objects);
    vessels.follow_cuts(objects);
  }
  constexpr std::uint64_t kStepsBetweenChecks = 32;
  if (steps_of_model % kStepsBetweenChecks == 0) vessels.sever_stretched(objects, log);
}

void WorldParts::let_flow() {
  constexpr std::uint64_t kStepsOfPool = 4;
  const double time_s = static_cast<double>(steps_of_model) * kStep_s;
  vessels.bleed(objects, time_s, surroundings.on(TissueEffect::pulse), surroundings.on(TissueEffect::bleeding), log);
  for (const Vessels::Source& source : vessels.sources()) {
    const double volume = source.ml_min * 1e-6 / 60.0 * kStep_s;
    surroundings.blood_loss_m3 += volume;
    const double speed = source.jet ? 0.6 : 0.1;  // m/s
    particles.pour(ParticleKind::blood, volume, source.at, speed * source.direction, pool);
  }
  ToolSite site{.objects = objects,
                .vessels = vessels,
                .clips = clips,
                .finder = instrument_contacts,
                .surroundings = surroundings,
                .particles = particles,
                .pool = pool,
                .log = log,
                .step = steps_of_model};
  for (const Instrument& one : instruments) {
    if (one.tracked) use_fluids(one, site);
  }
  particles.step(kStep_s, kGravity, pool, surroundings.on(TissueEffect::pool_ripples));
  if (surroundings.on(TissueEffect::pool_ripples) && steps_of_model % kStepsOfPool == 0) {
    pool.step(static_cast<double>(kStepsOfPool) * kStep_s);
  }
  surroundings.step(kStep_s);
}

void WorldParts::make_responses() {
  responses.clear();
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    const Instrument& one = instruments[i];
    if (!one.tracked) {
      estimates[i].reset();
      continue;
    }
    int object = one.held.empty() ? -1 : static_cast<int>(one.held.front().point.object);
    for (const Contact& contact : contacts) {
      if (object < 0 && contact.instrument == static_cast<int>(i)) object = static_cast<int>(contact.key.object);
    }
    double modulus = 0;
    if (object >= 0) {
      const Material& material = objects[static_cast<std::size_t>(object)].description.material;
      modulus = material.youngs_modulus_pa / (1.0 - material.poissons_ratio * material.poissons_ratio);
    }
    const double most = limits.clamps(TissueLimit::contact_force) ? limits.value(TissueLimit::contact_force) : 0.0;
    responses.push_back(estimates[i].update(one, modulus, most));
  }
}

}  // namespace cellmirror::tissue
