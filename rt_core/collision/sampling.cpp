#include "rt_core/collision/sampling.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "rt_core/collision/body_proximity.hpp"
#include "rt_core/collision/pair_proof.hpp"

namespace cellmirror::collision {

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// Not std::uniform_real_distribution, whose numbers differ from one standard library to another.
class RandomSource {
 public:
  double fraction() { return static_cast<double>(engine_() >> 11U) * 0x1.0p-53; }

 private:
  std::mt19937_64 engine_{20'260'101};
};

class Sampler {
 public:
  Sampler(const RelativeMotion& motion, const Body& a, const Body& b)
      : motion_(motion), proximity_(a, b), values_(motion.variables.size()), nearest_(values_) {}

  // Returns the state that the sampled postures suggest; it is not proved.
  PairState run(bool may_be_never) {
    for (int i = 0; i < kSampledPostures; ++i) {
      anywhere();
      try_posture();
      if (apart_once_ && (!may_be_never || least_ <= kNeverMargin)) return PairState::tested;
    }
    if (!apart_once_) return PairState::always;
    double width = 0.1;
    for (int i = 0; i < kRefinedPostures; ++i, width *= 0.985) {
      around_nearest(width);
      try_posture();
      if (least_ <= kNeverMargin) return PairState::tested;
    }
    return PairState::never;
  }
  [[nodiscard]] double least() const { return least_; }

 private:
  // Ends of ranges are where arms fold most, and no random number meets them.
  void anywhere() {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const SampledRange& range = motion_.variables[i];
      const double fraction = std::clamp(1.2 * random_.fraction() - 0.1, 0.0, 1.0);
      values_[i] = range.lower + fraction * (range.upper - range.lower);
    }
  }

  void around_nearest(double width) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const SampledRange& range = motion_.variables[i];
      const double step = width * (2.0 * random_.fraction() - 1.0) * (range.upper - range.lower);
      values_[i] = std::clamp(nearest_[i] + step, range.lower, range.upper);
    }
  }

  void try_posture() {
    const double up_to = std::isfinite(least_) ? std::max(least_, kNeverMargin) : kNoLimit;
    const double distance = proximity_.distance(motion_.X_AB(values_), up_to);
    if (distance > geometry::kTouchDistance) apart_once_ = true;
    if (distance >= least_) return;
    least_ = distance;
    nearest_ = values_;
  }

  const RelativeMotion& motion_;
  BodyProximity proximity_;
  RandomSource random_;
  std::vector<double> values_;
  std::vector<double> nearest_;
  double least_ = kNoLimit;
  bool apart_once_ = false;
};

}  // namespace

PairFinding examine(const RelativeMotion& motion, const Body& a, const Body& b, bool may_be_never) {
  Sampler sampler(motion, a, b);
  PairFinding finding;
  const PairState suggested = sampler.run(may_be_never);
  if (suggested == PairState::never) {
    const ProofResult result = prove_apart(motion, a, b, kNeverMargin);
    if (result.proof == Proof::refuted) return finding;
    if (result.proof == Proof::proved) finding.state = suggested;
    finding.reason = result.proof == Proof::proved
                         ? fmt::format("proved: never nearer than {:.3f} m within the joint ranges", kNeverMargin)
                         : fmt::format("never nearer than {:.3f} m in {} sampled postures, which is not proved",
                                       sampler.least(), kSampledPostures + kRefinedPostures);
  }
  if (suggested == PairState::always) {
    const ProofResult result = prove_touching(motion, a, b);
    if (result.proof == Proof::refuted) return finding;
    if (result.proof == Proof::proved) finding.state = suggested;
    finding.reason = result.proof == Proof::proved
                         ? std::string("proved: they touch in every posture within the joint ranges")
                         : fmt::format("touched in all {} sampled postures, which is not proved", kSampledPostures);
  }
  return finding;
}

}  // namespace cellmirror::collision
