// What changes a body for good: cuts, tears, heat; and its figures.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "rt_core/tissue/body/body_parts.hpp"
#include "rt_core/tissue/description/step.hpp"

namespace cellmirror::tissue {
namespace {

constexpr std::size_t kEdgesPerSearch = 8;  // an eighth of all edges are searched for tears in a step

// Where the segment from a to b crosses the parallelogram, as a share of the way; negative: it does not. `normal` is
// along x across; the ends lie on different sides of the plane.
double crossing_of(const BladeSweep& blade, const Eigen::Vector3d& normal, const Eigen::Vector3d& a,
                   const Eigen::Vector3d& b) {
  const double da = normal.dot(a - blade.corner);
  const double db = normal.dot(b - blade.corner);
  const double share = da / (da - db);
  const Eigen::Vector3d w = a + share * (b - a) - blade.corner;
  const double area = normal.squaredNorm();
  const double s = w.cross(blade.across).dot(normal) / area;
  const double t = blade.along.cross(w).dot(normal) / area;
  constexpr double kSlack = 1e-9;  // neighbouring sweeps leave no gap
  const bool in = s >= -kSlack && s <= 1 + kSlack && t >= -kSlack && t <= 1 + kSlack;
  return in ? share : -1;
}

}  // namespace

void Body::Parts::adopt(const TopologyChange& change) {
  const std::size_t nodes = now.topology.rest_node().size();
  for (std::size_t n = change.first_new_node; n < nodes; ++n) {
    const std::uint32_t parent = now.topology.parent()[n];
    now.x.push_back(now.x[parent]);
    now.v.push_back(now.v[parent]);
    now.burn.push_back(now.burn[parent]);
    now.fixed.push_back(0);
    now.inverse_mass.push_back(0);
    now.usual_inverse_mass.push_back(0);
    now.own_mass.push_back(0);
  }
  force.resize(nodes, Eigen::Vector3d::Zero());
  external_force.resize(nodes, Eigen::Vector3d::Zero());
  now.elements.follow(mesh, now.topology, change.elements, change.origins);
  // A fixed node stays fixed where its own material is: in the part that owns it. Its copies are free, whichever of
  // them kept the number.
  for (const std::uint32_t node : change.nodes) now.fixed[node] = 0;
  for (const std::uint32_t element : change.elements) {
    const Element& e = now.topology.elements()[element];
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t rest = now.topology.rest_node()[e.nodes[k]];
      if (e.owns(k) && start.fixed[first_node_of(rest)] != 0) now.fixed[e.nodes[k]] = 1;
    }
  }
  for (const std::uint32_t element : change.elements) now.elements.set_loose(element, is_loose(element));
  set_masses(change.nodes);
  now.surface.update(mesh, now.topology, change.elements);
  surface_current = false;
  ++revision;
}

// Whether other elements share the nodes of this one with little mass: alone it has 4 times its own, within a body of
// equals up to 96 times.
bool Body::Parts::is_loose(std::uint32_t element) const {
  constexpr double kFewShares = 20;
  const double own = now.elements.corner_mass(element);
  double shares = 0;
  for (const std::uint32_t node : now.topology.elements()[element].nodes) {
    for (const std::uint32_t t : mesh.tetrahedra_of_node.of(now.topology.rest_node()[node])) {
      for (std::size_t k = 0; k < kMostParts; ++k) {
        const std::uint32_t other = now.topology.part(t, k);
        if (other == kNone) break;
        const std::array<std::uint32_t, 4>& nodes = now.topology.elements()[other].nodes;
        if (std::ranges::find(nodes, node) != nodes.end()) shares += now.elements.corner_mass(other) / own;
        if (shares > kFewShares) return false;
      }
    }
  }
  return true;
}

CutResult Body::Parts::divide(std::span<const Topology::Division> divisions, const Eigen::Vector3d& at) {
  if (divisions.empty()) return {};
  TopologyChange change;
  now.topology.divide(mesh, divisions, change);
  if (change.new_elements > 0) adopt(change);
  // Each divided edge stands for the part of a plane that belongs to it in the lattice.
  double area = 0;
  for (const Topology::Division& d : divisions) {
    const auto& [a, b] = mesh.edges[d.edge].nodes;
    const double length = (mesh.nodes[a] - mesh.nodes[b]).norm();
    area += 0.25 * length * length;
  }
  return {.links = change.divided_edges, .elements = change.new_elements, .area_m2 = area, .at = at};
}

CutResult Body::cut(const BladeSweep& blade) {
  Parts& p = *parts_;
  const Eigen::Vector3d normal = blade.along.cross(blade.across);
  if (!normal.allFinite() || !blade.corner.allFinite() || normal.squaredNorm() < 1e-24) return {};
  const BodyState& now = p.now;
  std::vector<std::uint8_t> beyond(now.x.size());  // on which side of the blade's plane
  for (std::size_t n = 0; n < now.x.size(); ++n) beyond[n] = normal.dot(now.x[n] - blade.corner) >= 0 ? 1 : 0;
  std::vector<Topology::Division> divisions;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const std::span<const Element> elements = now.topology.elements();
  for (std::uint32_t number = 0; number < elements.size(); ++number) {
    const Element& element = elements[number];
    const int ends_beyond =
        beyond[element.nodes[0]] + beyond[element.nodes[1]] + beyond[element.nodes[2]] + beyond[element.nodes[3]];
    if (ends_beyond == 0 || ends_beyond == 4) continue;
    const std::array<std::uint32_t, 6>& edges = p.mesh.tetrahedra[element.tetrahedron].edges;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      if (now.topology.element_of_edge(edges[k]) != number) continue;
      std::uint32_t a = element.nodes[kEdgeCorners[k][0]];
      std::uint32_t b = element.nodes[kEdgeCorners[k][1]];
      if (beyond[a] == beyond[b]) continue;
      if (blade.min_burn > 0 && std::min(now.burn[a], now.burn[b]) < blade.min_burn) continue;
      if (now.topology.rest_node()[a] != p.mesh.edges[edges[k]].nodes[0]) std::swap(a, b);
      const double share = crossing_of(blade, normal, now.x[a], now.x[b]);
      if (share < 0) continue;
      divisions.push_back({.edge = edges[k], .share = share});
      sum += now.x[a] + share * (now.x[b] - now.x[a]);
    }
  }
  if (divisions.empty()) return {};
  return p.divide(divisions, sum / static_cast<double>(divisions.size()));
}

CutResult Body::tear(std::uint32_t most) {
  Parts& p = *parts_;
  const BodyState& now = p.now;
  std::vector<Topology::Division> divisions;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const std::size_t count = p.mesh.edges.size() / kEdgesPerSearch + 1;
  for (std::size_t i = 0; i < count && divisions.size() < most; ++i) {
    const auto e = static_cast<std::uint32_t>(p.next_edge);
    p.next_edge = (p.next_edge + 1) % p.mesh.edges.size();
    const std::uint32_t element = now.topology.element_of_edge(e);
    if (element == kNone) continue;
    const double limit = now.elements.states()[element].material.tear_strain;
    if (limit <= 0) continue;
    const Element& owner = now.topology.elements()[element];
    const RestTetrahedron& t = p.mesh.tetrahedra[owner.tetrahedron];
    const auto& ends = p.mesh.edges[e].nodes;
    const std::uint32_t a =
        owner.nodes[static_cast<std::size_t>(std::ranges::find(t.nodes, ends[0]) - t.nodes.begin())];
    const std::uint32_t b =
        owner.nodes[static_cast<std::size_t>(std::ranges::find(t.nodes, ends[1]) - t.nodes.begin())];
    const double rest = (p.mesh.nodes[ends[1]] - p.mesh.nodes[ends[0]]).norm();
    if ((now.x[b] - now.x[a]).norm() <= (1.0 + limit) * rest) continue;
    divisions.push_back({.edge = e, .share = 0.5});
    sum += 0.5 * (now.x[a] + now.x[b]);
  }
  if (divisions.empty()) return {};
  return p.divide(divisions, sum / static_cast<double>(divisions.size()));
}

double Body::heat(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius, double dose) {
  Parts& p = *parts_;
  BodyState& now = p.now;
  const Eigen::Vector3d along = b - a;
  const double length = along.squaredNorm();
  std::vector<std::uint32_t> heated;
  for (std::uint32_t n = 0; n < now.x.size(); ++n) {
    const double share = length > 0 ? std::clamp((now.x[n] - a).dot(along) / length, 0.0, 1.0) : 0.0;
    const double distance = (now.x[n] - a - share * along).norm();
    if (distance >= radius || now.burn[n] >= 2.0) continue;
    now.burn[n] = std::min(2.0, now.burn[n] + dose * (1.0 - distance / radius));
    heated.push_back(n);
  }
  std::vector<std::uint32_t> rest_nodes;
  for (const std::uint32_t n : heated) rest_nodes.push_back(now.topology.rest_node()[n]);
  std::vector<std::uint32_t> tetrahedra;
  for (const std::uint32_t rest : rest_nodes) {
    const auto around = p.mesh.tetrahedra_of_node.of(rest);
    tetrahedra.insert(tetrahedra.end(), around.begin(), around.end());
  }
  std::ranges::sort(tetrahedra);
  tetrahedra.erase(std::ranges::unique(tetrahedra).begin(), tetrahedra.end());
  double volume = 0;
  std::vector<std::uint32_t> nodes;
  for (const std::uint32_t t : tetrahedra) {
    for (std::size_t k = 0; k < kMostParts; ++k) {
      const std::uint32_t element = now.topology.part(t, k);
      if (element == kNone) break;
      const Element& e = now.topology.elements()[element];
      double mean = 0;
      for (const std::uint32_t node : e.nodes) mean += 0.25 * now.burn[node];
      const double before = now.elements.states()[element].burn;
      if (mean == before) continue;
      volume += now.elements.states()[element].volume * (std::min(mean, 1.0) - std::min(before, 1.0));
      now.elements.set_burn(element, mean);
      nodes.insert(nodes.end(), e.nodes.begin(), e.nodes.end());
    }
  }
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  p.set_masses(nodes);
  return volume;
}

double Body::kinetic_energy() const {
  double sum = 0;
  const BodyState& now = parts_->now;
  for (std::size_t n = 0; n < now.v.size(); ++n) {
    if (now.inverse_mass[n] > 0) sum += 0.5 * now.v[n].squaredNorm() / now.inverse_mass[n];
  }
  return sum;
}

double Body::elastic_energy() const { return parts_->now.elements.elastic_energy(parts_->now.topology, parts_->now.x); }
double Body::volume_at_rest() const { return parts_->now.elements.volume(); }
double Body::largest_strain() const { return std::sqrt(std::max(0.0F, parts_->sums.largest_strain) / 3.0); }
double Body::stable_step_s() const { return parts_->now.elements.stable_step(); }

double Body::largest_speed() const {
  double squared = 0;
  for (const Eigen::Vector3d& v : parts_->now.v) squared = std::max(squared, v.squaredNorm());
  return std::sqrt(squared);
}

void Body::describe(TissueObjectState& state) const {
  const BodyState& now = parts_->now;
  state.name = parts_->description.name;
  state.nodes = static_cast<std::uint32_t>(now.x.size());
  state.elements = static_cast<std::uint32_t>(now.topology.elements().size());
  state.elements_at_start = static_cast<std::uint32_t>(parts_->start.topology.elements().size());
  state.attributes = parts_->attributes;
  state.substeps = static_cast<std::uint32_t>(now.elements.substeps());
  state.added_mass_share = now.elements.added_mass() / now.elements.mass();
  state.volume_m3 = now.elements.volume();
  state.inverted = parts_->sums.inverted;
  if (parts_->counted_revision != parts_->revision) {
    parts_->part_count = parts_->count_parts();
    parts_->counted_revision = parts_->revision;
  }
  state.parts = parts_->part_count;
  state.energy_j = parts_->sums.energy;
  double burnt = 0;
  for (const ElementState& s : now.elements.states()) burnt += s.volume * std::min(s.burn, 1.0);
  state.coagulated_share = burnt / state.volume_m3;
}

std::uint32_t Body::Parts::count_parts() const {
  std::vector<std::uint32_t> leader(now.x.size());
  std::iota(leader.begin(), leader.end(), 0U);
  const auto find = [&](std::uint32_t i) {
    while (leader[i] != i) i = leader[i] = leader[leader[i]];
    return i;
  };
  for (const Element& e : now.topology.elements()) {
    for (std::size_t k = 1; k < 4; ++k) leader[find(e.nodes[k])] = find(e.nodes[0]);
  }
  std::uint32_t count = 0;
  for (std::uint32_t n = 0; n < leader.size(); ++n) count += leader[n] == n ? 1U : 0U;
  return count;
}

std::uint32_t Body::Parts::first_node_of(std::uint32_t rest_node) const {
  for (const std::uint32_t t : mesh.tetrahedra_of_node.of(rest_node)) {
    const std::uint32_t element = start.topology.part(t, 0);
    if (element == kNone) continue;
    const RestTetrahedron& tetrahedron = mesh.tetrahedra[t];
    const auto corner = std::ranges::find(tetrahedron.nodes, rest_node) - tetrahedron.nodes.begin();
    return start.topology.elements()[element].nodes[static_cast<std::size_t>(corner)];
  }
  return 0;
}

void Body::network(TissueNetwork& network) const {
  const Parts& p = *parts_;
  const auto first = static_cast<std::uint32_t>(network.nodes.size());
  std::vector<std::uint8_t> outer(p.now.x.size(), 0);
  for (const EmbeddedPoint& point : p.now.surface.points()) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (point.weight[k] > 0) outer[point.node[k]] = 1;
    }
  }
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& x : p.now.x) centre += x / static_cast<double>(p.now.x.size());
  std::size_t central = 0;
  for (std::size_t n = 0; n < p.now.x.size(); ++n) {
    network.nodes.push_back(p.now.x[n].cast<float>());
    network.kinds.push_back(p.now.fixed[n] != 0 ? TissueNodeKind::fixed
                                                : (outer[n] != 0 ? TissueNodeKind::outer : TissueNodeKind::inner));
    if ((p.now.x[n] - centre).squaredNorm() < (p.now.x[central] - centre).squaredNorm()) central = n;
  }
  for (std::uint32_t e = 0; e < p.mesh.edges.size(); ++e) {
    const std::uint32_t element = p.now.topology.element_of_edge(e);
    if (element == kNone) continue;
    const Element& owner = p.now.topology.elements()[element];
    const RestTetrahedron& t = p.mesh.tetrahedra[owner.tetrahedron];
    std::array<std::uint32_t, 2> link{};
    for (std::size_t k = 0; k < 2; ++k) {
      const auto corner = std::ranges::find(t.nodes, p.mesh.edges[e].nodes[k]) - t.nodes.begin();
      link[k] = first + owner.nodes[static_cast<std::size_t>(corner)];
    }
    network.links.push_back(link);
  }
  network.central_nodes.push_back(p.orientation_at(static_cast<std::uint32_t>(central)));
}

// The rotation of the elements about a node that fits their deformations best (polar decomposition).
Pose Body::Parts::orientation_at(std::uint32_t node) const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const std::uint32_t t : mesh.tetrahedra_of_node.of(now.topology.rest_node()[node])) {
    for (std::size_t k = 0; k < kMostParts; ++k) {
      const std::uint32_t element = now.topology.part(t, k);
      if (element == kNone) break;
      const Element& e = now.topology.elements()[element];
      Eigen::Matrix3d edges;
      for (int c = 0; c < 3; ++c) edges.col(c) = now.x[e.nodes[static_cast<std::size_t>(c) + 1]] - now.x[e.nodes[0]];
      sum += edges * now.elements.states()[element].inverse_shape;
    }
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d turned = svd.matrixU();
  if ((turned * svd.matrixV().transpose()).determinant() < 0) turned.col(2) = -turned.col(2);
  Pose X_WN = Pose::Identity();
  X_WN.linear() = turned * svd.matrixV().transpose();
  X_WN.translation() = now.x[node];
  return X_WN;
}

}  // namespace cellmirror::tissue
