#include "rt_core/tissue/body/body.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "rt_core/tissue/body/body_check.hpp"
#include "rt_core/tissue/body/body_parts.hpp"
#include "rt_core/tissue/body/lattice.hpp"
#include "rt_core/tissue/description/step.hpp"

namespace cellmirror::tissue {
namespace {

ObjectDescription in_world(const ObjectDescription& d) {
  ObjectDescription world = d;
  const Pose& X = d.X_WO;
  for (Eigen::Vector3d& p : world.surface.vertices) p = X * p;
  for (Eigen::Vector3d& p : world.volume.nodes) p = X * p;
  for (Region& region : world.regions) {
    region.a = X * region.a;
    region.b = X * region.b;
  }
  for (Vessel& vessel : world.vessels) {
    for (Eigen::Vector3d& p : vessel.centre_line) p = X * p;
  }
  return world;  // zones of fixed nodes stay: boxes do not turn
}

RestMesh mesh_of_tetrahedra(const ObjectDescription& d) {
  std::vector<std::array<std::uint32_t, 4>> tetrahedra = d.volume.tetrahedra;
  const std::vector<Eigen::Vector3d>& p = d.volume.nodes;
  for (std::array<std::uint32_t, 4>& n : tetrahedra) {
    if (tetrahedron_volume(p[n[0]], p[n[1]], p[n[2]], p[n[3]]) < 0) std::swap(n[2], n[3]);
  }
  return make_rest_mesh(d.volume.nodes, tetrahedra, {});
}

bool within(const Region& region, const Eigen::Vector3d& p) {
  const Eigen::Vector3d along = region.b - region.a;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp((p - region.a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (p - region.a - share * along).norm() <= region.radius_m;
}

std::vector<Material> materials_of(const ObjectDescription& d, const RestMesh& mesh, const Topology& topology) {
  std::vector<Material> materials;
  materials.reserve(topology.elements().size());
  for (const Element& element : topology.elements()) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const std::uint32_t node : mesh.tetrahedra[element.tetrahedron].nodes) centre += 0.25 * mesh.nodes[node];
    Material material = d.material;
    for (const Region& region : d.regions) {
      if (within(region, centre)) material = region.material;
    }
    materials.push_back(material);
  }
  return materials;
}

// Of an element's size in a step: what its own forces may make of a node. Elements that are squeezed flat or turned
// inside out are stiffer than their stable step allows for; more than this share, and they give out energy.
constexpr double kMostWay = 0.5;

bool in_zone(const FixedZone& zone, const Eigen::Vector3d& p) {
  if (zone.radius_m > 0) return (p - zone.low).norm() <= zone.radius_m;
  return (p.array() >= zone.low.array()).all() && (p.array() <= zone.high.array()).all();
}

// Whether a lattice resolves its surface: thin parts fall through it, and what remains is thicker than it was.
Result<void> check_filling(const ObjectDescription& d, double volume) {
  if (!d.volume.tetrahedra.empty()) return {};
  const Eigen::Vector3d& origin = d.surface.vertices.front();
  double enclosed = 0;
  for (const auto& [a, b, c] : d.surface.triangles) {
    enclosed += tetrahedron_volume(origin, d.surface.vertices[a], d.surface.vertices[b], d.surface.vertices[c]);
  }
  constexpr double kMostRatio = 3;  // surfaces that cross themselves enclose parts twice
  if (volume <= kMostRatio * std::abs(enclosed) && std::abs(enclosed) <= kMostRatio * volume) return {};
  return fail(fmt::format("{}: elements of {:g} m make {:.3g} m3 of the {:.3g} m3 within the surface", d.name,
                          d.element_size_m, volume, std::abs(enclosed)),
              "set a smaller element_size_m: at most half of the thickness");
}

// Fails if a tetrahedron of a file needs far more mass for a stable step than most others: it is a sliver.
Result<void> check_masses(const ObjectDescription& d, const RestMesh& mesh, const BodyState& now) {
  constexpr double kMostOverMedian = 100;
  const std::span<const ElementState> states = now.elements.states();
  if (d.volume.tetrahedra.empty() || states.empty()) return {};
  // The influence of the shape alone: stiffer material needs more mass everywhere.
  const auto by_shape = [](const ElementState& s) {
    return s.mass_factor * s.material.density_kg_m3 / s.material.youngs_modulus_pa;
  };
  std::vector<double> all;
  for (const ElementState& s : states) all.push_back(by_shape(s));
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::ranges::nth_element(all, middle);
  const auto sliver = std::ranges::find_if(states, [&](const ElementState& s) {
    return s.mass_factor > kMostOverMedian && by_shape(s) > kMostOverMedian * *middle;
  });
  if (sliver == states.end()) return {};
  const auto element = static_cast<std::size_t>(sliver - states.begin());
  const double factor = sliver->mass_factor;
  const std::uint32_t tetrahedron = now.topology.elements()[element].tetrahedron;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  for (const std::uint32_t node : mesh.tetrahedra[tetrahedron].nodes) at += 250.0 * mesh.nodes[node];
  return fail(
      fmt::format("{}: tetrahedron {} at ({:.1f}, {:.1f}, {:.1f}) mm in the world is too flat: it would need {:.3g} "
                  "times its mass for a stable step; at most {:g} times as much as most others is allowed",
                  d.name, tetrahedron + 1, at.x(), at.y(), at.z(), factor, kMostOverMedian),
      "let the mesher remove slivers (Gmsh: Mesh.Optimize, Mesh.OptimizeNetgen)");
}

}  // namespace

Body::Body(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Body::Body(Body&&) noexcept = default;
Body& Body::operator=(Body&&) noexcept = default;
Body::~Body() = default;

Result<Body> Body::make(const ObjectDescription& description) {
  if (auto checked = check_description(description); !checked) return std::unexpected(checked.error());
  ObjectDescription d = in_world(description);
  Result<RestMesh> mesh = d.volume.tetrahedra.empty() ? fill_with_lattice(d.name, d.surface, d.element_size_m)
                                                      : Result<RestMesh>(mesh_of_tetrahedra(d));
  if (!mesh) return std::unexpected(mesh.error());
  auto parts = std::make_unique<Parts>(std::move(d), *std::move(mesh));
  BodyState& now = parts->now;
  now.elements = Elements(parts->mesh, now.topology, materials_of(parts->description, parts->mesh, now.topology),
                          kStep_s, parts->description.most_substeps);
  if (auto filled = check_filling(parts->description, now.elements.volume()); !filled) {
    return std::unexpected(filled.error());
  }
  if (auto alike = check_masses(parts->description, parts->mesh, now); !alike) return std::unexpected(alike.error());
  std::vector<std::uint32_t> all(now.topology.elements().size());
  std::iota(all.begin(), all.end(), 0U);
  now.surface.update(parts->mesh, now.topology, all);
  const std::size_t nodes = now.topology.rest_node().size();
  now.v.assign(nodes, Eigen::Vector3d::Zero());
  now.burn.assign(nodes, 0.0);
  const Pose X_OW = description.X_WO.inverse();
  for (const std::uint32_t rest : now.topology.rest_node()) {
    const Eigen::Vector3d& p = parts->mesh.nodes[rest];
    now.x.push_back(p);
    const Eigen::Vector3d p_O = X_OW * p;
    const bool fixed = parts->mesh.inside[rest] != 0 &&
                       std::ranges::any_of(description.fixed, [&](const FixedZone& z) { return in_zone(z, p_O); });
    now.fixed.push_back(fixed ? 1 : 0);
  }
  now.inverse_mass.assign(nodes, 0.0);
  now.usual_inverse_mass.assign(nodes, 0.0);
  now.own_mass.assign(nodes, 0.0);
  std::vector<std::uint32_t> numbers(nodes);
  std::iota(numbers.begin(), numbers.end(), 0U);
  parts->set_masses(numbers);
  parts->attributes = description.attributes;
  parts->force.assign(nodes, Eigen::Vector3d::Zero());
  parts->external_force.assign(nodes, Eigen::Vector3d::Zero());
  if (!parts->description.surface.texture.empty()) {
    geometry::TriangleMesh texture_mesh;
    texture_mesh.name = parts->description.name;
    texture_mesh.vertices = parts->description.surface.vertices;
    texture_mesh.triangles = parts->description.surface.triangles;
    parts->texture_tree =
        std::make_unique<geometry::MeshTree>(std::make_shared<const geometry::TriangleMesh>(std::move(texture_mesh)));
  }
  parts->start = now;
  return Body(std::move(parts));
}

void Body::Parts::set_masses(std::span<const std::uint32_t> nodes) {
  for (const std::uint32_t node : nodes) {
    const std::uint32_t rest = now.topology.rest_node()[node];
    double mass = 0;
    double own = 0;
    for (const std::uint32_t t : mesh.tetrahedra_of_node.of(rest)) {
      for (std::size_t k = 0; k < kMostParts; ++k) {
        const std::uint32_t element = now.topology.part(t, k);
        if (element == kNone) break;
        const Element& e = now.topology.elements()[element];
        if (std::ranges::find(e.nodes, node) == e.nodes.end()) continue;
        mass += now.elements.corner_mass(element);
        own += now.elements.corner_mass(element) / now.elements.states()[element].mass_factor;
      }
    }
    now.usual_inverse_mass[node] = now.fixed[node] != 0 || mass <= 0 ? 0.0 : 1.0 / mass;
    now.inverse_mass[node] = now.usual_inverse_mass[node];
    now.own_mass[node] = own;
  }
}

// A node that becomes heavier keeps its momentum, one that becomes lighter its velocity: so changes of mass take energy
// away and never give any.
void Body::Parts::add_extra_masses() {
  now.elements.extra_masses(sums, extras);
  if (extras.empty() && heavy.empty()) return;
  for (const std::uint32_t node : heavy) now.inverse_mass[node] = now.usual_inverse_mass[node];
  extra_mass.resize(now.x.size(), 0.0);
  extra_mass_before.resize(now.x.size(), 0.0);
  for (const std::uint32_t node : heavy) extra_mass_before[node] = std::exchange(extra_mass[node], 0.0);
  heavy_before.swap(heavy);
  heavy.clear();
  for (const Elements::Extra& extra : extras) {
    for (const std::uint32_t node : extra.nodes) {
      if (now.inverse_mass[node] == 0) continue;
      if (extra_mass[node] == 0) heavy.push_back(node);
      extra_mass[node] += extra.corner_mass;
    }
  }
  for (const std::uint32_t node : heavy) {
    const double usual = 1.0 / now.usual_inverse_mass[node];
    const double mass = usual + extra_mass[node];
    if (extra_mass[node] > extra_mass_before[node]) now.v[node] *= (usual + extra_mass_before[node]) / mass;
    now.inverse_mass[node] = 1.0 / mass;
  }
  for (const std::uint32_t node : heavy_before) extra_mass_before[node] = 0;
}

void Body::begin_step(double dt, const Eigen::Vector3d& gravity) {
  Parts& p = *parts_;
  if (!has(p.attributes, TissueAttribute::calculate)) return;
  BodyState& now = p.now;
  std::ranges::fill(p.force, Eigen::Vector3d::Zero());
  p.sums = now.elements.add_forces(now.x, dt, p.force);
  p.add_extra_masses();
  const double drag = 1.0 / (1.0 + p.description.material.drag_1_s * dt);
  const Eigen::Vector3d g = has(p.attributes, TissueAttribute::gravity) ? gravity : Eigen::Vector3d::Zero();
  // Its own forces make no node faster than elements can follow: whatever has been done to a body, it does not fly
  // apart. What instruments and gravity made faster stays so.
  const double fastest = kMostWay * now.elements.size() / dt;
  for (std::size_t n = 0; n < now.x.size(); ++n) {
    if (now.inverse_mass[n] == 0) {
      now.v[n].setZero();
    } else {
      const double most = std::max(fastest * fastest, now.v[n].squaredNorm());
      Eigen::Vector3d v = now.v[n] + dt * now.inverse_mass[n] * (p.force[n] + p.external_force[n]);
      const double squared = v.squaredNorm();
      if (squared > most) v *= std::sqrt(most / squared);
      now.v[n] = drag * (v + dt * now.inverse_mass[n] * now.own_mass[n] * g);
    }
    p.external_force[n].setZero();
  }
}

void Body::end_step(double dt) {
  Parts& p = *parts_;
  if (!has(p.attributes, TissueAttribute::calculate)) return;
  BodyState& now = p.now;
  for (std::size_t n = 0; n < now.x.size(); ++n) now.x[n] += dt * now.v[n];
  if (has(p.attributes, TissueAttribute::plastic) && now.elements.yield(now.topology, now.x) > 0) {
    std::vector<std::uint32_t> all(now.x.size());
    std::iota(all.begin(), all.end(), 0U);
    p.set_masses(all);
  }
  p.surface_current = false;
}

void Body::reset() {
  Parts& p = *parts_;
  p.now = p.start;
  p.force.assign(p.now.x.size(), Eigen::Vector3d::Zero());
  p.external_force = p.force;
  p.sums = {};
  p.heavy.clear();
  p.extra_mass.clear();
  p.next_edge = 0;
  p.surface_current = false;
  ++p.revision;
}

void Body::set_attributes(std::uint16_t attributes) {
  parts_->attributes = attributes;
  if (!has(attributes, TissueAttribute::calculate)) std::ranges::fill(parts_->now.v, Eigen::Vector3d::Zero());
}
std::uint16_t Body::attributes() const { return parts_->attributes; }

std::span<const Eigen::Vector3d> Body::positions() const { return parts_->now.x; }
std::span<const Eigen::Vector3d> Body::velocities() const { return parts_->now.v; }
std::span<const double> Body::inverse_masses() const { return parts_->now.inverse_mass; }
std::span<const Eigen::Vector3d> Body::internal_forces() const { return parts_->force; }

void Body::add_velocity(std::uint32_t node, const Eigen::Vector3d& change) {
  if (parts_->now.inverse_mass[node] > 0) parts_->now.v[node] += change;
}

void Body::add_force(std::uint32_t node, const Eigen::Vector3d& force) { parts_->external_force[node] += force; }

std::uint32_t Body::limit_speed(double limit_m_s) {
  std::uint32_t concerned = 0;
  for (Eigen::Vector3d& v : parts_->now.v) {
    const double squared = v.squaredNorm();
    if (squared <= limit_m_s * limit_m_s) continue;
    v *= limit_m_s / std::sqrt(squared);
    ++concerned;
  }
  return concerned;
}

}  // namespace cellmirror::tissue
