// What a World publishes.
#include <algorithm>

#include "rt_core/tissue/world_parts.hpp"

namespace cellmirror::tissue {

namespace {

constexpr double kMlPerM3 = 1e6;

}  // namespace

void World::describe(TissueState& state) const {
  const Parts& parts = *parts_;
  state.step = parts.step;
  state.time = parts.time;
  state.calculating = parts.calculating;
  state.objects.resize(parts.objects.size());
  for (std::size_t i = 0; i < parts.objects.size(); ++i) {
    const DeformableObject& object = parts.objects[i];
    TissueObjectState& out = state.objects[i];
    out = TissueObjectState();
    if (object.body) object.body->describe(out);
    out.name = object.description.name;
    out.contacts = object.contacts;
    out.substeps = object.substeps;
    if (object.frozen) {
      out.attributes = static_cast<std::uint16_t>(out.attributes & ~static_cast<unsigned>(TissueAttribute::calculate));
    }
  }
  state.instruments.clear();
  for (std::size_t i = 0, response = 0; i < parts.instruments.size(); ++i) {
    const Instrument& one = parts.instruments[i];
    if (!one.tracked || response >= parts.responses.size()) continue;
    const InstrumentResponse& felt = parts.responses[response++];
    TissueInstrumentState out;
    out.slot = static_cast<std::int16_t>(one.slot);
    out.kind = one.action.kind;
    out.acting = one.acting;
    out.contacts = felt.contacts;
    out.held = felt.held;
    out.force_W = felt.force_W;
    out.torque_W = felt.torque_W;
    state.instruments.push_back(out);
  }
  parts.vessels.describe(parts.objects, state.vessels);
  parts.log.last(state.events);
  state.event_counts = parts.log.counts();
  state.excesses = parts.limits.excesses();
  state.effects = parts.surroundings.effects;
  state.bleeding_ml_min = 0;
  for (const TissueVesselState& vessel : state.vessels) state.bleeding_ml_min += vessel.bleeding_ml_min;
  state.blood_loss_ml = parts.surroundings.blood_loss_m3 * kMlPerM3;
  state.smoke = parts.surroundings.smoke;
  state.lens_fog = parts.surroundings.lens_fog;
  state.pool_present = parts.pool.present();
  state.pool_level_m = parts.pool.rise();
  state.pool_blood = parts.pool.blood();
  state.connections = parts.connections.count();
  state.connections_torn = parts.connections.torn();
}

void World::view(TissueView& view, bool network) const {
  const Parts& parts = *parts_;
  view.step = parts.step;
  const auto bodies = static_cast<std::size_t>(
      std::ranges::count_if(parts.objects, [](const DeformableObject& one) { return one.body != nullptr; }));
  view.surfaces.resize(bodies);
  std::size_t next = 0;
  view.network = TissueNetwork();
  std::vector<std::uint32_t> first_node(parts.objects.size(), 0);
  for (std::size_t i = 0; i < parts.objects.size(); ++i) {
    const DeformableObject& object = parts.objects[i];
    if (!object.body) continue;
    TissueSurface& surface = view.surfaces[next++];
    object.body->fill(surface);
    surface.name = object.description.name;
    surface.look = object.description.look;
    surface.visible = object.has(TissueAttribute::visible);
    surface.wet = object.has(TissueAttribute::wet);
    first_node[i] = static_cast<std::uint32_t>(view.network.nodes.size());
    if (network) object.body->network(view.network);
  }
  if (network) {
    for (const Contact& contact : parts.contacts) {
      if (!(contact.impulse > 0)) continue;
      const DeformableObject& object = parts.objects[contact.key.object];
      for (std::size_t i = 0; i < 3; ++i) {
        if (contact.point.share[static_cast<int>(i)] == 0) continue;
        for (std::size_t k = 0; k < 4; ++k) {
          const std::size_t node = first_node[contact.key.object] + contact.point.embedded[i].node[k];
          if (contact.point.embedded[i].weight[k] == 0 || node >= view.network.kinds.size()) continue;
          if (view.network.kinds[node] != TissueNodeKind::fixed) view.network.kinds[node] = TissueNodeKind::contact;
        }
      }
      const Eigen::Vector3d force = (contact.impulse * contact.normal + contact.tangential) / kStep_s;
      view.network.forces.push_back({position(object, contact.point).cast<float>(), force.cast<float>()});
    }
  }
  parts.particles.view(view.particles);
  parts.clips.view(parts.objects, view.clips);
  parts.pool.view(view.pool);
  view.smoke = parts.surroundings.smoke;
  view.lens_fog = parts.surroundings.lens_fog;
}

}  // namespace cellmirror::tissue
