// Inverse dynamics of MuJoCo on a URDF, read by its own reader.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rt_core/dynamics/mechanism.hpp"

namespace cellmirror::dynamics {

class MujocoDynamics {
 public:
  // `joints`: names, by variable. `drives`: reflected inertia (MuJoCo's armature) and viscous friction (its damping),
  // by variable; Coulomb friction is left out. Gravity -9.80665 m/s2 along z. Throws where MuJoCo refuses.
  MujocoDynamics(const std::string& urdf, const std::vector<std::string>& joints, std::span<const Drive> drives);
  ~MujocoDynamics();
  MujocoDynamics(MujocoDynamics&&) noexcept;

  void set(std::span<const double> q, std::span<const double> qd, std::span<const double> qdd);
  void compute();       // mj_inverse
  void compute_bare();  // mj_rne with accelerations, and what it needs before: without armature and damping
  [[nodiscard]] double effort(std::size_t variable) const;
  [[nodiscard]] double bare_effort(std::size_t variable) const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace cellmirror::dynamics
