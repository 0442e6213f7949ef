#include "rt_core/tissue/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "rt_core/tissue/instruments/grip.hpp"
#include "rt_core/tissue/world_parts.hpp"

namespace cellmirror::tissue {

namespace {

constexpr std::uint32_t kMostWorldSubsteps = 8;

Result<DeformableObject> make_object(ObjectDescription description) {
  DeformableObject object;
  const bool only_pool =
      description.surface.triangles.empty() && description.volume.tetrahedra.empty() && !description.pools.empty();
  if (!only_pool) {
    Result<Body> body = Body::make(description);
    if (!body) return std::unexpected(body.error());
    object.body = std::make_unique<Body>(*std::move(body));
    object.body->set_attributes(description.attributes);
    object.surface.rebuild(*object.body);
    const auto points = object.body->surface_points();
    const auto positions = object.body->surface_positions();
    object.start_points.assign(points.begin(), points.end());
    object.start_positions.assign(positions.begin(), positions.end());
    TissueObjectState state;
    object.body->describe(state);
    // Powers of two, so that objects of different rates meet.
    while (object.substeps < state.substeps && object.substeps < kMostWorldSubsteps) object.substeps *= 2;
  }
  object.description = std::move(description);
  return object;
}

Result<void> check_connections(std::span<const DeformableObject> objects, std::span<const Connection> connections) {
  if (connections.size() > Connections::kMostConnections) {
    return fail(fmt::format("{} connections between deformable objects; at most {} are possible", connections.size(),
                            Connections::kMostConnections),
                "join neighbouring ones to one with a radius");
  }
  for (const Connection& connection : connections) {
    for (const std::string* name : {&connection.object_a, &connection.object_b}) {
      if (name->empty() && name == &connection.object_b) continue;  // the world
      const std::uint32_t at = object_named(objects, *name);
      if (at < objects.size() && objects[at].body) continue;
      return fail(fmt::format("connection \"{}\" names the object \"{}\", which the cell does not have",
                              connection.name, *name),
                  "name an object of the cell, or none for the world");
    }
  }
  return {};
}

}  // namespace

World::World(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

Result<World> World::make(std::vector<ObjectDescription> objects, std::vector<Connection> connections) {
  auto parts = std::make_unique<Parts>();
  for (ObjectDescription& description : objects) {
    if (!description.pools.empty() && !parts->pool.present()) {
      parts->pool = Pool(description.pools.front(), description.X_WO);
    }
    Result<DeformableObject> object = make_object(std::move(description));
    if (!object) return std::unexpected(object.error());
    parts->objects.push_back(*std::move(object));
    parts->vessels.add_object(parts->objects.back(), static_cast<std::uint32_t>(parts->objects.size() - 1));
  }
  if (const Result<void> checked = check_connections(parts->objects, connections); !checked) {
    return std::unexpected(checked.error());
  }
  parts->connections.set(std::move(connections), parts->objects);
  return World(std::move(parts));
}

std::size_t World::object_count() const { return parts_->objects.size(); }
std::span<const InstrumentResponse> World::responses() const { return parts_->responses; }
std::span<const TissueEvent> World::events() const { return parts_->log.of_step(); }

Instrument* WorldParts::instrument(int slot) {
  if (slot < 0 || slot >= kMostInstrumentSlots) return nullptr;
  const auto at = std::ranges::find(instruments, slot, &Instrument::slot);
  if (at != instruments.end()) return &*at;
  if (instruments.size() >= kMostInstruments) return nullptr;
  instruments.emplace_back().slot = slot;
  estimates.emplace_back();
  return &instruments.back();
}

void WorldParts::reset() {
  for (DeformableObject& object : objects) {
    object.frozen = false;
    object.contacts = 0;
    if (!object.body) continue;
    object.body->reset();
    object.surface.rebuild(*object.body);
  }
  connections.reset();
  vessels.reset();
  clips.reset();
  connections.follow_cuts(objects);
  vessels.follow_cuts(objects);
  pool.reset();
  particles.reset();
  surroundings.reset();
  for (Instrument& one : instruments) one.reset();
  for (ResponseEstimate& one : estimates) one.reset();
  responses.clear();
  rigid_contacts.reset();
  tissue_contacts.reset();
  memory.clear();
  contacts.clear();
  steps_of_model = 0;
}

namespace {

void follow(WorldParts& parts, const SetCalculation& command) { parts.calculating = command.on; }
void follow(WorldParts& parts, const ResetModel&) { parts.reset(); }
void follow(WorldParts& parts, const SetAttributes& command) {
  for (std::size_t i = 0; i < parts.objects.size(); ++i) {
    DeformableObject& object = parts.objects[i];
    if (!object.body || (command.object >= 0 && static_cast<std::size_t>(command.object) != i)) continue;
    const unsigned kept = static_cast<unsigned>(object.body->attributes()) & ~static_cast<unsigned>(command.mask);
    const unsigned wanted = kept | (static_cast<unsigned>(command.values) & command.mask);
    object.body->set_attributes(static_cast<std::uint16_t>(wanted & kAllTissueAttributes));
    if (has(command.mask, TissueAttribute::calculate) && has(command.values, TissueAttribute::calculate)) {
      object.frozen = false;
    }
  }
}
void follow(WorldParts& parts, const SetConnections& command) {
  parts.connections.set(command.connections, parts.objects);
}
void follow(WorldParts& parts, const SetLimit& command) {
  parts.limits.set(command.limit, command.actions, command.value);
}
void follow(WorldParts& parts, const SetEffect& command) {
  Surroundings& around = parts.surroundings;
  around.effects[static_cast<std::size_t>(command.effect)] = command.on;
  if (command.effect == TissueEffect::suction) around.suction = command.on ? command.instrument : -1;
  if (command.effect == TissueEffect::irrigation) around.irrigation = command.on ? command.instrument : -1;
  if (command.effect == TissueEffect::pool_ripples && !command.on) parts.pool.flatten();
}
void follow(WorldParts& parts, const ResetPool&) { parts.pool.reset(); }
void follow(WorldParts& parts, const CleanLens&) { parts.surroundings.lens_fog = 0; }
void follow(WorldParts& parts, const SetInstrumentAction& command) {
  Instrument* instrument = parts.instrument(command.instrument);
  if (instrument == nullptr) return;
  release_grip(*instrument, parts.log);
  instrument->set_action(command.action);
}
void follow(WorldParts& parts, const SetInstrumentShape& command) {
  if (Instrument* instrument = parts.instrument(command.instrument)) instrument->set_shape(command.shape);
}
void follow(WorldParts& parts, const SetClip& command) {
  if (Instrument* instrument = parts.instrument(command.instrument)) instrument->set_clip(command.clip);
}

}  // namespace

void World::apply(const Command& command) {
  std::visit([this](const auto& one) { follow(*parts_, one); }, command);
}

void World::step(const StepInput& input) {
  Parts& parts = *parts_;
  ++parts.step;
  parts.time = input.time;
  parts.log.begin_step(input.time, parts.step);
  parts.move_instruments(input.instruments);
  if (!parts.calculating) {
    // Whatever is held stays held; nothing is felt.
    parts.contacts.clear();
    parts.memory.clear();
    for (Instrument& one : parts.instruments) one.effective = false;
    parts.make_responses();
    parts.log.end_step();
    return;
  }
  ++parts.steps_of_model;
  parts.search(input.bodies);
  parts.solve_step();
  parts.apply_limits();
  parts.use_tools();
  parts.let_flow();
  parts.make_responses();
  parts.log.end_step();
}

}  // namespace cellmirror::tissue
