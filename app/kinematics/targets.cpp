#include "app/kinematics/targets.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::app {

std::vector<Pose> reachable_targets(const kinematics::Chain& chain, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  // The standard library's distributions differ from one implementation to the other.
  const auto uniform = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  const std::size_t joints = chain.variable_count();
  std::vector<double> q(joints);
  std::vector<Pose> targets;
  targets.reserve(count);
  for (std::size_t target = 0; target < count; ++target) {
    for (std::size_t i = 0; i < joints; ++i) {
      const bool bounded = std::isfinite(chain.lower()[i]) && std::isfinite(chain.upper()[i]);
      const double lower = bounded ? chain.lower()[i] : -std::numbers::pi;
      const double upper = bounded ? chain.upper()[i] : std::numbers::pi;
      q[i] = std::clamp(lower + uniform() * (upper - lower), lower, upper);
    }
    targets.push_back(kinematics::forward(chain, q));
  }
  return targets;
}

}  // namespace cellmirror::app
