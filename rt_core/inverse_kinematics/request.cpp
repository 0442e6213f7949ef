#include "rt_core/inverse_kinematics/request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cellmirror::inverse_kinematics {

Result<Request> checked(const Request& request, const kinematics::Chain& chain) {
  constexpr double kRotationSlack = 1e-6;  // of each element of R R^T - I
  constexpr double kFarthest = 1e6;        // m: beyond, rounding alone is more than any tolerance
  const Pose& X = request.X_BG;
  if (!X.matrix().allFinite()) return fail("the target has a number that is not finite");
  if (X.translation().cwiseAbs().maxCoeff() > kFarthest) {
    return fail(fmt::format("the target is farther away than {} km", kFarthest / 1000), "give the target in metres");
  }
  if (!X.linear().isUnitary(kRotationSlack) || X.linear().determinant() < 0) {
    return fail("the target's orientation is not a rotation",
                "give a unit quaternion or three perpendicular unit vectors");
  }
  if (!(std::isfinite(request.tolerance) && request.tolerance > 0)) {
    return fail(fmt::format("the tolerance {} is not positive", request.tolerance));
  }
  if (request.time_limit.count() <= 0) {
    return fail(fmt::format("the time limit {} us is not positive", request.time_limit.count()));
  }
  Request good = request;
  good.max_solutions = std::max<std::size_t>(good.max_solutions, 1);
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    if (!std::isfinite(request.present[i])) {
      return fail(fmt::format("the present value of joint {} is not finite", chain.variables()[i].name));
    }
    good.present[i] = std::clamp(request.present[i], chain.lower()[i], chain.upper()[i]);
  }
  return good;
}

std::string_view name_of(Method method) {
  switch (method) {
    case Method::fast:
      return "fast";
    case Method::ipopt:
      return "ipopt";
    case Method::automatic:
      return "auto";
  }
  return "unknown";
}

std::string_view name_of(FoundBy method) {
  switch (method) {
    case FoundBy::nobody:
      return "none";
    case FoundBy::closed_form:
      return "closed-form";
    case FoundBy::seed_table:
      return "seed-table";
    case FoundBy::fast:
      return "fast";
    case FoundBy::ipopt:
      return "ipopt";
  }
  return "unknown";
}

}  // namespace cellmirror::inverse_kinematics
