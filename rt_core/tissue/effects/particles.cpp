#include "rt_core/tissue/effects/particles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr std::array<double, 3> kDropVolume{1.0e-8, 0, 4.0e-8};  // m3, by kind
constexpr std::uint64_t kFirstSeed = 0x9E3779B97F4A7C15U;
constexpr double kDropLife_s = 1.5;
constexpr double kSmokeLife_s = 2.5;
constexpr double kSplash = 0.06;  // m/s of the surface

}  // namespace

Particles::Particles() {
  particles_.reserve(kMost);
  reset();
}

void Particles::reset() {
  particles_.clear();
  collected_ = {};
  seed_ = kFirstSeed;
}

// SplitMix64 (Steele, Lea, Flood 2014).
double Particles::random() {
  std::uint64_t z = (seed_ += 0x9E3779B97F4A7C15U);
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  z ^= z >> 31U;
  return static_cast<double>(z >> 11U) / 4503599627370496.0 - 1.0;
}

void Particles::pour(ParticleKind kind, double volume_m3, const Vector3d& at, const Vector3d& velocity, Pool& pool) {
  double& collected = collected_.at(std::to_underlying(kind));
  const double drop = kDropVolume.at(std::to_underlying(kind));
  collected += volume_m3;
  for (int i = 0; i < 8 && collected >= drop; ++i) {
    collected -= drop;
    if (particles_.size() >= kMost) {
      double depth = 0;
      if (pool.over(at, depth)) pool.add(drop, kind == ParticleKind::blood ? 1.0 : 0.0);
      continue;
    }
    const double radius = std::cbrt(drop * 0.75 / std::numbers::pi);
    particles_.push_back({at + 0.3 * radius * random_vector(),
                          velocity + (0.1 * velocity.norm() + 0.01) * random_vector(), kind, drop, radius, 0.0,
                          kDropLife_s});
  }
}

void Particles::smoke(const Vector3d& at) {
  if (particles_.size() >= kMost / 2) return;  // drops come first
  particles_.push_back({at + 0.002 * random_vector(), Vector3d(0, 0, 0.03) + 0.01 * random_vector(),
                        ParticleKind::smoke, 0.0, 0.002, 0.0, kSmokeLife_s});
}

void Particles::step(double dt, const Vector3d& gravity, Pool& pool, bool ripples) {
  for (Particle& particle : particles_) {
    particle.age_s += dt;
    if (particle.kind == ParticleKind::smoke) {
      particle.radius_m += 0.004 * dt;
      particle.velocity *= 1.0 - 0.5 * dt;
    } else {
      particle.velocity += dt * gravity;
    }
    particle.at += dt * particle.velocity;
    double depth = 0;
    if (particle.kind == ParticleKind::smoke || !pool.over(particle.at, depth) || depth < 0) continue;
    pool.add(particle.volume_m3, particle.kind == ParticleKind::blood ? 1.0 : 0.0);
    if (ripples) pool.disturb(particle.at, -kSplash, 3 * particle.radius_m);
    particle.age_s = particle.life_s;
  }
  std::erase_if(particles_, [](const Particle& particle) { return particle.age_s >= particle.life_s; });
}

void Particles::remove_near(const Vector3d& p, double radius) {
  std::erase_if(particles_, [&](const Particle& one) { return (one.at - p).squaredNorm() < radius * radius; });
}

void Particles::view(std::vector<TissueParticle>& particles) const {
  particles.clear();
  for (const Particle& one : particles_) {
    particles.push_back({one.at.cast<float>(), static_cast<float>(one.radius_m), std::to_underlying(one.kind),
                         static_cast<float>(one.age_s / one.life_s)});
  }
}

}  // namespace cellmirror::tissue
