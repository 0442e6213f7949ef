// Any bytes as a CSV of targets: findings, or poses that are finite and rotations.
#include <cstddef>
#include <cstdint>

#include "config/target_file.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  Diagnostics diagnostics;
  const auto targets = parse_targets({reinterpret_cast<const char*>(data), size}, "fuzz.csv", diagnostics);
  CELLMIRROR_EXPECTS(targets.has_value() == diagnostics.ok());
  if (!targets) return 0;
  CELLMIRROR_EXPECTS(!targets->empty());
  for (const Pose& X_BG : *targets) {
    CELLMIRROR_EXPECTS(X_BG.matrix().allFinite());
    CELLMIRROR_EXPECTS((X_BG.linear() * X_BG.linear().transpose()).isIdentity(1e-12));
    CELLMIRROR_EXPECTS(X_BG.translation().cwiseAbs().maxCoeff() <= kFarthestTarget);
  }
  return 0;
}
