#include "rt_core/tissue/body/elements.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "rt_core/tissue/body/dissection.hpp"

namespace cellmirror::tissue {
namespace {

constexpr double kLeastFill = 0.02;  // of an element, for stiffness and mass
constexpr int kMostMassTrials = 6;
// What neighbours of the same kind take off the fastest mode. Soft neighbours of a stiff element take off more, but
// only until a cut parts them from it.
constexpr double kMostShare = 1.5;
constexpr double kMostYieldMass = 16;  // an element yields no further once it needs so much of its mass

struct Moduli {
  double shear = 0;  // Pa
  double bulk = 0;
};

Moduli moduli(const Material& material, double burn) {
  const double e = material.youngs_modulus_pa * (1.0 + kBurntStiffening * std::min(burn, 1.0));
  return {.shear = e / (2.0 * (1.0 + material.poissons_ratio)),
          .bulk = e / (3.0 * (1.0 - 2.0 * material.poissons_ratio))};
}

Eigen::Matrix3d edges_of(const RestMesh& mesh, const RestTetrahedron& t) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k)
    edges.col(k) = mesh.nodes[t.nodes[static_cast<std::size_t>(k) + 1]] - mesh.nodes[t.nodes[0]];
  return edges;
}

Eigen::Matrix3d edges_of(const Element& e, std::span<const Eigen::Vector3d> x) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = x[e.nodes[static_cast<std::size_t>(k) + 1]] - x[e.nodes[0]];
  return edges;
}

double shrunk(double burn) { return 1.0 - kBurntShrinking * std::min(burn, 1.0); }

// Longest stable step of a mode with viscous stress of the rate in the step before (Belytschko, Liu, Moran 2000, 6.2).
double damped_step(double omega, double damping_s) {
  const double xi = 0.5 * damping_s * omega;
  return 2.0 / omega * (std::sqrt(1.0 + xi * xi) - xi);
}

// omega^2 of the fastest mode of one element by itself, free and with its mass at its corners: about u = gradient of
// the shape function at each corner.
double fastest_squared(const ElementState& s) {
  const Moduli m = moduli(s.material, s.burn);
  const Eigen::Matrix3d b = s.inverse_shape / shrunk(s.burn);
  const Eigen::Vector3d first = -(b.row(0) + b.row(1) + b.row(2)).transpose();
  Eigen::Matrix3d g = first * first.transpose();
  for (int n = 0; n < 3; ++n) g += b.row(n).transpose() * b.row(n);
  const double lambda = m.bulk - 2.0 / 3.0 * m.shear;
  const double trace = g.trace();
  return 4.0 / s.material.density_kg_m3 * (lambda * trace * trace + 2.0 * m.shear * (g * g).trace()) / trace;
}

double stable_step_of(const ElementState& s) {
  return damped_step(std::sqrt(fastest_squared(s)), s.material.damping_s);
}

}  // namespace

double wave_speed(const Material& material) {
  const Moduli m = moduli(material, 0);
  return std::sqrt((m.bulk + 4.0 / 3.0 * m.shear) / material.density_kg_m3);
}

Elements::Elements(const RestMesh& mesh, const Topology& topology, std::vector<Material> materials, double step,
                   int most_substeps) {
  const std::span<const Element> elements = topology.elements();
  states_.resize(elements.size());
  double slowest_alone = std::numeric_limits<double>::infinity();
  double largest_damping = 0;
  for (std::uint32_t e = 0; e < states_.size(); ++e) {
    ElementState& s = states_[e];
    const RestTetrahedron& t = mesh.tetrahedra[elements[e].tetrahedron];
    s.material = materials[e];
    s.inverse_shape = edges_of(mesh, t).inverse();
    s.volume = material_volume(mesh, topology, e);
    s.carried = std::max(s.volume, kLeastFill * t.volume);
    size_ += std::cbrt(6.0 * t.volume) / static_cast<double>(states_.size());
    slowest_alone = std::min(slowest_alone, stable_step_of(s));
    largest_yield_ = std::max(largest_yield_, s.material.yield_strain);
    largest_damping = std::max(largest_damping, s.material.damping_s);
  }
  stored_step_ = step_ = step;
  spread_ = static_cast<std::uint32_t>((states_.size() + kLanes - 1) / kLanes);
  blocks_.resize(kLanes * spread_);
  for (std::uint32_t e = 0; e < states_.size(); ++e) {
    blocks_.nodes[place(e)] = elements[e].nodes;
    store(e);
  }
  stable_step_ = std::max(slowest_alone, damped_step(fastest_mode(mesh, topology), largest_damping));
  element_share_ = std::min(kMostShare, stable_step_ / slowest_alone);
  substeps_ = std::clamp(static_cast<int>(std::ceil(step / (kStepSafety * stable_step_))), 1,
                         std::clamp(most_substeps, 1, kMostSubsteps));
  step_ = step / substeps_;
  add_mass(mesh, topology);
  stored_step_ = step_;
  for (std::uint32_t e = 0; e < states_.size(); ++e) store(e);
}

std::size_t Elements::place(std::uint32_t element) const {
  const std::uint32_t lane = element / spread_;
  return lane < kLanes ? element % spread_ * kLanes + lane : element;
}

std::uint32_t Elements::element_at(std::size_t place) const {
  const std::size_t block = place / kLanes;
  return static_cast<std::uint32_t>(block < spread_ ? place % kLanes * spread_ + block : place);
}

void Elements::extra_masses(const KernelSums& sums, std::vector<Extra>& extras) const {
  extras.clear();
  if (sums.largest_load <= kMostLoad) return;
  for (std::size_t block = 0; block < blocks_.blocks(); ++block) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const float load = blocks_.load[block].lane[lane];
      if (load <= kMostLoad) continue;
      const std::size_t at = block * kLanes + lane;
      const std::uint32_t e = element_at(at);
      // What neighbours take off at rest does not count for one element that is deformed more than they are.
      const double share = share_of(states_[e]);
      const double part = static_cast<double>(load) / static_cast<double>(kMostLoad) - 1.0;
      extras.push_back({.nodes = blocks_.nodes[at], .corner_mass = share * share * part * corner_mass(e)});
    }
  }
}

// What neighbours take off an element differs between the parts of a body, so the result is verified; with a share of 1
// it is stable for certain.
void Elements::add_mass(const RestMesh& mesh, const Topology& topology) {
  double largest_damping = 0;
  for (const ElementState& s : states_) largest_damping = std::max(largest_damping, s.material.damping_s);
  for (int i = 0; i < kMostMassTrials; ++i) {
    if (i + 1 == kMostMassTrials) element_share_ = 1;
    for (ElementState& s : states_) set_mass_factor(s);
    if (element_share_ == 1 || added_mass() == 0) return;
    const double ratio = step_ / (kStepSafety * damped_step(fastest_mode(mesh, topology), largest_damping));
    if (ratio <= 1.0) return;
    element_share_ = std::max(1.0, 0.99 * element_share_ / ratio);
  }
}

// rad/s, by power iteration over small displacements (Rayleigh's quotient, from below; 3 % are added).
double Elements::fastest_mode(const RestMesh& mesh, const Topology& topology) {
  constexpr int kIterations = 60;
  const std::size_t nodes = topology.rest_node().size();
  std::vector<double> mass(nodes, 0.0);
  double size = 0;
  for (std::uint32_t e = 0; e < states_.size(); ++e) {
    for (const std::uint32_t node : topology.elements()[e].nodes) mass[node] += corner_mass(e);
    size = std::max(size, std::cbrt(mesh.tetrahedra[topology.elements()[e].tetrahedron].volume));
  }
  std::vector<Eigen::Vector3d> u(nodes);
  std::vector<Eigen::Vector3d> x(nodes);
  std::vector<Eigen::Vector3d> f(nodes);
  // Any start that is no rigid motion; neighbours move against each other, as in the fastest mode.
  for (std::size_t n = 0; n < nodes; ++n) {
    u[n] = Eigen::Vector3d(std::sin(12.9898 * static_cast<double>(n)), std::sin(78.233 * static_cast<double>(n)),
                           std::sin(37.719 * static_cast<double>(n)));
  }
  double squared = 0;
  for (int i = 0; i < kIterations; ++i) {
    double largest = 0;
    for (const Eigen::Vector3d& p : u) largest = std::max(largest, p.norm());
    const double scale = 1e-3 * size / largest;
    double kinetic = 0;
    for (std::size_t n = 0; n < nodes; ++n) {
      u[n] *= scale;
      x[n] = mesh.nodes[topology.rest_node()[n]] + u[n];
      f[n].setZero();
      kinetic += mass[n] * u[n].squaredNorm();
    }
    std::ranges::fill(blocks_.last_strain, LaneRow{});
    add_forces(x, 1e6 * step_, f);  // so slowly that damping does not count
    double work = 0;
    for (std::size_t n = 0; n < nodes; ++n) {
      work -= u[n].dot(f[n]);
      u[n] = -f[n] / mass[n];
    }
    squared = std::max(squared, work / kinetic);
  }
  std::ranges::fill(blocks_.last_strain, LaneRow{});
  return 1.03 * std::sqrt(squared);
}

void Elements::set_mass_factor(ElementState& state) const {
  const double alone = stable_step_of(state) * share_of(state);
  const double ratio = step_ / (kStepSafety * alone);
  state.mass_factor = std::max(1.0, ratio * ratio);
}

void Elements::set_loose(std::uint32_t element, bool loose) {
  ElementState& s = states_[element];
  if (s.loose == loose) return;
  s.loose = loose;
  set_mass_factor(s);
  store(element);
}

void Elements::store(std::uint32_t element) {
  const ElementState& s = states_[element];
  const std::size_t at = place(element);
  const Moduli m = moduli(s.material, s.burn);
  const Eigen::Matrix3d b = s.inverse_shape / shrunk(s.burn);
  const auto put = [&](std::size_t v, double value) {
    lane_value(blocks_.material, ElementBlocks::kMaterialValues, at, v) = static_cast<float>(value);
  };
  for (std::size_t k = 0; k < 9; ++k) put(k, b(static_cast<int>(k) / 3, static_cast<int>(k) % 3));
  put(9, m.shear * s.carried);
  put(10, m.bulk * s.carried);
  const double viscosity = s.material.damping_s / stored_step_ * s.carried;
  put(11, 2.0 * m.shear * viscosity);
  put(12, (m.bulk - 2.0 / 3.0 * m.shear) * viscosity);
  // An explicit step is stable while (omega step / 2)^2 + omega^2 damping step / 2 is less than 1.
  const double share = share_of(s);
  const double squared = fastest_squared(s) / (share * share * s.mass_factor);
  put(13, squared * 0.25 * stored_step_ * stored_step_ / ((m.bulk + 4.0 / 3.0 * m.shear) * s.carried));
  put(14, squared * 0.5 * s.material.damping_s * stored_step_);
}

double Elements::volume() const {
  double sum = 0;
  for (const ElementState& s : states_) sum += s.volume;
  return sum;
}

double Elements::mass() const {
  double sum = 0;
  for (const ElementState& s : states_) sum += s.carried * s.material.density_kg_m3;
  return sum;
}

double Elements::added_mass() const {
  double sum = 0;
  for (const ElementState& s : states_) sum += s.carried * s.material.density_kg_m3 * (s.mass_factor - 1.0);
  return sum;
}

double Elements::corner_mass(std::uint32_t element) const {
  const ElementState& s = states_[element];
  return 0.25 * s.carried * s.material.density_kg_m3 * s.mass_factor;
}

void Elements::follow(const RestMesh& mesh, const Topology& topology, std::span<const std::uint32_t> elements,
                      std::span<const std::uint32_t> origins) {
  const std::size_t before = states_.size();
  states_.resize(topology.elements().size());
  const auto last = static_cast<std::uint32_t>(states_.size() - 1);
  blocks_.resize(std::max(blocks_.count, place(last) + 1));
  for (std::size_t i = 0; i < origins.size(); ++i) {
    states_[before + i] = states_[origins[i]];
    const std::size_t to = place(static_cast<std::uint32_t>(before + i));
    const std::size_t from = place(origins[i]);
    for (std::size_t v = 0; v < 6; ++v) {
      lane_value(blocks_.last_strain, 6, to, v) = lane_value(blocks_.last_strain, 6, from, v);
    }
  }
  for (const std::uint32_t e : elements) {
    blocks_.nodes[place(e)] = topology.elements()[e].nodes;
    states_[e].volume = material_volume(mesh, topology, e);
    states_[e].carried =
        std::max(states_[e].volume, kLeastFill * mesh.tetrahedra[topology.elements()[e].tetrahedron].volume);
    store(e);
  }
}

void Elements::rebase_strain(std::uint32_t element, const Eigen::Matrix3d& change) {
  constexpr std::array<std::array<int, 2>, 6> kAt{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  const std::size_t at = place(element);
  Eigen::Matrix3d c;
  for (std::size_t v = 0; v < 6; ++v) {
    const auto [row, column] = kAt[v];
    c(row, column) = c(column, row) = 2.0 * static_cast<double>(lane_value(blocks_.last_strain, 6, at, v));
  }
  c = change.transpose() * (c + Eigen::Matrix3d::Identity()) * change - Eigen::Matrix3d::Identity();
  for (std::size_t v = 0; v < 6; ++v) {
    lane_value(blocks_.last_strain, 6, at, v) = static_cast<float>(0.5 * c(kAt[v][0], kAt[v][1]));
  }
}

void Elements::set_burn(std::uint32_t element, double burn) {
  rebase_strain(element, Eigen::Matrix3d::Identity() * (shrunk(states_[element].burn) / shrunk(burn)));
  states_[element].burn = burn;
  set_mass_factor(states_[element]);
  store(element);
}

KernelSums Elements::add_forces(std::span<const Eigen::Vector3d> x, double step, std::span<Eigen::Vector3d> f) {
  if (step != stored_step_) {
    stored_step_ = step;
    for (std::uint32_t e = 0; e < states_.size(); ++e) store(e);
  }
  kernel_x_.resize(x.size());
  kernel_f_.assign(x.size(), NodeVector{});
  for (std::size_t n = 0; n < x.size(); ++n) kernel_x_[n] = {{x[n][0], x[n][1], x[n][2], 0.0}};
  const KernelSums sums = compute_element_forces(blocks_, kernel_x_, kernel_f_);
  for (std::size_t n = 0; n < x.size(); ++n) f[n] += Eigen::Map<const Eigen::Vector3d>(kernel_f_[n].xyz0.data());
  return sums;
}

std::uint32_t Elements::yield(const Topology& topology, std::span<const Eigen::Vector3d> x) {
  if (largest_yield_ <= 0) return 0;
  std::uint32_t yielded = 0;
  for (std::uint32_t e = 0; e < states_.size(); ++e) {
    ElementState& s = states_[e];
    const double limit = s.material.yield_strain;
    // sqrt(strain / 3) is the equivalent strain of a small stretch; the exact test follows.
    if (limit <= 0 || static_cast<double>(lane_value(blocks_.strain, 1, place(e), 0)) < 1.5 * limit * limit) continue;
    const Eigen::Matrix3d f = edges_of(topology.elements()[e], x) * s.inverse_shape / shrunk(s.burn);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(f.transpose() * f);
    const Eigen::Vector3d stretch = principal.eigenvalues().cwiseMax(1e-4).cwiseSqrt();
    Eigen::Vector3d excess = stretch;
    for (int k = 0; k < 3; ++k) excess[k] = stretch[k] / std::clamp(stretch[k], 1.0 / (1.0 + limit), 1.0 + limit);
    if (excess.isOnes(1e-12)) continue;
    excess /= std::cbrt(excess.prod());  // plastic strain keeps the volume
    const Eigen::Matrix3d& v = principal.eigenvectors();
    const Eigen::Matrix3d change = v * excess.cwiseInverse().asDiagonal() * v.transpose();
    ElementState changed = s;
    changed.inverse_shape = s.inverse_shape * change;
    set_mass_factor(changed);
    if (changed.mass_factor > std::max(kMostYieldMass, s.mass_factor)) continue;
    s = changed;
    rebase_strain(e, change);
    store(e);
    ++yielded;
  }
  return yielded;
}

double Elements::elastic_energy(const Topology& topology, std::span<const Eigen::Vector3d> x) const {
  double sum = 0;
  for (std::uint32_t e = 0; e < states_.size(); ++e) {
    const ElementState& s = states_[e];
    const Eigen::Matrix3d f = edges_of(topology.elements()[e], x) * s.inverse_shape / shrunk(s.burn);
    const Moduli m = moduli(s.material, s.burn);
    const double j = f.determinant();
    // j^(-2/3); several times as fast as by std::cbrt.
    const double isochoric = std::exp(-2.0 / 3.0 * std::log(std::max(j, 0.1)));
    sum += s.carried * (0.5 * m.shear * (f.squaredNorm() * isochoric - 3.0) + 0.5 * m.bulk * (j - 1.0) * (j - 1.0));
  }
  return sum;
}

}  // namespace cellmirror::tissue
