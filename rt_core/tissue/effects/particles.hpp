// Drops of blood and water and puffs of smoke. Bounded in number; the same from run to run.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "rt_core/ports/tissue_state.hpp"
#include "rt_core/tissue/effects/pool.hpp"

namespace cellmirror::tissue {

enum class ParticleKind : std::uint8_t { blood, smoke, water };

class Particles {
 public:
  static constexpr std::size_t kMost = 512;

  Particles();
  void reset();
  // Drops that stand for a volume are collected until one is whole: `volume_m3` more leaves at `at`. What finds no free
  // particle goes into the pool at once, if it is over it.
  void pour(ParticleKind kind, double volume_m3, const Eigen::Vector3d& at, const Eigen::Vector3d& velocity,
            Pool& pool);
  void smoke(const Eigen::Vector3d& at);
  // Drops fall into the pool and ripple it; all vanish with age.
  void step(double dt, const Eigen::Vector3d& gravity, Pool& pool, bool ripples);
  // Takes away what is nearer to p than `radius`.
  void remove_near(const Eigen::Vector3d& p, double radius);
  [[nodiscard]] std::size_t count() const { return particles_.size(); }
  void view(std::vector<TissueParticle>& particles) const;

 private:
  struct Particle {
    Eigen::Vector3d at;
    Eigen::Vector3d velocity;
    ParticleKind kind;
    double volume_m3;
    double radius_m;
    double age_s;
    double life_s;
  };

  [[nodiscard]] double random();  // -1 to 1
  [[nodiscard]] Eigen::Vector3d random_vector() { return {random(), random(), random()}; }

  std::vector<Particle> particles_;
  std::array<double, 3> collected_{};  // m3, by kind
  std::uint64_t seed_ = 0;
};

}  // namespace cellmirror::tissue
